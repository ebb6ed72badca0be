"""Stretching of the middle plane of a deflected plate."""
