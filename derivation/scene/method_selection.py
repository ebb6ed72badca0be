"""Takes the cheapest method whose error bound meets a tolerance, and says what the bound rests on.

The effects of the law have been selected. From the fastest: `hertz` and `leading` have a proven
bound on what they omit of the plate's law; `coarse` and `full` take the whole law, with half the
nodes of the quadrature and with all. A bound is a relative error of all its results against the
law of every effect that the scene does not disable, the scene's numbers being exact doubles.
"""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from derivation.scene import kernels, motion
from derivation.scene.effect_selection import SelectedEffects
from derivation.scene.effects import BY_NAME, PAPER
from derivation.scene.effects.effect import Results
from derivation.scene.law import ContactLaw
from derivation.scene.limits import check_energy, check_numbers
from derivation.scene.messages import shown
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS, TIGHTEST, SceneError

if TYPE_CHECKING:
    from derivation.scene.wave_motion import DynamicImpact

METHODS = {
    "hertz": "Hertz's law alone",
    "leading": "Hertz's law and the plate's first correction",
    "coarse": "the law of every effect included, half the nodes",
    "full": "the law of every effect included",
}
"""From the cheapest to the dearest."""
BASES = PROVED, ROUNDING_ANALYSIS, TESTED, ESTIMATED = (
    "proved", "rounding_analysis", "tested", "estimated",
)  # fmt: skip
"""What a bound rests on, the strongest first: a proof; the number of operations times their
rounding; an error budget that the test suite enforces; an estimate without guarantee, as of
omitted modes and branches."""


@dataclass(frozen=True)
class Part:
    """One part of an error bound.

    Attributes
    ----------
    bound
        Relative error [1].
    basis
        `proved`, `rounding_analysis`, `tested` or `estimated`.
    """

    bound: float
    basis: str


@dataclass(frozen=True)
class AchievedAccuracy:
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
        Another part: the effects that the selection omitted.
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
            name: {
                "bound": part.bound if math.isfinite(part.bound) else None,
                "basis": part.basis,
            }
            for name, part in self.parts.items()
        }
        bound = self.bound if math.isfinite(self.bound) else None
        made = {"method": self.method, "rtol": self.rtol, "bound": bound, "parts": parts}
        return made | {"outputs": list(self.outputs)}

    @property
    def _of(self) -> str:
        """Whose error, if not that of every result."""
        if self.outputs == OUTPUTS:
            return ""
        return " of " + ", ".join(name.replace("_", " ") for name in self.outputs)

    @property
    def basis(self) -> str:
        """What the bound as a whole rests on: the weakest basis of its parts."""
        return max((part.basis for part in self.parts.values() if part.bound), key=BASES.index)

    @property
    def summary(self) -> str:
        """The bound in a few words."""
        if not math.isfinite(self.bound):
            return "no error bound is known"
        return f"relative error{self._of} at most {_above(self.bound)} ({self.basis})"

    def __str__(self) -> str:
        """Method and bound in a sentence."""
        if not math.isfinite(self.bound):
            return f"method {self.method} ({METHODS[self.method]}): no error bound is known"
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


def solve_selected(
    selected: SelectedEffects, rtol: float | None = None
) -> tuple[Results, AchievedAccuracy]:
    """The five results by the law of the selected effects.

    Parameters
    ----------
    rtol
        Relative tolerance of every result [1], the omitted effects included; without it
        the full method.

    Raises
    ------
    SceneError
        If the impact leaves the law's range, or the tolerance is out of reach.
    """
    law, rest = selected.law, remaining(selected, rtol)
    if law.of_paper:
        found, accuracy = solve(law.model, rest)
    elif law.dynamic:
        found, accuracy = _with_inertia(selected, rtol)
    else:
        found, accuracy = _composed(law)
    accuracy = replace(
        accuracy,
        rtol=rtol,
        effects=Part(selected.error, _basis(selected)),
        outputs=selected.outputs,
    )
    # An incomplete course has no bound: it is shown as what it is, not refused.
    if rtol is not None and rtol < accuracy.bound and not math.isnan(found[-1]):
        raise _out_of_reach(rtol, accuracy, law, found[3])
    check_numbers(law.model, *(found[:-1] if math.isnan(found[-1]) else found))
    return found, accuracy


def _out_of_reach(rtol: float, accuracy: AchievedAccuracy, law: ContactLaw, a: float) -> SceneError:
    """Of a tolerance that the results do not meet, or of which that cannot be told."""
    if math.isinf(accuracy.effects.bound):
        return SceneError(
            f"rtol: expected a bound on the omitted effects to compare {rtol:.3g} with, got none; "
            "leave out what [effects] disables, or the tolerance"
        )
    where = f"for a contact as wide as a/R = {a / law.model.R:.4g}"
    mend = "give a larger tolerance"
    if law.dynamic:
        where = "with the modes and branches that move"
        mend += ", or more inertia.modes"
    if math.isinf(accuracy.bound):
        return SceneError(
            f"inertia.modes: expected modes as fast as the contact, as the error bound requires, "
            f"got {law.model.inertia.modes}; give more, or remove the tolerance"
        )
    return SceneError(
        f"rtol: expected at least {_above(accuracy.bound)} {where}, got {rtol:.3g}; {mend}"
    )


def remaining(selected: SelectedEffects, rtol: float | None) -> float | None:
    """What a tolerance leaves beside the effects left out [1]."""
    return None if rtol is None else (rtol - selected.error) / (1.0 + selected.error)


