"""The lowest layer: formulas with their dimensions, notation, proofs and exact values.

This module imports nothing, so that a simulation, which shares the parent package, starts without
SymPy.
"""
