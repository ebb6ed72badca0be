"""Hard cases at the switch points of edge, back face, spherical profile and pressure."""

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import chain, product

from derivation.engine.measure.case import HardCase
from derivation.engine.measure.neighbours import (
    OFFSETS,
    Inputs,
    around,
    case_around,
    exact_inputs,
    neighbour,
)
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.back_face.kernels import tables as back_face_tables
from derivation.plate.blocks import blocks
from derivation.plate.cases.steel import LAM, MU
from derivation.plate.edge.kernels import tables as edge_tables
from derivation.plate.edge.theory.clamped import LEVEL_FIT
from derivation.plate.effects.kernels import numbers as effect_tables
from derivation.plate.grids import switches
from derivation.plate.pressure.kernels import numbers as pressure_tables

EDGE, BACK_FACE = "switch points of the edge", "switch points of the back face"
SPHERE, PRESSURE = "switch points of the sphere", "switch points of the non-Hertzian pressure"

SUMS = ("supported_edge", "supported_edge_slope")
CLAMPED = ("clamped_edge", "clamped_edge_slope")
BOUNDS = ("supported_edge_bound", "clamped_edge_bound")
CURVATURES = ("supported_edge_curvature", "clamped_edge_curvature")
BACK_FACE_EDGES = ("supported_back_face_stress", "clamped_back_face_stress")

_STEEL: dict[str, float] = {"lam": LAM, "mu": MU}
_FORCE = 1e3
_MODES = (1, 2, 3)
"""Modes whose switch points are tested; all modes use the constants code."""


def scene_families() -> Iterator[HardCase]:
    """Yield all cases; radius or half-thickness of the plate is 1 m."""
    return chain(_edge(), _back_face(), _sphere(), _pressure())


def _zero(mode: int) -> float:
    """Return the zero j_n of J0 as a double."""
    return float(j0_zero(mode, 80))


def _around_switch(
    group: str, kernels: tuple[str, ...], why: str, given: Inputs
) -> Iterator[HardCase]:
    """Yield a case for each function, with an array of doubles around a switch point."""
    return (case_around(group, kernel, why, given) for kernel in kernels)


def _one_by_one(
    group: str,
    kernels: tuple[str, ...],
    switch: float,
    why: str,
    argument: str,
    constants: dict[str, float],
) -> Iterator[HardCase]:
    """Yield cases with one double each, because all points of a call use equally many modes."""
    for kernel, offset in product(kernels, OFFSETS):
        given = exact_inputs(**{**constants, argument: neighbour(switch, offset)})
        yield HardCase(group, kernel, f"{offset:+d} ULP from {why}.", given)


def _last_mode(faded: int, mode: int) -> float:
    """Return h/b above which the sum has one mode less."""
    return faded / (2 * math.pi * mode)


# --- the edge


def _edge() -> Iterator[HardCase]:
    """Yield cases at the switch points of the sums over the modes of the edge."""
    for width in (0.1, 0.5, 0.8):
        switch = float((1 - Fraction(width)) / edge_tables.THIN)
        given = exact_inputs(a=width, h=around(switch), b=1.0, **_STEEL)
        why = f"b - a = {float(edge_tables.THIN):g} h, beyond which no sum is added"
        yield from _around_switch(EDGE, SUMS, f"{why}; a = {width:g} b", given)
        more = exact_inputs(P=_FORCE) | given
        yield from _around_switch(EDGE, BACK_FACE_EDGES[:1], f"{why}; a = {width:g} b", more)
    for mode in _MODES:
        switch = edge_tables.SWITCH / (2 * _zero(mode))
        given = exact_inputs(a=0.3, h=around(switch), b=1.0, **_STEEL)
        why = f"T = {edge_tables.SWITCH} of mode {mode}, where Q - 3 ceases to be a power series"
        yield from _around_switch(EDGE, SUMS, why, given)
    for mode in (1, 10):
        switch = _last_mode(edge_tables.FADED, mode)
        constants = {"a": 0.3, "b": 1.0, **_STEEL}
        why = f"h/b = {switch:.4g}, beyond which the sum has one mode less"
        yield from _one_by_one(EDGE, SUMS[1:], switch, why, "h", constants)
    yield from _shape(EDGE, SUMS[:1], {})
    yield from _curvatures()
    yield from _materials()
    widest, constants = float(edge_tables.WIDEST), {"h": 0.3, "b": 1.0, **_STEEL}
    why = f"a = {widest:g} b, the end of the tables"
    yield from _last(EDGE, (SUMS[1], CLAMPED[0]), widest, why, constants)
    yield from _last(EDGE, BACK_FACE_EDGES[:1], widest, why, {"P": _FORCE, **constants})


