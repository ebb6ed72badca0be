"""Hard cases, grids and switch points: the static contact."""
