"""Reference values from two independent methods; a value is used only if both agree.

`oracle` evaluates the theory's original expressions in ball arithmetic; `agreement` compares them
with values that other methods compute in mpmath.
"""
