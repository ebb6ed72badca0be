"""Elementary functions by the names that formulas use for them, and what to write for others."""

from collections.abc import Callable, Mapping

import sympy as sp

ELEMENTARY: Mapping[str, Callable[[sp.Expr], sp.Expr]] = {
    "exp": sp.exp,
    "log": sp.log,
    "sqrt": sp.sqrt,
    "sin": sp.sin,
    "cos": sp.cos,
    "tan": sp.tan,
    "cot": lambda argument: sp.cos(argument) / sp.sin(argument),
    "sinh": sp.sinh,
    "cosh": sp.cosh,
    "tanh": sp.tanh,
    "coth": sp.coth,
    "sec": lambda argument: 1 / sp.cos(argument),
    "csc": lambda argument: 1 / sp.sin(argument),
    "sech": lambda argument: 1 / sp.cosh(argument),
    "csch": lambda argument: 1 / sp.sinh(argument),
    "asin": sp.asin,
    "acos": sp.acos,
    "atan": sp.atan,
    "asinh": sp.asinh,
    "acosh": sp.acosh,
    "atanh": sp.atanh,
    "erf": sp.erf,
    "erfc": sp.erfc,
    "log1p": lambda argument: sp.log(1 + argument),
    "expm1": lambda argument: sp.exp(argument) - 1,
    "log10": lambda argument: sp.log(argument) / sp.log(10),
    "log2": lambda argument: sp.log(argument) / sp.log(2),
    "cbrt": lambda argument: argument ** sp.Rational(1, 3),
}
"""Functions of one argument by name."""

OTHER_NAMES: Mapping[str, str] = {"ln": "log"} | {
    f"{prefix}{name}": f"a{name}"
    for prefix, names in (
        ("arc", ("sin", "cos", "tan", "sinh", "cosh", "tanh")),
        ("ar", ("sinh", "cosh", "tanh")),
    )
    for name in names
}
"""Other names of these functions."""

INSTEAD: Mapping[str, str] = {
    "atan2": "write atan(y/x)",
    "hypot": "write sqrt(x**2 + y**2)",
    "pow": "write x**n",
    "root": "write x**(1/n)",
    "sinc": "write sin(x)/x",
    "sign": "write x/abs(x)",
    "sgn": "write x/abs(x)",
    "Rational": "write p/q",
    **dict.fromkeys(
        ("Max", "Min", "max", "min", "Piecewise", "Heaviside", "floor", "ceiling"),
        "give one branch of the formula, without cases",
    ),
    **dict.fromkeys(
        ("diff", "Derivative", "Sum", "sum", "lim"),
        "carry out derivatives and sums, and give the result",
    ),
    **dict.fromkeys(("integrate", "int"), "write Integral(f, (x, a, b))"),
}
"""What to write instead of functions that are not read."""
