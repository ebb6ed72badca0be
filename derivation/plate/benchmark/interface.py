"""What is compared, and where: a method prepares a contact and returns a function of an array."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from derivation.engine.measure import clock
from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic
from generated.impact import impact

Task = Literal["law", "inversion", "impact"]
Doubles = clock.Doubles
Call = clock.Call
"""Radii -> indentations [m], indentations -> forces [N], or speeds -> contact times [s]."""

TASKS: tuple[Task, ...] = ("law", "inversion", "impact")
TIE = 1.2
"""Times within this factor of each other are not told apart."""


@dataclass(frozen=True)
class Regime:
    """A sphere on a plate and the range of contacts looked at; exact doubles.

    Attributes
    ----------
    name
        What the contact is like.
    R, h, b
        Sphere radius, half-thickness and radius of the plate [m].
    low, high
        a/h of the smallest and largest contact of the law [1].
    speed
        Largest speed of approach of an impact [m/s].
    m
        Sphere mass [kg].
    lam, mu
        Lame constants of the plate [Pa].
    """

    name: str
    R: float
    h: float
    b: float
    low: float
    high: float
    speed: float
    m: float = 72.2
    lam: float = 0.36e9
    mu: float = 0.43e9

    @property
    def eta(self) -> float:
        """h/b [1]."""
        return self.h / self.b

    @property
    def modulus(self) -> float:
        """E* = 4 mu (lam + mu)/(lam + 2 mu) [Pa]."""
        return 4 * self.mu * (self.lam + self.mu) / (self.lam + 2 * self.mu)

    def in_units(self, length: float, time: float) -> "Regime":
        """The same where lengths and times are counted in other units [m, s]."""
        press = length * time * time
        return replace(
            self, R=self.R / length, h=self.h / length, b=self.b / length,
            speed=self.speed * time / length, lam=self.lam * press, mu=self.mu * press,
        )  # fmt: skip


REGIMES = (
    Regime("thin", 1.3, 1e-3, 1.0, 0.01, 1.0, 0.0039),
    Regime("paper", 0.13, 0.1, 1.0, 0.01, 0.3, 1.0),
    Regime("thick", 1.3, 1.0, 1.0, 0.01, 0.5, 480.0),
    Regime("small contacts", 0.13, 0.1, 1.0, 1e-8, 1e-3, 3.1e-11),
    Regime("large contacts", 1.3, 0.1, 1.0, 3.0, 9.0, 4500.0),
)
"""Impacts of these speeds reach a/h of 0.5, 0.13, 0.5, 1e-5 and 5.5."""

PAPER = REGIMES[1]


def deepest(regime: Regime) -> float:
    """Contact radius that an impact at the regime's speed reaches [m]."""
    r = regime
    return float(impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).max_contact_radius)


def never_fails(regime: Regime) -> str | None:  # noqa: ARG001
    """The reason of a failure, for a method that has none."""
    return None


Split = Literal["wide", "long", "units", "all", "ball"]
"""How rounding is told from truncation.

`wide` and `long`: by the same method in 60 digits or more, or in long doubles. `units`: by the
spread of its results in other units of length and time. `all`: the method truncates nothing, or
less than its arithmetic tells. `ball`: results are balls that enclose the truth.
"""


@dataclass(frozen=True)
class Method:
    """One way to a result.

    Attributes
    ----------
    task, family, setting
        What it computes; its kind; what is varied within the kind.
    prepare
        Set-up for a regime in an arithmetic: coefficients, zeros, tables. What it returns is
        timed; it takes and gives arrays of the arithmetic's numbers.
    ar
        The arithmetic that is compared.
    split
        How rounding is told from truncation.
    fails
        Why the method is not tried in a regime, or None.
    scalar
        Whether it takes numbers singly, so that an array buys nothing.
    quick
        Whether a quick run takes it along.
    """

    task: Task
    family: str
    setting: str
    prepare: Callable[[Regime, Arithmetic], Call]
    ar: Arithmetic = DOUBLE
    split: Split = "wide"
    fails: Callable[[Regime], str | None] = never_fails
    scalar: bool = False
    quick: bool = True

    @property
    def arithmetic(self) -> str:
        """Name of the numbers."""
        return self.ar.name

    @property
    def one_by_one(self) -> bool:
        """Whether numbers are taken singly, by the method or by its arithmetic."""
        return self.scalar or self.ar.wide

    def ready(self, regime: Regime, ar: Arithmetic | None = None) -> Call:
        """What is timed: a function of doubles, in its own arithmetic or in another."""
        numbers = ar or self.ar
        with numbers.context():
            return numbers.wrapped(self.prepare(regime, numbers))

    @property
    def name(self) -> str:
        """Family, setting and, unless double precision, arithmetic."""
        parts = [self.family, self.setting, "" if self.arithmetic == "float64" else self.arithmetic]
        return ", ".join(part for part in parts if part)
