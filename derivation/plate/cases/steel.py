"""Elastic constants for hard cases that do not depend on the material."""

LAM, MU = 1.2e11, 8.1e10
"""Lame constants of steel [Pa]."""
