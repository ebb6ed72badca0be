"""Hard cases, grids and switch points: the plate's waves."""
