"""Bessel functions and their zeros in NumPy, copied into generated packages."""
