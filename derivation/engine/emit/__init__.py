"""Source code from stable forms: NumPy modules rendered with Jinja2 and formatted by ruff."""
