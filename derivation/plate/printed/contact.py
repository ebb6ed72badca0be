"""Equations (1) to (8) as the paper prints them, in LaTeX, from which the expressions are read.

The formulas are not corrected. A quantity that the paper names inside another formula stays a name
(`K_j`, `g_j`, ...), and `compared` inserts its formula.
"""

from dataclasses import replace
from typing import Any

import sympy as sp

from derivation.engine.errata.findings import Printed
from derivation.engine.formula.parse_latex import parse_latex
from derivation.plate.vocabulary import PLATE, P, a

f_j, g_j, K_j, M_j = sp.symbols("f_j g_j K_j M_j", real=True)
sonine = sp.Symbol("sonine", real=True)
_NAMES = {symbol.name: symbol for symbol in (f_j, g_j, K_j, M_j, sonine)}
_OF_TIME = {"delta": ("t",), "delta_0": ("t",)}


def printed(
    equation: str,
    name: str,
    symbol: str,
    latex: str,
    kind: type[Printed] = Printed,
    **more: Any,
) -> Printed:
    """Return a formula of the paper."""
    expression = parse_latex(latex, PLATE, _NAMES, applied=_OF_TIME)
    return kind(name, equation, symbol, latex, expression, **more)


_F = printed(
    "2", "f_j", "f_j(z)",
    r"C_1^{(j)} \cosh(\phi_j z) + C_2^{(j)} \sinh(\phi_j z) + C_3^{(j)} z \cosh(\phi_j z)"
    r" + C_4^{(j)} z \sinh(\phi_j z)",
)  # fmt: skip
_G = printed(
    "2", "g_j", "g_j(z)",
    r"-\frac{1}{\phi_j} \left( C_1^{(j)} \sinh(\phi_j z) + C_2^{(j)} \cosh(\phi_j z) \right)"
    r" - \frac{1}{\phi_j^2} C_3^{(j)} \left( \frac{(\lambda + 3\mu)}{(\lambda + \mu)}"
    r" \cosh(\phi_j z) + z \phi_j \sinh(\phi_j z) \right) + \\ &\quad"
    r" - \frac{1}{\phi_j^2} C_4^{(j)} \left( \frac{(\lambda + 3\mu)}{(\lambda + \mu)}"
    r" \sinh(\phi_j z) + z \phi_j \cosh(\phi_j z) \right).",
)  # fmt: skip
_U = printed(
    "1", "u", "u(r, z)", r"-g_j(z) \phi_j J_1(\phi_j r)",
    full=r"-\sum_{j=1}^{\infty} g_j(z) \phi_j J_1(\phi_j r)",
    where=((g_j, _G.expression),),
)  # fmt: skip
_W = printed(
    "1", "w", "w(r, z)", r"f_j(z) J_0(\phi_j r)",
    full=r"\sum_{j=1}^{\infty} f_j(z) J_0(\phi_j r)",
    where=((f_j, _F.expression),),
)  # fmt: skip

_PRESSURE = printed(
    "7", "p", "p(r)",
    r"-\frac{3P}{2\pi a^2} \left(1 - \frac{r^2}{a^2}\right)^{\frac{1}{2}}",
)  # fmt: skip
_A_BY_INTEGRAL = printed(
    "4", "A_j", "A_j", r"\frac{2 M_j}{b^2 J_1(b\phi_j)^2}",
    says="the integral of the pressure of (7) is $p(0)$ times Sonine's integral",
    full=r"\frac{2 \int_0^a r p(r) J_0(\phi_j r) dr}{b^2 J_1(b\phi_j)^2}",
    where=((M_j, -3 * P / (2 * sp.pi * a**2) * sonine),),
)  # fmt: skip

_OMEGAS = (
    printed(
        "5", "Omega_1", r"\Omega_1",
        r"\frac{e^{\phi_j h} \left[ (\lambda + \mu) \phi_j h (e^{2\phi_j h} - 1)"
        r" + (2\mu + \lambda) (e^{2\phi_j h} + 1) \right]}"
        r"{2\mu(\lambda + \mu) \phi_j (e^{4\phi_j h} - 4\phi_j h e^{2\phi_j h} - 1)}",
    ),
    printed(
        "5", "Omega_2", r"\Omega_2",
        r"\frac{e^{\phi_j h} \left[ (\lambda + \mu) \phi_j h (e^{2\phi_j h} + 1)"
        r" + (2\mu + \lambda) (e^{2\phi_j h} - 1) \right]}"
        r"{2\mu(\lambda + \mu) \phi_j (e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h} - 1)}",
    ),
    printed(
        "5", "Omega_3", r"\Omega_3",
        r"-\frac{e^{\phi_j h} (e^{2\phi_j h} - 1)}"
        r"{2\mu \phi_j (e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h} - 1)}",
    ),
    printed(
        "5", "Omega_4", r"\Omega_4",
        r"-\frac{e^{\phi_j h} (e^{2\phi_j h} + 1)}"
        r"{2\mu \phi_j (e^{4\phi_j h} - 4\phi_j h e^{2\phi_j h} - 1)}",
    ),
)  # fmt: skip

_K = printed(
    "6", "K_j", "K_j",
    r"\frac{8(1 - e^{8\phi_j h} - 8\phi_j h e^{4\phi_j h})}{\pi R b^2 \phi_j^4 [J_1(b\phi_j)]^2"
    r" (-1 + e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h})"
    r"(1 - e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h})}",
)  # fmt: skip
_K_FACE = replace(
    _K,
    name="K_j_bottom",
    says="by using the explicit form of the transversal displacement in $z=-h$ and $r=0$",
)
_DELTA = printed(
    "6", "delta", r"\delta", "K_j A_j",
    says="$K_j$ in its explicit printed form, $A_j$ determined by expression (4)",
    full=r"\sum_{j=1}^{\infty} K_j A_j",
    where=((K_j, _K.expression),),
)  # fmt: skip

_A_CUBED = printed("7", "P", "a^3", r"\frac{3R(2\mu + \lambda)}{16\mu(\mu + \lambda)} P")
_RADIUS = replace(_A_CUBED, solved=a**3 / (_A_CUBED.expression / P))
_A = printed(
    "8", "A_j", "A_j",
    r"\frac{16\mu(\mu + \lambda)\sin(a\phi_j) - a\phi_j \cos(a\phi_j)}"
    r"{\pi b^2 R (2\mu + \lambda)\phi_j^3 [J_1(b\phi_j)]^2}",
)  # fmt: skip

PRINTED = (_U, _W, _F, _G, _A_BY_INTEGRAL, *_OMEGAS, _DELTA, _K, _K_FACE, _PRESSURE, _RADIUS, _A)
"""Every printed formula that has a derived counterpart, in the paper's order."""
