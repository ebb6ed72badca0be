"""Takes the cheapest method whose error bound meets a tolerance, and says what the bound rests on.

The gate has decided which effects the law holds. From the cheapest: `hertz` and `leading` know
a proven bound of what they leave out of the plate's law; `coarse` and `full` take the whole
law, with half the quadrature's nodes and with all. A bound is a relative error of all its
results against the law of every effect the scene leaves open, with the scene's numbers, these
being the doubles that the scene turns into.
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene import kernels, motion
from derivation.scene.effects.effect import Results
from derivation.scene.gate import Gate
from derivation.scene.law import WHOLE_PLATE, Law
from derivation.scene.limits import check_energy
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS, TIGHTEST, SceneError
from derivation.scene.words import shown

if TYPE_CHECKING:
    from derivation.scene.wave_motion import WaveMotion

METHODS = {
    "hertz": "Hertz's law alone",
    "leading": "Hertz's law and the plate's first correction",
    "coarse": "the law of every effect included, half the nodes",
    "full": "the law of every effect included",
}
"""From the cheapest to the dearest."""
PROVED, COUNTED, MEASURED = "proved", "counted", "measured"
"""What a bound rests on: a proof; operations times their rounding; a promise held in tests."""


@dataclass(frozen=True)
class Part:
    """One part of an error bound.

    Attributes
    ----------
    bound
        Relative error [1].
    basis
        `proved`, `counted` or `measured`.
    """

    bound: float
    basis: str


@dataclass(frozen=True)
class Accuracy:
    """How an impact was computed and how wrong it may be.

    Attributes
    ----------
    method
        One of `METHODS`.
    rtol
        The tolerance that was asked for [1]; None if none was.
    law, quadrature, rounding
        Parts of the bound: what is left out of the contact law, what the integral for the
        contact time misses, and the arithmetic, of the law's tables too.
    effects
        Another part: the effects that the gate left out.
    outputs
        The results that the bound is one of.
    """

    method: str
    rtol: float | None
    law: Part
    quadrature: Part
    rounding: Part
    effects: Part = Part(0.0, PROVED)
    outputs: tuple[str, ...] = OUTPUTS

    @property
    def parts(self) -> dict[str, Part]:
        """The bound's parts by name."""
        names = ("effects", "law", "quadrature", "rounding")
        return {name: getattr(self, name) for name in names}

    @property
    def bound(self) -> float:
        """Bound of the relative error of every result it is one of [1]."""
        return math.expm1(sum(math.log1p(part.bound) for part in self.parts.values()))

    def to_json(self) -> dict[str, Any]:
        """Method, tolerance and bound, with each part and what it rests on."""
        parts = {
            name: {"bound": part.bound, "basis": part.basis} for name, part in self.parts.items()
        }
        made = {"method": self.method, "rtol": self.rtol, "bound": self.bound, "parts": parts}
        return made | {"outputs": list(self.outputs)}

    @property
    def _of(self) -> str:
        """Whose error, if not that of every result."""
        if self.outputs == OUTPUTS:
            return ""
        return " of " + ", ".join(name.replace("_", " ") for name in self.outputs)

    def __str__(self) -> str:
        """Method and bound in a sentence."""
        parts = ", ".join(
            f"{name} {_above(part.bound)} ({part.basis})"
            for name, part in self.parts.items()
            if part.bound
        )
        return (
            f"method {self.method} ({METHODS[self.method]}): "
            f"relative error{self._of} at most {_above(self.bound)}, of this {parts}"
        )


def _above(bound: float) -> str:
    """Two digits of a bound, rounded up."""
    text = f"{bound:.1e}"
    return text if float(text) >= bound else f"{1.05 * bound:.1e}"


DOUBT = 1e-3
"""By how much an impact's quadrature may misjudge the fastest speed, where a law is steep [1]."""


def check_rtol(rtol: float) -> float:
    """The tolerance, if doubles can meet it.

    Raises
    ------
    SceneError
        If it is not between 1e-13 and 1.
    """
    number = isinstance(rtol, (int, float)) and not isinstance(rtol, bool)
    if not number or not TIGHTEST <= rtol <= 1:
        raise SceneError(
            f"rtol: expected a relative tolerance from {TIGHTEST:g} to 1, got {shown(rtol)}; for "
            "more digits than doubles hold run `platecontact reference SCENE.toml --digits N`"
        )
    return float(rtol)


def solve_gated(gate: Gate, rtol: float | None = None) -> tuple[Results, Accuracy]:
    """The five results by the law that the gate decided on.

    Parameters
    ----------
    rtol
        Relative tolerance of every result [1], what the gate left out included; without it
        the full method.

    Raises
    ------
    SceneError
        If the impact leaves the law's range, or the tolerance is out of reach.
    """
    law, rest = gate.law, remaining(gate, rtol)
    if law.effects == WHOLE_PLATE | {"hertz"}:
        found, accuracy = solve(law.model, rest)
    elif "inertia" in law.effects:
        found, accuracy = _on_moving_plate(gate, rtol)
    else:
        found, accuracy = _composed(law)
    accuracy = replace(
        accuracy, rtol=rtol, effects=Part(gate.error, _basis(gate)), outputs=gate.outputs
    )
    if rtol is not None and accuracy.bound > rtol:
        where = f"for a contact as wide as a/R = {found[3] / law.model.R:.4g}"
        mend = "give a larger tolerance"
        if "inertia" in law.effects:
            where = "with the modes and branches that move"
            mend += ', more inertia.modes, or inertia.branches = "all"'
        raise SceneError(
            f"rtol: expected at least {_above(accuracy.bound)} {where}, got {rtol:.3g}; {mend}"
        )
    return found, accuracy


