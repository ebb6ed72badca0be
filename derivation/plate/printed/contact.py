"""Equations (1) to (8) as the paper prints them, each as LaTeX and, beside it, as an expression.

Right or wrong, nothing here is mended. A quantity that the paper names inside
another formula stays a name (`K_j`, `g_j`, ...), and `compared` writes it out.
"""

import sympy as sp
from sympy import cos, cosh, exp, pi, sin, sinh, sqrt

from derivation.engine.errata.findings import Printed
from derivation.plate.vocabulary import C1, C2, C3, C4, J1, A_j, P, R, a, b, h, lam, mu, phi, r, z

f_j, g_j, K_j, M_j = sp.symbols("f_j g_j K_j M_j", real=True)
sonine = sp.Symbol("sonine", real=True)
J0_r, J1_r = sp.besselj(0, phi * r), sp.besselj(1, phi * r)


_F = Printed(
    name="f_j",
    equation="2",
    symbol="f_j(z)",
    latex=(
        r"C_1^{(j)} \cosh(\phi_j z) + C_2^{(j)} \sinh(\phi_j z) + C_3^{(j)} z \cosh(\phi_j z)"
        r" + C_4^{(j)} z \sinh(\phi_j z)"
    ),
    expression=(
        C1 * cosh(phi * z) + C2 * sinh(phi * z) + C3 * z * cosh(phi * z) + C4 * z * sinh(phi * z)
    ),
)

_G = Printed(
    name="g_j",
    equation="2",
    symbol="g_j(z)",
    latex=(
        r"-\frac{1}{\phi_j} \left( C_1^{(j)} \sinh(\phi_j z) + C_2^{(j)} \cosh(\phi_j z) \right)"
        r" - \frac{1}{\phi_j^2} C_3^{(j)} \left( \frac{(\lambda + 3\mu)}{(\lambda + \mu)}"
        r" \cosh(\phi_j z) + z \phi_j \sinh(\phi_j z) \right) + \\ &\quad"
        r" - \frac{1}{\phi_j^2} C_4^{(j)} \left( \frac{(\lambda + 3\mu)}{(\lambda + \mu)}"
        r" \sinh(\phi_j z) + z \phi_j \cosh(\phi_j z) \right)."
    ),
    expression=(
        -1 / phi * (C1 * sinh(phi * z) + C2 * cosh(phi * z))
        - C3 / phi**2 * ((lam + 3 * mu) / (lam + mu) * cosh(phi * z) + z * phi * sinh(phi * z))
        - C4 / phi**2 * ((lam + 3 * mu) / (lam + mu) * sinh(phi * z) + z * phi * cosh(phi * z))
    ),
)

_U = Printed(
    name="u",
    equation="1",
    symbol="u(r, z)",
    latex=r"-g_j(z) \phi_j J_1(\phi_j r)",
    expression=-g_j * phi * J1_r,
    full=r"-\sum_{j=1}^{\infty} g_j(z) \phi_j J_1(\phi_j r)",
    where=((g_j, _G.expression),),
)

_W = Printed(
    name="w",
    equation="1",
    symbol="w(r, z)",
    latex=r"f_j(z) J_0(\phi_j r)",
    expression=f_j * J0_r,
    full=r"\sum_{j=1}^{\infty} f_j(z) J_0(\phi_j r)",
    where=((f_j, _F.expression),),
)

_A_BY_INTEGRAL = Printed(
    name="A_j",
    equation="4",
    symbol="A_j",
    latex=r"\frac{2 M_j}{b^2 J_1(b\phi_j)^2}",
    expression=2 * M_j / (b**2 * J1**2),
    says=(
        "$M_j$ stands for the integral; with the pressure of (7) it is $p(0)$ times Sonine's "
        "integral"
    ),
    full=r"\frac{2 \int_0^a r p(r) J_0(\phi_j r) dr}{b^2 J_1(b\phi_j)^2}",
    where=((M_j, -3 * P / (2 * pi * a**2) * sonine),),
)

