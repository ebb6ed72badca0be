"""Reference values by another method, in mpmath: the edge."""
