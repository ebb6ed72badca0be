"""Reference values by another method, in mpmath: the plate's modes."""
