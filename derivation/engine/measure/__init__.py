"""Errors of generated functions at test points and by search; run times."""
