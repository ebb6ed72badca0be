"""Reference values by another method, in mpmath: the static contact."""
