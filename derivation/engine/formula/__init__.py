"""The ground floor: what a formula is, its dimension, its notation and its exact value.

Nothing is imported here, so that a simulation, which shares this package's
parent, starts without SymPy.
"""
