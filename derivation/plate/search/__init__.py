"""The search for larger errors than the grids find."""
