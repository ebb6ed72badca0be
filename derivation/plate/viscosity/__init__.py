"""Viscoelastic contact."""
