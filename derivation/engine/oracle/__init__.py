"""What is true: two oracles that share no formula, and must agree before either is believed.

`balls` evaluates the theory's original expressions in ball arithmetic; `routes`
reaches the same numbers numerically, along other ways, in mpmath.
"""