def _curvatures() -> Iterator[HardCase]:
    """Yield cases of the curvature by an edge, for thin and thick plates and both signs of nu."""
    switches = {
        float(1 / edge_tables.THIN): "b = {thin:g} h, beyond which no sum is added",
        edge_tables.SWITCH / (2 * _zero(1)): "T = {switch} of mode 1, where Q - 3 ceases to be a "
        "power series",
    }
    for switch, text in switches.items():
        why = text.format(thin=float(edge_tables.THIN), switch=edge_tables.SWITCH)
        given = exact_inputs(h=around(switch), b=1.0, **_STEEL)
        yield from _around_switch(EDGE, CURVATURES, why, given)
    for lam in (1e-3 * MU, 1e3 * MU, -0.6 * MU):
        sizes = {CURVATURES[0]: [0.01, 0.1, 1.0, 10.0, 1e3], CURVATURES[1]: [1e-90, 1e-8, 1.0, 1e3]}
        for kernel, heights in sizes.items():
            given = exact_inputs(h=heights, b=1.0, lam=lam, mu=MU)
            why = f"h/b from {heights[0]:g} to {heights[-1]:g} with lam = {lam / MU:g} mu."
            yield HardCase(EDGE, kernel, why, given, "array")


def _last(
    group: str, kernels: tuple[str, ...], end: float, why: str, constants: dict[str, float]
) -> Iterator[HardCase]:
    """Yield cases at the largest contact radius of a domain; above it NaN is expected."""
    for case in _one_by_one(group, kernels, end, why, "a", constants):
        yield replace(case, expect="nan") if case.numbers["a"][0] > end else case


def _shape(group: str, kernels: tuple[str, ...], more: dict[str, float]) -> Iterator[HardCase]:
    """Yield cases at the switch point of the function g(y) in modal sums."""
    for mode, switch in product(_MODES[:2], switches()["y"]):
        a = around(switch / _zero(mode))
        given = exact_inputs(**more, a=a, h=0.4, b=1.0, **_STEEL)
        why = f"y = {switch:g} of mode {mode}, where g(y) ceases to be a power series"
        yield from _around_switch(group, kernels, why, given)


def _materials() -> Iterator[HardCase]:
    """Yield cases at zeros and switch points that depend on the elastic constants."""
    why = "lam = mu, where the unit of stress changes from one to the other"
    for kernels, more in (((*SUMS, *CLAMPED, *BOUNDS), {}), (BACK_FACE_EDGES, {"P": _FORCE})):
        given = exact_inputs(**more, a=0.6, h=0.4, b=2.0, lam=around(MU), mu=MU)
        yield from _around_switch(EDGE, kernels, why, given)
    switch = math.sqrt((LAM + 2 * MU) / (2 * LAM))
    given = exact_inputs(a=0.3, h=around(switch), b=1.0, **_STEEL)
    why = f"h/b = {switch:.4g}, where 1 - 2 n eta^2, a factor of bending, changes sign"
    yield from _around_switch(EDGE, (*SUMS, *BOUNDS[:1]), why, given)
    n = LAM / (LAM + 2 * MU)
    level = 1000 / sum(c * n**i for i, c in enumerate(LEVEL_FIT))
    switch = math.sqrt(1 / (2 * n * (1 - 2 * level)))
    given = exact_inputs(a=0.3, h=around(switch), b=1.0, **_STEEL)
    why = f"h/b = {switch:.4g}, where 1 - s, a factor of bending at a clamp, changes sign"
    yield from _around_switch(EDGE, (*CLAMPED, *BOUNDS[1:]), why, given)


