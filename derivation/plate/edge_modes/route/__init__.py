"""References for clamped and supported plates by another method, in mpmath."""
