"""Impacts of many scenes on quasi-static plates: the methods of `method_selection`, in arrays."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene import kernels
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.numerics.quadrature import MORE_TIMES, NODES
from derivation.scene.quasi_static import simple_laws, viscous, yield_phases
from derivation.scene.quasi_static.closed_form import bend_of, only_bends
from derivation.scene.quasi_static.motion import closeness, largest_radii, results_at, settled
from derivation.scene.selection.method_selection import rounding_of, whole_law
from generated.arrays import Double as Array

TOGETHER = 2048
"""Number of rows whose quadratures are computed together, so that they fit into the cache."""
NEAR = 1e-9
"""Relative distance from a tolerance at which the row is simulated singly."""
WELL_WITHIN = 0.9
"""Largest contact radius over the limit of the law for results from arrays."""
UNKNOWN = (np.nan,) * 7
"""Results of a row to simulate singly."""
Rows = NDArray[np.intp]


@dataclass(frozen=True)
class Impacts:
    """Impacts of rows with the same effects, shape (rows,); NaN for rows to simulate singly.

    Attributes
    ----------
    contact_time, max_indentation, max_force, max_contact_radius
        The results, in s, m, N and m.
    law, quadrature, rounding
        The parts of the error bound, as of `AchievedAccuracy` [1].
    restitution
        The restitution [1].
    """

    contact_time: Array
    max_indentation: Array
    max_force: Array
    max_contact_radius: Array
    law: Array
    quadrature: Array
    rounding: Array
    restitution: Array

    def put(self, rows: Any, numbers: Any, restitution: Any = 1.0) -> None:
        """Set the values of some rows."""
        for field, values in zip(fields(self), (*numbers, restitution), strict=True):
            getattr(self, field.name)[rows] = values


def impacts_of(law: ContactLaw, count: int, rest: Array | None) -> Impacts:
    """Compute impacts by a law of quasi-static plates.

    Parameters
    ----------
    law
        The law, with columns of numbers.
    count
        Number of rows.
    rest
        Relative tolerance minus the error of the omitted effects, for each row; None without a
        tolerance.
    """
    impacts = Impacts(*(np.full(count, np.nan) for _ in fields(Impacts)))
    if law.of_paper:
        _by_papers_law(law, rest, impacts)
    elif law.viscous:
        _in_blocks(law, impacts, _viscous, viscous.TOGETHER)
    elif law.hertzian and not (law.plastic or np.any(law.gravity)):
        _in_closed_form(law, impacts)
    elif only_bends(law) and not (law.plastic or np.any(law.gravity)):
        _in_closed_form(law, impacts, bend_of(law))
    elif law.plastic:
        _in_blocks(law, impacts, _plastic)
    else:
        _in_blocks(law, impacts, _elastic)
    return impacts


def flat_numbers(law: ContactLaw, count: int) -> list[Array]:
    """Return R, m, v0, h, b, lam and mu of each row."""
    return [np.broadcast_to(x, (count, 1))[:, 0] for x in law.model.numbers]


def _by_papers_law(law: ContactLaw, rest: Array | None, impacts: Impacts) -> None:
    """Use the fastest method whose bound meets the tolerance, like `method_selection.solve`."""
    count = len(impacts.law)
    numbers = flat_numbers(law, count)
    left, coarse = np.ones(count, dtype=bool), np.zeros(count, dtype=bool)
    if rest is not None:
        coarse = whole_law("coarse", None).bound <= rest
        for run in (simple_laws.hertz, simple_laws.leading):
            selected = np.flatnonzero(left)
            with np.errstate(all="ignore"):
                estimates = run(*(x[selected] for x in numbers))
                parts = np.broadcast_arrays(*estimates)
                bound = np.expm1(np.sum(np.log1p(parts[-3:]), axis=0))
            good = bound <= rest[selected]
            impacts.put(selected[good], [part[good] for part in parts])
            near = np.abs(bound - rest[selected]) <= NEAR * rest[selected]  # rounding could decide
            impacts.put(selected[near], UNKNOWN)
            left[selected[good | near]] = False
    for method, rows in (("coarse", left & coarse), ("full", left & ~coarse)):
        if rows.any():
            with np.errstate(all="ignore"):
                values = kernels.impact(*(x[rows] for x in numbers), coarse=method == "coarse")
            accuracy = whole_law(method, None)
            bounds = accuracy.quadrature.bound, accuracy.rounding.bound
            impacts.put(rows, (*values, 0.0, *bounds))
    beyond = left & ~(impacts.max_contact_radius < WELL_WITHIN * _limits(law, count))
    impacts.put(beyond, UNKNOWN)


def _limits(law: ContactLaw, count: int) -> Array:
    """Return the largest contact radius of the law for each row [m]."""
    return np.broadcast_to(law.limit, (count, 1))[:, 0]


def _in_closed_form(law: ContactLaw, impacts: Impacts, bend: Array | None = None) -> None:
    """Use Hertz's law, or that of a plate that only bends, with the modulus E* of the contact."""
    count = len(impacts.law)
    modulus_ratio = np.broadcast_to(1.0 / (1.0 + law.softness), (count, 1))[:, 0]
    R, m, v0, h, b, lam, mu = flat_numbers(law, count)
    numbers = R, m, v0, h, b, modulus_ratio * lam, modulus_ratio * mu
    with np.errstate(all="ignore"):
        if bend is None:
            one, quadrature, rounding = simple_laws.hertz(*numbers), 0.0, 0.0
        else:
            one = simple_laws.bent(*numbers, np.broadcast_to(bend, (count, 1))[:, 0])
            quadrature, rounding = one.quadrature, rounding_of(law)
    known = np.isfinite(one.law)
    impacts.put(known, (*(x[known] for x in one[:4]), 0.0, quadrature, one.rounding + rounding))


