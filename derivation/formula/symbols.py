"""The paper's symbols as SymPy symbols, each with its unit, its meaning and its domain."""

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Argument:
    """One symbol a formula depends on.

    Parameters
    ----------
    symbol
        The SymPy symbol; its assumptions are those the proofs may use.
    unit
        SI unit, a key of `derivation.formula.dimension.UNITS`.
    latex
        How the symbol is typeset.
    meaning
        What it stands for, in a few words.
    domain
        Conditions under which formulas in it hold, each a comparison in
        Python's notation; one that names another symbol applies where that
        symbol is an argument too.
    """

    symbol: sp.Symbol
    unit: str
    latex: str
    meaning: str
    domain: tuple[str, ...]

    @property
    def name(self) -> str:
        """The symbol's name in formulas typed by hand and in generated code."""
        return str(self.symbol.name)


r = sp.Symbol("r", nonnegative=True)
z = sp.Symbol("z", real=True)
phi, h, b, R, a, mu, P, T = sp.symbols("phi h b R a mu P T", positive=True)
lam, A_j = sp.symbols("lam A_j", real=True)
J1 = sp.Symbol("J1", real=True, nonzero=True)
C1, C2, C3, C4 = sp.symbols("C1:5", real=True)
f = sp.Function("f_j", real=True)(z)
g = sp.Function("g_j", real=True)(z)
UNKNOWNS = {f: "m", g: "m^2"}
"""Units of the functions the equilibrium equations determine."""

ARGUMENTS = (
    Argument(r, "m", "r", "distance from the axis", ("r >= 0", "r <= b")),
    Argument(z, "m", "z", "height above the middle plane", ("abs(z) <= h",)),
    Argument(phi, "1/m", r"\phi_j", "wave number j_n/b of the mode, J0(b phi) = 0", ("phi > 0",)),
    Argument(h, "m", "h", "half the plate's thickness", ("h > 0",)),
    Argument(T, "1", "T", "wave number times full thickness, T = 2 phi h", ("T > 0",)),
    Argument(b, "m", "b", "plate radius", ("b > 0",)),
    Argument(R, "m", "R", "sphere radius", ("R > 0",)),
    Argument(a, "m", "a", "contact radius", ("a > 0", "a < b", "a < R")),
    Argument(lam, "Pa", r"\lambda", "first Lame constant", ("3 * lam > -2 * mu",)),
    Argument(mu, "Pa", r"\mu", "second Lame constant (shear modulus)", ("mu > 0",)),
    Argument(P, "N", "P", "contact force", ("P > 0",)),
    Argument(A_j, "Pa", "A_j", "Fourier-Bessel coefficient of the pressure", ()),
    Argument(J1, "1", r"J_1(b\phi_j)", "Bessel function J1 at b phi", ("J1 != 0",)),
    Argument(C1, "m", r"C_1^{(j)}", "first integration constant", ()),
    Argument(C2, "m", r"C_2^{(j)}", "second integration constant", ()),
    Argument(C3, "1", r"C_3^{(j)}", "third integration constant", ()),
    Argument(C4, "1", r"C_4^{(j)}", "fourth integration constant", ()),
)
BY_NAME = {argument.name: argument for argument in ARGUMENTS}


def arguments_of(expression: sp.Expr) -> tuple[Argument, ...]:
    """Arguments an expression depends on, in the order of the table above.

    Raises
    ------
    KeyError
        If a free symbol is not one of the paper's.
    """
    names = {str(symbol) for symbol in expression.free_symbols}
    unknown = names - set(BY_NAME)
    if unknown:
        raise KeyError(f"symbols without unit and domain: {', '.join(sorted(unknown))}")
    return tuple(argument for argument in ARGUMENTS if argument.name in names)