# --- the back face


def _back_face() -> Iterator[HardCase]:
    """Yield cases at the switch points of the stress on the back face."""
    every = ("back_face_stress", *BACK_FACE_EDGES)
    thin, wide = float(back_face_tables.THIN), float(back_face_tables.WIDE)
    for width in (1e-3, 0.3, 0.89):
        given = exact_inputs(P=_FORCE, a=width, h=around(thin), b=1.0, **_STEEL)
        why = f"h/b = {thin:g}, below which the sum of another plate is used; a = {width:g} b"
        yield from _around_switch(BACK_FACE, every if width == 0.3 else every[:1], why, given)
    for h in (2.0**-5, 2.0**-8):
        given = exact_inputs(P=_FORCE, a=around(wide * h), h=h, b=1.0, **_STEEL)
        why = f"a = {wide:g} h, from which a series in (h/a)^2 is used; h = {h:g} b"
        yield from _around_switch(BACK_FACE, every if h == 2.0**-5 else every[:1], why, given)
    narrow = float(back_face_tables.NARROW)
    for h in (3.0, 2.0**-2, 2.0**-6):
        given = exact_inputs(P=_FORCE, a=around(narrow * h), h=h, b=1.0, **_STEEL)
        why = f"a = {narrow:g} h, up to which a polynomial in a^2 is used; h = {h:g} b"
        yield from _around_switch(BACK_FACE, every if h == 2.0**-2 else every[:1], why, given)
    pair = float(blocks()["sinh_pair"].value.at)
    for mode in _MODES:
        switch = pair / (2 * _zero(mode))
        given = exact_inputs(P=_FORCE, a=0.3, h=around(switch), b=1.0, **_STEEL)
        why = f"T = {pair:g} of mode {mode}, where B(T) ceases to be a power series"
        yield from _around_switch(BACK_FACE, every if mode == 1 else every[:1], why, given)
    for mode in (1, 10):
        switch = _last_mode(back_face_tables.FADED, mode)
        constants = {"P": _FORCE, "a": 0.3, "b": 1.0, **_STEEL}
        why = f"h/b = {switch:.4g}, beyond which the sum has one mode less"
        yield from _one_by_one(BACK_FACE, every[:1], switch, why, "h", constants)
    yield from _shape(BACK_FACE, every, {"P": _FORCE})


# --- spherical profile and non-Hertzian pressure


def _sphere() -> Iterator[HardCase]:
    """Yield cases at the switch point of the contact with a spherical profile."""
    switch = math.sqrt(effect_tables.NEAR)
    why = f"(a/R)^2 = {float(effect_tables.NEAR):g}, the end of a series; beyond, a logarithm"
    yield from _around_switch(
        SPHERE, ("sphere_contact",), why, exact_inputs(a_over_R=around(switch))
    )


def _pressure() -> Iterator[HardCase]:
    """Yield cases at the switch points of the integral equation for the pressure."""
    constants: dict[str, float] = {"R": 1e3, "modulus": 7e10}
    thin = float(pressure_tables.THIN)
    for a in (0.01, 1.0, 3.0, 5.9):
        given = exact_inputs(a=a, h=1.0, b=around(thin), **constants)
        why = f"b = {thin:g} h, beyond which the integral of a thin plate is used; a = {a:g} h"
        yield from _around_switch(PRESSURE, ("contact",), why, given)
        yield from _around_switch(PRESSURE, ("pressure",), why, exact_inputs(r=0.75 * a) | given)
    for mode in (1, 20):
        switch = _last_mode(pressure_tables.FADED, mode)
        given = exact_inputs(a=0.3, h=around(switch), b=1.0, **constants)
        why = f"h/b = {switch:.4g}, beyond which the kernel has one mode less"
        yield from _around_switch(PRESSURE, ("contact",), why, given)
    widest = float(pressure_tables.WIDEST_OVER_B)
    why = f"a = {widest:g} b, the widest contact that is solved"
    yield from _last(PRESSURE, ("contact",), widest, why, {"h": 1.0, "b": 1.0, **constants})
