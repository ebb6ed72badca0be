"""The material of hard cases in which it does not matter."""

LAM, MU = 1.2e11, 8.1e10
"""Steel [Pa]."""