def _in_blocks(
    law: ContactLaw,
    impacts: Impacts,
    run: Callable[[ContactLaw, Rows, Impacts], None],
    together: int = TOGETHER,
) -> None:
    """Use a quadrature or time elements for a few rows at a time."""
    count = len(impacts.law)
    for start in range(0, count, together):
        rows = np.arange(start, min(start + together, count))
        part = law.take(rows)
        with np.errstate(all="ignore"):
            run(part, rows, impacts)
            cancelled = part.cancellation(impacts.max_contact_radius[rows, None])[:, 0]
        impacts.rounding[rows] = rounding_of(law) + cancelled


def _plastic(law: ContactLaw, rows: Rows, impacts: Impacts) -> None:
    """Use the quadratures of `plastic.impact`; those of elastic contacts for rows without yield."""
    (*results, _), error = yield_phases.impacts(law)
    yielding = error[:, 0] <= yield_phases.ENOUGH
    *numbers, restitution, quadrature = (column[yielding, 0] for column in (*results, error))
    impacts.put(rows[yielding], (*numbers, 0.0, quadrature, 0.0), restitution)
    if yielding.all():
        return
    law, rows = law.take(~yielding), rows[~yielding]
    _elastic(yield_phases.without_plasticity(law), rows, impacts)
    certain = impacts.max_contact_radius[rows] <= yield_phases.onset_in(law).a[:, 0]
    impacts.put(rows[~certain], UNKNOWN)


def _viscous(law: ContactLaw, rows: Rows, impacts: Impacts) -> None:
    """Use the time elements of `viscous.impact`, in units of the impacts without viscosity."""
    elastic = law.only(lambda effect: not effect.viscous)
    units = Impacts(*(np.full(len(rows), np.nan) for _ in fields(Impacts)))
    _elastic(elastic, np.arange(len(rows)), units)
    a, T = units.max_contact_radius[:, None], units.contact_time[:, None]
    known = (np.isfinite(T) & (T > 0.0) & (a < law.limit))[:, 0]
    if not known.any():
        return
    *numbers, restitution, quadrature = viscous.impacts(law.take(known), a[known], T[known])
    columns = (column[:, 0] for column in (*numbers, np.zeros_like(quadrature), quadrature))
    impacts.put(rows[known], (*columns, 0.0), restitution[:, 0])


def _elastic(law: ContactLaw, rows: Rows, impacts: Impacts) -> None:
    """Use the energy integral, like `motion.impact`: double the nodes until rows have converged."""
    left, a = rows, None
    before = change = None
    for n, times in [(n, n) for n in NODES] + [(NODES[1], n) for n in MORE_TIMES]:
        a = largest_radii(law, n, a, closeness(law))
        after = np.hstack((*results_at(law, a, n, times), a))
        if before is not None:
            change = np.max(np.abs(after / before - 1.0), axis=1)
            impacts.put(left, (*after.T, 0.0, change, 0.0))
            going_on = change > settled(times)  # not where NaN
            if not going_on.any():
                break
            law, left = law.take(going_on), left[going_on]
            a, after = a[going_on], after[going_on]
        before = after