_OMEGAS = (
    Printed(
        name="Omega_1",
        equation="5",
        symbol=r"\Omega_1",
        latex=(
            r"\frac{e^{\phi_j h} \left[ (\lambda + \mu) \phi_j h (e^{2\phi_j h} - 1)"
            r" + (2\mu + \lambda) (e^{2\phi_j h} + 1) \right]}"
            r"{2\mu(\lambda + \mu) \phi_j (e^{4\phi_j h} - 4\phi_j h e^{2\phi_j h} - 1)}"
        ),
        expression=(
            exp(phi * h)
            * (
                (lam + mu) * phi * h * (exp(2 * phi * h) - 1)
                + (2 * mu + lam) * (exp(2 * phi * h) + 1)
            )
            / (2 * mu * (lam + mu) * phi * (exp(4 * phi * h) - 4 * phi * h * exp(2 * phi * h) - 1))
        ),
    ),
    Printed(
        name="Omega_2",
        equation="5",
        symbol=r"\Omega_2",
        latex=(
            r"\frac{e^{\phi_j h} \left[ (\lambda + \mu) \phi_j h (e^{2\phi_j h} + 1)"
            r" + (2\mu + \lambda) (e^{2\phi_j h} - 1) \right]}"
            r"{2\mu(\lambda + \mu) \phi_j (e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h} - 1)}"
        ),
        expression=(
            exp(phi * h)
            * (
                (lam + mu) * phi * h * (exp(2 * phi * h) + 1)
                + (2 * mu + lam) * (exp(2 * phi * h) - 1)
            )
            / (2 * mu * (lam + mu) * phi * (exp(4 * phi * h) + 4 * phi * h * exp(2 * phi * h) - 1))
        ),
    ),
    Printed(
        name="Omega_3",
        equation="5",
        symbol=r"\Omega_3",
        latex=(
            r"-\frac{e^{\phi_j h} (e^{2\phi_j h} - 1)}"
            r"{2\mu \phi_j (e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h} - 1)}"
        ),
        expression=(
            -exp(phi * h)
            * (exp(2 * phi * h) - 1)
            / (2 * mu * phi * (exp(4 * phi * h) + 4 * phi * h * exp(2 * phi * h) - 1))
        ),
    ),
    Printed(
        name="Omega_4",
        equation="5",
        symbol=r"\Omega_4",
        latex=(
            r"-\frac{e^{\phi_j h} (e^{2\phi_j h} + 1)}"
            r"{2\mu \phi_j (e^{4\phi_j h} - 4\phi_j h e^{2\phi_j h} - 1)}"
        ),
        expression=(
            -exp(phi * h)
            * (exp(2 * phi * h) + 1)
            / (2 * mu * phi * (exp(4 * phi * h) - 4 * phi * h * exp(2 * phi * h) - 1))
        ),
    ),
)

_K_LATEX = (
    r"\frac{8(1 - e^{8\phi_j h} - 8\phi_j h e^{4\phi_j h})}{\pi R b^2 \phi_j^4 [J_1(b\phi_j)]^2"
    r" (-1 + e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h})"
    r"(1 - e^{4\phi_j h} + 4\phi_j h e^{2\phi_j h})}"
)
_K_EXPRESSION = (
    8
    * (1 - exp(8 * phi * h) - 8 * phi * h * exp(4 * phi * h))
    / (
        pi
        * R
        * b**2
        * phi**4
        * J1**2
        * (-1 + exp(4 * phi * h) + 4 * phi * h * exp(2 * phi * h))
        * (1 - exp(4 * phi * h) + 4 * phi * h * exp(2 * phi * h))
    )
)

_DELTA = Printed(
    name="delta",
    equation="6",
    symbol=r"\delta",
    latex="K_j A_j",
    expression=K_j * A_j,
    says="$K_j$ in its explicit printed form, $A_j$ determined by expression (4)",
    full=r"\sum_{j=1}^{\infty} K_j A_j",
    where=((K_j, _K_EXPRESSION),),
)

_K = Printed(name="K_j", equation="6", symbol="K_j", latex=_K_LATEX, expression=_K_EXPRESSION)

_K_FACE = Printed(
    name="K_j_bottom",
    equation="6",
    symbol="K_j",
    latex=_K_LATEX,
    expression=_K_EXPRESSION,
    says="by using the explicit form of the transversal displacement in $z=-h$ and $r=0$",
)

_PRESSURE = Printed(
    name="p",
    equation="7",
    symbol="p(r)",
    latex=r"-\frac{3P}{2\pi a^2} \left(1 - \frac{r^2}{a^2}\right)^{\frac{1}{2}}",
    expression=-3 * P / (2 * pi * a**2) * sqrt(1 - r**2 / a**2),
)

_RADIUS = Printed(
    name="P",
    equation="7",
    symbol="a^3",
    latex=r"\frac{3R(2\mu + \lambda)}{16\mu(\mu + \lambda)} P",
    expression=3 * R * (2 * mu + lam) / (16 * mu * (mu + lam)) * P,
    solved=a**3 / (3 * R * (2 * mu + lam) / (16 * mu * (mu + lam))),
)

_A = Printed(
    name="A_j",
    equation="8",
    symbol="A_j",
    latex=(
        r"\frac{16\mu(\mu + \lambda)\sin(a\phi_j) - a\phi_j \cos(a\phi_j)}"
        r"{\pi b^2 R (2\mu + \lambda)\phi_j^3 [J_1(b\phi_j)]^2}"
    ),
    expression=(
        (16 * mu * (mu + lam) * sin(a * phi) - a * phi * cos(a * phi))
        / (pi * b**2 * R * (2 * mu + lam) * phi**3 * J1**2)
    ),
)

PRINTED = (_U, _W, _F, _G, _A_BY_INTEGRAL, *_OMEGAS, _DELTA, _K, _K_FACE, _PRESSURE, _RADIUS, _A)
"""Every printed formula that has a derived counterpart, in the paper's order."""
