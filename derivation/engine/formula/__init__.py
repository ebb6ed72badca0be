"""The lowest layer: formulas, their dimensions, their notation and their exact values.

This module imports nothing, so that a simulation, which shares the parent package, starts without
SymPy.
"""
