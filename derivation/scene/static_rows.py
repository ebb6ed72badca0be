"""Impacts of many scenes on quasi-static plates: the methods of `method_selection`, in arrays."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.effects.effect import Array
from derivation.scene.law import ContactLaw
from derivation.scene.method_selection import estimated, rounding_of, whole_law
from derivation.scene.motion import SETTLED, closeness, largest_radii, results_at
from derivation.scene.quadrature import MORE_TIMES, NODES

WELL_WITHIN = 0.9
"""Contact radius over the law's limit up to which an impact is well within its range."""
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Impacts:
    """Impacts of rows with the same effects, each of shape (rows,); NaN where one scene decides.

    Attributes
    ----------
    contact_time, max_indentation, max_force, max_contact_radius
        The results, in s, m, N and m.
    law, quadrature, rounding
        The parts of the error bound, as of `AchievedAccuracy` [1].
    """

    contact_time: Array
    max_indentation: Array
    max_force: Array
    max_contact_radius: Array
    law: Array
    quadrature: Array
    rounding: Array

    def put(self, rows: Any, numbers: Any) -> None:
        """Set what is known of some rows."""
        for field, values in zip(fields(self), numbers, strict=True):
            getattr(self, field.name)[rows] = values


def impacts_of(law: ContactLaw, count: int, rest: Array | None) -> Impacts:
    """Impacts by a law whose impact has no method of its own.

    Parameters
    ----------
    law
        The law, with columns of numbers.
    count
        Number of rows.
    rest
        What a tolerance leaves beside the effects omitted, of each row [1]; None without one.
    """
    found = Impacts(*(np.full(count, np.nan) for _ in fields(Impacts)))
    if law.of_paper:
        _by_papers_law(law, rest, found)
    elif law.hertzian and not np.any(law.gravity):
        _on_half_space(law, found)
    else:
        _by_any_law(law, found)
    return found


def flat_numbers(law: ContactLaw, count: int) -> list[Array]:
    """R, m, v0, h, b, lam and mu of each row."""
    return [np.broadcast_to(x, (count, 1))[:, 0] for x in law.model.numbers]


def _by_papers_law(law: ContactLaw, rest: Array | None, found: Impacts) -> None:
    """By the cheapest method whose bound meets the tolerance, as `method_selection.solve`."""
    count = len(found.law)
    numbers = flat_numbers(law, count)
    left, coarse = np.ones(count, dtype=bool), np.zeros(count, dtype=bool)
    if rest is not None:
        coarse = whole_law("coarse", None).bound <= rest
        for row, (given, rtol) in enumerate(
            zip(zip(*(x.tolist() for x in numbers), strict=True), rest.tolist(), strict=True)
        ):
            for method, run in (("hertz", kernels.hertz), ("leading", kernels.leading)):
                one = run(*given)
                if one is not None and estimated(method, one, rtol).bound <= rtol:
                    found.put(row, one)
                    left[row] = False
                    break
    for method, some in (("coarse", left & coarse), ("full", left & ~coarse)):
        if some.any():
            with np.errstate(all="ignore"):
                values = kernels.impact(*(x[some] for x in numbers), coarse=method == "coarse")
            parts = whole_law(method, None)
            found.put(some, (*values, 0.0, parts.quadrature.bound, parts.rounding.bound))
    beyond = left & ~(found.max_contact_radius < WELL_WITHIN * _limits(law, count))
    found.put(beyond, [np.nan] * len(fields(found)))


def _limits(law: ContactLaw, count: int) -> Array:
    """The law's limit of each row [m]."""
    return np.broadcast_to(law.limit, (count, 1))[:, 0]


def _on_half_space(law: ContactLaw, found: Impacts) -> None:
    """Hertz's law in closed form, the modulus that of the contact."""
    count = len(found.law)
    share = np.broadcast_to(1.0 / (1.0 + law.softness), (count, 1))[:, 0]
    *lengths, lam, mu = flat_numbers(law, count)
    columns = (x.tolist() for x in (*lengths, share * lam, share * mu))
    for row, given in enumerate(zip(*columns, strict=True)):
        one = kernels.hertz(*given)
        if one is not None:
            found.put(row, (*one[:4], 0.0, 0.0, one.rounding))


def _by_any_law(law: ContactLaw, found: Impacts) -> None:
    """By energy and quadrature, nodes doubled until each row stands, as `motion.impact`."""
    whole, left, a = law, np.arange(len(found.law)), None
    before = change = None
    with np.errstate(all="ignore"):
        for n, times in [(n, n) for n in NODES] + [(NODES[1], n) for n in MORE_TIMES]:
            a = largest_radii(law, n, a, closeness(law))
            after = np.hstack((*results_at(law, a, n, times), a))
            if before is not None:
                change = np.max(np.abs(after / before - 1.0), axis=1)
                found.put(left, (*after.T, 0.0, change, 0.0))
                going_on = change > SETTLED  # not where NaN
                if not going_on.any():
                    break
                law, left = law.take(going_on), left[going_on]
                a, after = a[going_on], after[going_on]
            before = after
        cancelled = whole.cancellation(found.max_contact_radius[:, None])[:, 0]
    found.rounding[:] = rounding_of(whole) + cancelled