def remaining(gate: Gate, rtol: float | None) -> float | None:
    """What a tolerance leaves beside the effects left out [1]."""
    return None if rtol is None else (rtol - gate.error) / (1.0 + gate.error)


def _basis(gate: Gate) -> str:
    """What the bound of the effects left out rests on.

    Proofs speak of contacts that do not lag, and of the pressure under a paraboloid; what goes
    beyond them is held to random scenes.
    """
    open_ = (row for row in gate.rows if not row.included and row.name not in gate.forced_out)
    out = {row.name for row in open_ if row.bound}
    steeper = "pressure" in out and "curvature" in gate.law.effects
    moving = "inertia" in out | gate.law.effects
    return MEASURED if gate.law.model.viscous_time or steeper or moving else PROVED


def _composed(law: Law) -> tuple[Results, Accuracy]:
    """The results on a plate at rest by a law of any effects, and their bounds."""
    if law.effects <= {"hertz", "sphere_elasticity"}:
        closed = _half_space(law)
        if closed is not None:
            return closed
    found = moved(law)
    if found is None:
        check_energy(law, DOUBT)
        return (math.nan,) * 5, whole_law("full", None)
    return found.numbers, Accuracy(
        "full",
        None,
        law=Part(0.0, PROVED),
        quadrature=Part(found.quadrature, MEASURED),
        rounding=Part(_rounding(law), MEASURED),
    )


def _on_moving_plate(gate: Gate, rtol: float | None) -> tuple[Results, Accuracy]:
    """The results with inertia, and their bounds."""
    from derivation.scene import waves

    law, found = gate.law, moving(gate, rtol)
    if found is None:
        check_energy(replace(law, effects=law.effects - {"inertia", "viscosity"}), DOUBT)
        return (math.nan,) * 5, whole_law("full", None)
    return found.numbers, Accuracy(
        "full",
        None,
        law=Part(math.fsum(found.inertia.left(gate.outputs)), MEASURED),
        quadrature=Part(waves.INTEGRATION, MEASURED),
        rounding=Part(_rounding(law), MEASURED),
    )


def moving(gate: Gate, rtol: float | None) -> "WaveMotion | None":
    """The impact on a plate that moves, as the tolerance asks for; None beyond the law's range."""
    from derivation.scene import waves

    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        return waves.impact(gate.law, waves.goal(remaining(gate, rtol)), gate.outputs)


def moved(law: Law) -> motion.Motion | None:
    """The impact on a plate at rest by a law of any effects; None if it leaves the law's range."""
    with np.errstate(all="ignore"):
        if "viscosity" not in law.effects:
            return motion.impact(law)
        from derivation.scene import viscous

        return viscous.impact(law)


def _rounding(law: Law) -> float:
    """What tests hold the arithmetic to; that of the pressure and in time come on top."""
    rounding = kernels.ROUNDING
    if "pressure" in law.effects:
        from generated.true_pressure import ERROR

        rounding += ERROR
    if "viscosity" in law.effects:
        from derivation.scene.viscous import ROUNDING

        rounding += ROUNDING
    return rounding


def _half_space(law: Law) -> tuple[Results, Accuracy] | None:
    """Hertz's law in closed form, the modulus that of the contact; None for extreme numbers."""
    R, m, v0, h, b, lam, mu = law.model.numbers
    share = 1.0 / (1.0 + law.softness)
    found = kernels.hertz(R, m, v0, h, b, share * lam, share * mu)
    if found is None:
        return None
    rounding = Part(found.rounding, COUNTED)
    return (*found[:4], 1.0), Accuracy(
        "hertz", None, Part(0.0, PROVED), Part(0.0, PROVED), rounding
    )


def solve(model: Model, rtol: float | None = None) -> tuple[Results, Accuracy]:
    """The five results by the paper's law, of a rigid paraboloid, by the cheapest method.

    Parameters
    ----------
    rtol
        Relative tolerance of every result [1], from 1e-13 to 1; without it the full method.

    Raises
    ------
    SceneError
        If the impact leaves the contact law's range.
    """
    within = False
    if rtol is not None:
        for method in ("hertz", "leading"):
            found = _simple(model, method, rtol)
            if found is not None and found[1].bound <= rtol:
                return found
            within = within or found is not None  # a bound is one on the radius too
    if not within:
        check_energy(Law(model, WHOLE_PLATE))
    coarse = rtol is not None and whole_law("coarse", rtol).bound <= rtol
    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        values = kernels.impact(*model.numbers, coarse=coarse)
    contact_time, delta, P, a = (float(value) for value in values)
    return (contact_time, delta, P, a, 1.0), whole_law("coarse" if coarse else "full", rtol)


def whole_law(method: str, rtol: float | None) -> Accuracy:
    """The bounds of `coarse` and `full`, which do not depend on the scene."""
    coarse = method == "coarse"
    quadrature = kernels.COARSE_QUADRATURE if coarse else kernels.FULL_QUADRATURE
    return Accuracy(
        method,
        rtol,
        law=Part(0.0, PROVED),
        quadrature=Part(quadrature, MEASURED),
        rounding=Part(kernels.ROUNDING, MEASURED),
    )


def _simple(model: Model, method: str, rtol: float) -> tuple[Results, Accuracy] | None:
    """Results and bounds of `hertz` or `leading`; None where nothing is shown."""
    run = kernels.hertz if method == "hertz" else kernels.leading
    found = run(*model.numbers)
    if found is None:
        return None
    accuracy = Accuracy(
        method,
        rtol,
        law=Part(found.law, PROVED),
        quadrature=Part(found.quadrature, PROVED),
        rounding=Part(found.rounding, COUNTED),
    )
    return (*found[:4], 1.0), accuracy
