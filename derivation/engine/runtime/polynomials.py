"""Polynomials whose coefficients are numbers, or arrays like the variable.

Arithmetic: Horner's rule.
"""

import numpy as np


def polynomial(x: np.ndarray, *coefficients: float | np.ndarray) -> np.ndarray:
    """Return c_0 + c_1 x + ... by Horner's rule, in place; at least two coefficients."""
    value = x * coefficients[-1]
    value += coefficients[-2]
    for coefficient in coefficients[-3::-1]:
        value *= x
        value += coefficient
    return value
