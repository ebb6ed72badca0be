"""Reference values from two independent methods; a value is used only if both agree.

`balls` evaluates the original expressions of the theory in interval (ball) arithmetic; `routes`
computes the same values with mpmath by other methods.
"""
