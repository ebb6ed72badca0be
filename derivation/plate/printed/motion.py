"""Equations (9) to (18) as the paper prints them, in LaTeX, from which the expressions are read.

A series is typed with the terms that are compared; `full` is the formula as published.
"""

from dataclasses import dataclass
from math import factorial

from derivation.engine.errata.findings import Printed
from derivation.plate.printed.contact import printed

_TRUNCATION = "the sum is truncated after its second term"


@dataclass(frozen=True)
class PrintedSeries(Printed):
    """A printed sum over all modes, `expression` being one mode's term of it."""


@dataclass(frozen=True)
class PrintedPower(Printed):
    """The power of a series' k-th term."""


def _gamma(index: int) -> Printed:
    """Return gamma_k of the line below (10) for one k."""
    order, sign = 2 * index - 1, "-" if index % 2 else ""
    return printed(
        "10", f"gamma_{index}", rf"\gamma_{index}",
        rf"{sign}\frac{{{2 * index - 2}}}{{{factorial(order)}}}"
        rf" \left( \frac{{a}}{{P^{{\frac{{1}}{{3}}}}}} \right)^{{{order}}}"
        rf" \phi_j^{{{order}}} K_j",
        PrintedSeries,
        says=f"$k = {index}$ of the sum over all modes",
        full=r"(-1)^k \frac{(2k-2)}{(2k-1)!} \left( \frac{a}{P^{\frac{1}{3}}} \right)^{2k-1}"
        r" \sum_{j=1}^{\infty} \phi_j^{2k-1} K_j",
    )  # fmt: skip


_RADICAND = r"v_0^2 - \frac{\xi_2}{m} \delta_0(t)^2 - \frac{3\xi_3}{4m} \delta_0(t)^{\frac{8}{3}}"

PRINTED_MOTION = (
    printed(
        "10", "force_power", r"\mathrm{power\ of\ }\delta", r"\frac{2k-1}{3}", PrintedPower,
        says=r"$P$ is the sum over $k \ge 2$ of $\xi_k \delta$ to this power, "
        r"for $0 < \delta < b^2/R$",
        full=r"\frac{2k-1}{3} \quad\text{in}\quad P = \sum_{k=2}^{\infty} \xi_k"
        r" \delta^{\frac{2k-1}{3}}",
    ),
    printed("10", "xi_2", r"\xi_2", r"\frac{1}{\gamma_2}"),
    printed("10", "xi_3", r"\xi_3", r"-\frac{\gamma_3}{\gamma_2^3}"),
    _gamma(2),
    _gamma(3),
    printed(
        "11", "acceleration", r"\ddot{\delta}(t)",
        r"-\frac{1}{m} \left( \xi_2 \delta(t)^{\frac{3}{3}}"
        r" + \xi_3 \delta(t)^{\frac{5}{3}} \right)",
        says=_TRUNCATION,
        full=r"-\frac{1}{m} \sum_{k=2}^{\infty} \xi_k \delta(t)^{\frac{2k-1}{3}}",
    ),
    printed(
        "13", "speed", r"\dot{\delta}(t)",
        r"\sqrt{v_0^2 - \frac{3}{m} \left( \frac{\xi_2}{3} \delta(t)^{\frac{6}{3}}"
        r" + \frac{\xi_3}{4} \delta(t)^{\frac{8}{3}} \right)}",
        says=_TRUNCATION,
        full=r"\sqrt{v_0^2 - \frac{3}{m} \sum_{k=2}^{\infty} \frac{\xi_k}{k+1}"
        r" \delta(t)^{\frac{2(k+1)}{3}}}",
    ),
    printed(
        "15", "delta_0", r"\delta_0(t)",
        r"v_0 \sqrt{\frac{m}{\xi_2}} \sin\left(\sqrt{\frac{\xi_2}{m}} t\right)",
    ),
    printed(
        "17", "F_1", "F(t)",
        r"\frac{\delta_0(t) \left( \xi_2 + \xi_3 \delta_0(t)^{\frac{2}{3}} \right)}"
        rf"{{m \left( {_RADICAND} \right)^{{\frac{{1}}{{2}}}}}}",
    ),
    printed(
        "18", "G_1", "G(t)",
        r"\left( v_0^2 - \frac{\xi_2}{m} \delta_0(t)^2 \right)^{\frac{1}{2}}"
        rf" - \left( {_RADICAND} \right)^{{\frac{{1}}{{2}}}}",
    ),
)  # fmt: skip
"""Every printed formula of the motion that has a derived counterpart, in the paper's order."""
