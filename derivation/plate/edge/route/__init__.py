"""References for the edge by another method, in mpmath."""
