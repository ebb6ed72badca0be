"""Quadrature, Chebyshev polynomials and collocation."""
