"""Reference values from two independent methods; a value is used only if both agree.

`oracle` evaluates the derived expressions in ball arithmetic; `agreement` compares the results with
values that other methods compute in mpmath.
"""
