"""NumPy code for SymPy expressions: functions of `np`, and building blocks by name."""

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.numpy import NumPyPrinter
from sympy.printing.precedence import PRECEDENCE

from derivation.engine.formula.notation import positive_first
from derivation.engine.rewrite.doubles import SMALL_INTEGER
from derivation.engine.rewrite.form import CLOSELY, TIMES
from derivation.engine.rewrite.shape import decay

LARGEST_PRODUCT = 6
"""Largest power of a single number that is printed as a product."""
POWERS_OF_TWO = (2, 4, 8, 16, 32, 64)
"""Denominators printed as exact factors, because a product of single numbers is faster."""


class _Printer(NumPyPrinter):
    """SymPy's NumPy printer, with quotients as written by hand and undefined functions as calls."""

    def _module_format(self, fqn: str, register: bool = True) -> str:
        return str(super()._module_format(fqn, register)).replace("numpy.", "np.")

    def _print_AppliedUndef(self, expr: AppliedUndef) -> str:
        if expr.func in (TIMES, CLOSELY):
            value, *powers = (self._print(x) for x in expr.args)
            pairs = zip(powers[::2], powers[1::2], strict=True)
            return f"{expr.func.__name__}({', '.join([value, *(f'({b}, {p})' for b, p in pairs)])})"
        return f"{expr.func.__name__}({', '.join(self._print(x) for x in expr.args)})"

    def _print_Heaviside(self, expr: sp.Heaviside) -> str:
        return f"np.heaviside({self._print(expr.args[0])}, {self._print(expr.args[1])})"

    def _print_Min(self, expr: sp.Min) -> str:
        return self._bounds("np.minimum", expr)

    def _print_Max(self, expr: sp.Max) -> str:
        return self._bounds("np.maximum", expr)

    def _bounds(self, function: str, expr: sp.Expr) -> str:
        """Print two arguments at a time: NumPy takes a third one as the output array."""
        arguments = sorted(expr.args, key=lambda x: (not x.free_symbols, sp.default_sort_key(x)))
        *others, text = (str(self._print(x)) for x in arguments)
        for other in reversed(others):
            text = f"{function}({other}, {text})"
        return text

    def _print_Float(self, expr: sp.Float) -> str:
        return repr(float(expr))

    def _print_BesselJ(self, expr: sp.besselj) -> str:
        return f"bessel_j{expr.order}({self._print(expr.argument)})"

    _print_besselj = _print_BesselJ

    def _print_Add(self, expr: sp.Add, order: str | None = None) -> str:
        number, rest = expr.as_coeff_Add()
        if not (number > 0 and rest.is_Add and all(_is_decaying(part) for part in rest.args)):
            return str(super()._print_Add(expr, order=order))
        # Decaying terms are summed first: where they are small, only the total is rounded.
        sign, rest = ("-", -rest) if rest.args[0].could_extract_minus_sign() else ("+", rest)
        return f"{self._print(number)} {sign} ({self._print(rest)})"

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        if expr.exp == -1:
            return f"1/{self.parenthesize(expr.base, PRECEDENCE['Pow'], strict=False)}"
        if expr.exp.is_Rational and expr.exp.q == 3:  # a double is not exactly 1/3 as an exponent
            root = f"{self._module_format('numpy.cbrt')}({self._print(expr.base)})"
            power = abs(expr.exp.p)
            text = root if power == 1 else f"{root}**{power}"
            return text if expr.exp > 0 else f"1/{text}"
        return str(super()._print_Pow(expr, rational))

    def _print_Mul(self, expr: sp.Mul) -> str:
        coefficient, rest = expr.as_coeff_Mul()
        if not isinstance(coefficient, sp.Rational) or coefficient.q > SMALL_INTEGER:
            return str(super()._print_Mul(expr))
        above, below = _split(rest)
        above = [sp.Integer(abs(coefficient.p))] * (abs(coefficient.p) != 1) + above
        below = [sp.Integer(coefficient.q)] * (coefficient.q != 1) + below
        text = self._product(above) or "1"
        if below:
            divisor = self._product(below)
            text += f"/({divisor})" if len(below) > 1 else f"/{divisor}"
        return f"-{text}" if coefficient < 0 else text

    def _product(self, factors: list[sp.Expr]) -> str:
        return "*".join(self.parenthesize(x, PRECEDENCE["Mul"], strict=False) for x in factors)

    def _as_ordered_terms(self, expr: sp.Add, order: str | None = None) -> list[sp.Expr]:
        return positive_first(super()._as_ordered_terms(expr, order=order))


def _is_decaying(part: sp.Expr) -> bool:
    exponents = (function.args[0] for function in part.atoms(sp.exp))
    return part.has(decay) or any(x.could_extract_minus_sign() for x in exponents)


def _split(product: sp.Expr) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Return factors above and below the line, numbers and symbols before functions."""
    above, below = [], []
    for factor in product.as_ordered_factors():
        base, exponent = factor.as_base_exp()
        if exponent.is_Rational and exponent < 0:
            below.append(base**-exponent)
        else:
            above.append(factor)
    return above, below


class _OfSingleNumbers(_Printer):
    """Printer with Python's own functions, which are much faster for single numbers."""

    def _module_format(self, fqn: str, register: bool = True) -> str:
        return super()._module_format(fqn, register).removeprefix("np.")

    def _print_Integer(self, expr: sp.Integer) -> str:
        return f"{expr}.0"

    def _print_Mul(self, expr: sp.Mul) -> str:
        coefficient, rest = expr.as_coeff_Mul()
        if isinstance(coefficient, sp.Rational) and coefficient.q in POWERS_OF_TWO:
            above, below = _split(rest)
            text = self._product([sp.Float(coefficient), *above])
            divisor = self._product(below)
            text += f"/({divisor})" if len(below) > 1 else f"/{divisor}" if below else ""
            return text
        return super()._print_Mul(expr)

    def _print_Rational(self, expr: sp.Rational) -> str:
        if expr.q in POWERS_OF_TWO:
            return repr(float(expr))
        return f"{expr.p}.0/{expr.q}.0"

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        if expr.exp.is_Integer and 1 < expr.exp <= LARGEST_PRODUCT:
            # Python raises an error if a power overflows, while a product becomes infinite.
            factor = self.parenthesize(expr.base, PRECEDENCE["Mul"], strict=False)
            return f"({'*'.join([factor] * int(expr.exp))})"
        return super()._print_Pow(expr, rational)


_PRINTER = _Printer({"allow_unknown_functions": True})
_SINGLE = _OfSingleNumbers({"allow_unknown_functions": True})


def to_numpy(expression: sp.Basic) -> str:
    """Return the NumPy code of an expression; it is evaluated in the printed order."""
    return str(_PRINTER.doprint(expression))


def to_math(expression: sp.Basic) -> str:
    """Return the code of an expression for single numbers, with functions of Python's `math`."""
    return str(_SINGLE.doprint(expression))
