"""Methods and test cases of the benchmark: a method prepares a contact and returns a function."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from derivation.engine.measure import clock
from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic
from generated.impact import impact

Task = Literal["law", "inversion", "impact"]
Doubles = clock.Doubles
Call = clock.Call
"""Function of radii, indentations or speeds: indentations [m], forces [N] or times [s]."""

TASKS: tuple[Task, ...] = ("law", "inversion", "impact")
TIE = 1.2
"""Ratio of times below which two methods count as equally fast."""


@dataclass(frozen=True)
class BenchmarkCase:
    """A sphere on a plate and the range of its contacts; exact doubles.

    Attributes
    ----------
    name
        Name of the test case.
    R, h, b
        Sphere radius, half-thickness and radius of the plate [m].
    low, high
        a/h of the smallest and largest contact of the law [1].
    speed
        Largest impact speed [m/s].
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

    def in_units(self, length: float, time: float) -> "BenchmarkCase":
        """Return the same contact in other units of length and time [m, s]."""
        press = length * time * time
        return replace(
            self, R=self.R / length, h=self.h / length, b=self.b / length,
            speed=self.speed * time / length, lam=self.lam * press, mu=self.mu * press,
        )  # fmt: skip


CASES = (
    BenchmarkCase("thin", 1.3, 1e-3, 1.0, 0.01, 1.0, 0.0039),
    BenchmarkCase("paper", 0.13, 0.1, 1.0, 0.01, 0.3, 1.0),
    BenchmarkCase("thick", 1.3, 1.0, 1.0, 0.01, 0.5, 480.0),
    BenchmarkCase("small contacts", 0.13, 0.1, 1.0, 1e-8, 1e-3, 3.1e-11),
    BenchmarkCase("large contacts", 1.3, 0.1, 1.0, 3.0, 9.0, 4500.0),
)
"""Impacts of these speeds reach a/h of 0.5, 0.13, 0.5, 1e-5 and 5.5."""

PAPER = CASES[1]


def largest_contact_radius(case: BenchmarkCase) -> float:
    """Return the contact radius of an impact at the test case's speed [m]."""
    r = case
    return float(impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).max_contact_radius)


def never_fails(case: BenchmarkCase) -> str | None:  # noqa: ARG001
    """Return None: the method has no reason to fail."""
    return None


Split = Literal["wide", "long", "units", "all", "ball"]
"""How rounding is separated from truncation.

`wide` and `long`: by the same method in 60 digits or more, or in long doubles. `units`: by the
spread of its results in other units of length and time. `all`: the method truncates nothing, or
less than the precision of its arithmetic. `ball`: results are balls that enclose the reference
value.
"""


@dataclass(frozen=True)
class Method:
    """A method at a setting.

    Attributes
    ----------
    task, family, setting
        Its result, its kind, and the parameter varied within the kind.
    prepare
        Set-up for a test case in an arithmetic: coefficients, zeros, tables. The returned function
        is timed; its argument and result are arrays of the arithmetic's numbers.
    ar
        The arithmetic that is compared.
    split
        How rounding is separated from truncation.
    fails
        Function that returns why the method is omitted in a test case, or None.
    scalar
        Whether it evaluates numbers one by one, so that arrays are not faster.
    quick
        Whether a quick run includes it.
    """

    task: Task
    family: str
    setting: str
    prepare: Callable[[BenchmarkCase, Arithmetic], Call]
    ar: Arithmetic = DOUBLE
    split: Split = "wide"
    fails: Callable[[BenchmarkCase], str | None] = never_fails
    scalar: bool = False
    quick: bool = True

    @property
    def arithmetic(self) -> str:
        """Name of the arithmetic."""
        return self.ar.name

    @property
    def one_by_one(self) -> bool:
        """Whether numbers are evaluated one by one, by the method or by its arithmetic."""
        return self.scalar or self.ar.wide

    def prepared(self, case: BenchmarkCase, ar: Arithmetic | None = None) -> Call:
        """Return the function to be timed: of doubles, in its own arithmetic or in another."""
        numbers = ar or self.ar
        with numbers.context():
            return numbers.for_doubles(self.prepare(case, numbers))

    @property
    def name(self) -> str:
        """Family, setting and, unless it is double precision, arithmetic."""
        parts = [self.family, self.setting, "" if self.arithmetic == "float64" else self.arithmetic]
        return ", ".join(part for part in parts if part)
