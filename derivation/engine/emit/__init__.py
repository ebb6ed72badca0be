"""Stable forms become text: NumPy modules rendered with Jinja2, formatted by ruff."""
