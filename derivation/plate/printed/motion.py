"""Equations (9) to (18) as the paper prints them, each as LaTeX and, beside it, as an expression.

A series is typed with the terms that are compared; `full` is the print itself.
"""

from dataclasses import dataclass

import sympy as sp
from sympy import factorial, sin, sqrt

from derivation.engine.errata.findings import Printed
from derivation.plate.printed.contact import K_j
from derivation.plate.vocabulary import P, a, delta, delta_0, gamma_k, k, m, phi, t, v0, xi_k

_HALF, _THIRD = sp.Rational(1, 2), sp.Rational(1, 3)
_CUT = "the sum cut after its second term"


@dataclass(frozen=True)
class PrintedSeries(Printed):
    """A printed sum over all modes, `expression` being one mode's share of it."""


@dataclass(frozen=True)
class PrintedPower(Printed):
    """The power of a series' k-th term."""


def _gamma(index: int) -> PrintedSeries:
    """gamma_k of the line below (10), for one k."""
    order = 2 * index - 1
    sign = "-" if index % 2 else ""
    above = 2 * index - 2
    return PrintedSeries(
        name=f"gamma_{index}",
        equation="10",
        symbol=rf"\gamma_{index}",
        latex=(
            rf"{sign}\frac{{{above}}}{{{factorial(order)}}}"
            rf" \left( \frac{{a}}{{P^{{\frac{{1}}{{3}}}}}} \right)^{{{order}}}"
            rf" \phi_j^{{{order}}} K_j"
        ),
        expression=(
            (-1) ** index * above / factorial(order) * (a / P**_THIRD) ** order * phi**order * K_j
        ),
        says=f"$k = {index}$ of the sum over all modes",
        full=(
            r"(-1)^k \frac{(2k-2)}{(2k-1)!} \left( \frac{a}{P^{\frac{1}{3}}} \right)^{2k-1}"
            r" \sum_{j=1}^{\infty} \phi_j^{2k-1} K_j"
        ),
    )


_POWERS = PrintedPower(
    name="force_power",
    equation="10",
    symbol=r"\mathrm{power\ of\ }\delta",
    latex=r"\frac{2k-1}{3}",
    expression=(2 * k - 1) / 3,
    says=r"$P$ is the sum over $k \ge 2$ of $\xi_k \delta$ to this power, for $0 < \delta < b^2/R$",
    full=r"\frac{2k-1}{3} \quad\text{in}\quad P = \sum_{k=2}^{\infty} \xi_k"
    r" \delta^{\frac{2k-1}{3}}",
)

_XI_2 = Printed(
    name="xi_2",
    equation="10",
    symbol=r"\xi_2",
    latex=r"\frac{1}{\gamma_2}",
    expression=1 / gamma_k[2],
)

_XI_3 = Printed(
    name="xi_3",
    equation="10",
    symbol=r"\xi_3",
    latex=r"-\frac{\gamma_3}{\gamma_2^3}",
    expression=-gamma_k[3] / gamma_k[2] ** 3,
)

_ACCELERATION = Printed(
    name="acceleration",
    equation="11",
    symbol=r"\ddot{\delta}(t)",
    latex=(
        r"-\frac{1}{m} \left( \xi_2 \delta(t)^{\frac{3}{3}}"
        r" + \xi_3 \delta(t)^{\frac{5}{3}} \right)"
    ),
    expression=-(xi_k[2] * delta + xi_k[3] * delta ** sp.Rational(5, 3)) / m,
    says=_CUT,
    full=r"-\frac{1}{m} \sum_{k=2}^{\infty} \xi_k \delta(t)^{\frac{2k-1}{3}}",
)

_SPEED = Printed(
    name="speed",
    equation="13",
    symbol=r"\dot{\delta}(t)",
    latex=(
        r"\sqrt{v_0^2 - \frac{3}{m} \left( \frac{\xi_2}{3} \delta(t)^{\frac{6}{3}}"
        r" + \frac{\xi_3}{4} \delta(t)^{\frac{8}{3}} \right)}"
    ),
    expression=sqrt(
        v0**2 - 3 / m * (xi_k[2] / 3 * delta**2 + xi_k[3] / 4 * delta ** sp.Rational(8, 3))
    ),
    says=_CUT,
    full=(
        r"\sqrt{v_0^2 - \frac{3}{m} \sum_{k=2}^{\infty} \frac{\xi_k}{k+1}"
        r" \delta(t)^{\frac{2(k+1)}{3}}}"
    ),
)

_LINEAR = Printed(
    name="delta_0",
    equation="15",
    symbol=r"\delta_0(t)",
    latex=r"v_0 \sqrt{\frac{m}{\xi_2}} \sin\left(\sqrt{\frac{\xi_2}{m}} t\right)",
    expression=v0 * sqrt(m / xi_k[2]) * sin(sqrt(xi_k[2] / m) * t),
)

_RADICAND = v0**2 - xi_k[2] / m * delta_0**2 - 3 * xi_k[3] / (4 * m) * delta_0 ** sp.Rational(8, 3)
_RADICAND_LATEX = (
    r"v_0^2 - \frac{\xi_2}{m} \delta_0(t)^2 - \frac{3\xi_3}{4m} \delta_0(t)^{\frac{8}{3}}"
)

_COEFFICIENT = Printed(
    name="F_1",
    equation="17",
    symbol="F(t)",
    latex=(
        r"\frac{\delta_0(t) \left( \xi_2 + \xi_3 \delta_0(t)^{\frac{2}{3}} \right)}"
        rf"{{m \left( {_RADICAND_LATEX} \right)^{{\frac{{1}}{{2}}}}}}"
    ),
    expression=(
        delta_0 * (xi_k[2] + xi_k[3] * delta_0 ** sp.Rational(2, 3)) / (m * _RADICAND**_HALF)
    ),
)

_SOURCE = Printed(
    name="G_1",
    equation="18",
    symbol="G(t)",
    latex=(
        r"\left( v_0^2 - \frac{\xi_2}{m} \delta_0(t)^2 \right)^{\frac{1}{2}}"
        rf" - \left( {_RADICAND_LATEX} \right)^{{\frac{{1}}{{2}}}}"
    ),
    expression=(v0**2 - xi_k[2] / m * delta_0**2) ** _HALF - _RADICAND**_HALF,
)

PRINTED_MOTION: tuple[Printed, ...] = (
    _POWERS,
    _XI_2,
    _XI_3,
    _gamma(2),
    _gamma(3),
    _ACCELERATION,
    _SPEED,
    _LINEAR,
    _COEFFICIENT,
    _SOURCE,
)
"""Every printed formula of the motion that has a derived counterpart, in the paper's order."""
