"""Bessel functions and their zeros: theory, tables for code, reference values."""