def _basis(selected: SelectedEffects) -> str:
    """What the bound of the omitted effects rests on.

    Proofs are of elastic contacts on a quasi-static plate; others are tested on random scenes.
    """
    law = selected.law
    out = [row.name for row in selected.rows if row.bound and not (row.included or row.disabled)]
    proved = all(BY_NAME[name].proved(law) for name in out)
    return PROVED if proved and not (law.model.retardation_time or law.dynamic) else TESTED


def _composed(law: ContactLaw) -> tuple[Results, AchievedAccuracy]:
    """The results on a quasi-static plate by a law of any effects, and their bounds."""
    if law.hertzian and not (law.viscous or law.plastic or law.gravity):
        closed = _half_space(law)
        if closed is not None:
            return closed
    found = moved(law)
    return found.numbers, AchievedAccuracy(
        "full",
        None,
        law=Part(0.0, PROVED),
        quadrature=Part(found.quadrature, TESTED),
        rounding=Part(rounding_of(law) + _cancellation(law, found.max_contact_radius), TESTED),
    )


def _cancellation(law: ContactLaw, a: float) -> float:
    """Rounding error of the slope at a contact radius [m] [1]."""
    return float(law.cancellation(np.array([a]))[0])


def _with_inertia(
    selected: SelectedEffects, rtol: float | None
) -> tuple[Results, AchievedAccuracy]:
    """The results with inertia, and their bounds."""
    from derivation.scene import waves

    law, found = selected.law, dynamic_impact(selected, rtol)
    return found.numbers, AchievedAccuracy(
        "full",
        None,
        law=Part(math.fsum(found.inertia.left(selected.outputs)), ESTIMATED),
        quadrature=Part(max(waves.INTEGRATION, found.impact_history.tolerance), TESTED),
        rounding=Part(rounding_of(law), TESTED),
    )


def dynamic_impact(selected: SelectedEffects, rtol: float | None) -> "DynamicImpact":
    """The impact on a plate with inertia, as the tolerance asks for.

    Raises
    ------
    SceneError
        If it exceeds the law's range, or cannot be followed.
    """
    from derivation.scene import waves

    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        return waves.impact(selected.law, waves.goal(remaining(selected, rtol)), selected.outputs)


def moved(law: ContactLaw) -> motion.Motion:
    """The impact on a quasi-static plate by a law of any effects.

    Raises
    ------
    SceneError
        If it exceeds the law's range, or the sphere stays on the plate.
    """
    with np.errstate(all="ignore"):
        if law.viscous:
            from derivation.scene import viscous

            return viscous.impact(law)
        if law.plastic:
            from derivation.scene import plastic

            return plastic.impact(law)
        return motion.impact(law)


def rounding_of(law: ContactLaw) -> float:
    """What tests hold the arithmetic to; that of the pressure and in time come on top."""
    rounding = kernels.ROUNDING
    if law.solved:
        from generated.pressure_numbers import ERROR

        rounding += ERROR
    if law.viscous:
        from derivation.scene.viscous import ROUNDING

        rounding += ROUNDING
    if law.plastic:
        from derivation.scene.plastic import ROUNDING as STEPS

        rounding += STEPS
    return rounding


def _half_space(law: ContactLaw) -> tuple[Results, AchievedAccuracy] | None:
    """Hertz's law in closed form, the modulus that of the contact; None for extreme numbers."""
    R, m, v0, h, b, lam, mu = law.model.numbers
    share = 1.0 / (1.0 + law.softness)
    found = kernels.hertz(R, m, v0, h, b, share * lam, share * mu)
    if found is None:
        return None
    rounding = Part(found.rounding, ROUNDING_ANALYSIS)
    return (*found[:4], 1.0), AchievedAccuracy(
        "hertz", None, Part(0.0, PROVED), Part(0.0, PROVED), rounding
    )


def solve(model: Model, rtol: float | None = None) -> tuple[Results, AchievedAccuracy]:
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
        for method, run in (("hertz", kernels.hertz), ("leading", kernels.leading)):
            found = run(*model.numbers)
            if found is None:  # no bound is known
                continue
            accuracy = estimated(method, found, rtol)
            if accuracy.bound <= rtol:
                return (*found[:4], 1.0), accuracy
            within = True  # a bound is one on the radius too
    if not within:
        check_energy(ContactLaw(model, PAPER))
    coarse = rtol is not None and whole_law("coarse", rtol).bound <= rtol
    with np.errstate(all="ignore"):  # extreme scenes end in NaN, which is looked for
        values = kernels.impact(*model.numbers, coarse=coarse)
    contact_time, delta, P, a = (float(value) for value in values)
    check_numbers(model, contact_time, delta, P, a)
    return (contact_time, delta, P, a, 1.0), whole_law("coarse" if coarse else "full", rtol)


def whole_law(method: str, rtol: float | None) -> AchievedAccuracy:
    """The bounds of `coarse` and `full`, which do not depend on the scene."""
    coarse = method == "coarse"
    quadrature = kernels.COARSE_QUADRATURE if coarse else kernels.FULL_QUADRATURE
    return AchievedAccuracy(
        method,
        rtol,
        law=Part(0.0, PROVED),
        quadrature=Part(quadrature, TESTED),
        rounding=Part(kernels.ROUNDING, TESTED),
    )


def estimated(method: str, found: kernels.Estimate, rtol: float | None) -> AchievedAccuracy:
    """The bounds of `hertz` and `leading`."""
    return AchievedAccuracy(
        method,
        rtol,
        law=Part(found.law, PROVED),
        quadrature=Part(found.quadrature, PROVED),
        rounding=Part(found.rounding, ROUNDING_ANALYSIS),
    )
