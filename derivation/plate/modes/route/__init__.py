"""References for the plate's modes by another method, in mpmath."""
