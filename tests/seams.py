"""Where the generated code switches between ways to compute, for every kernel that does."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

import flint

from derivation.engine.rewrite.automatic import FADES
from derivation.engine.rewrite.form import FAR, ONCE
from derivation.mathematics.bessel import kernels as bessel_tables
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.back_face.kernels import tables as back_face_tables
from derivation.plate.blocks import blocks
from derivation.plate.cases import suite as hard_suite
from derivation.plate.contact.kernels import moments as moment_tables
from derivation.plate.contact.kernels import tables as contact_tables
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.edge.kernels import tables as edge_tables
from derivation.plate.effects.kernels import numbers as effect_tables
from derivation.plate.grids import seams
from derivation.plate.impact.kernels import simple as simple_impact_tables
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle.printed_motion import last_share
from derivation.plate.modes.kernels.forms import mode_forms
from derivation.plate.pressure.kernels import numbers as pressure_tables
from generated import contact_series

Point = Mapping[str, Fraction]
Place = float | Fraction


@dataclass(frozen=True)
class Seam:
    """A switch as hard cases must surround it.

    Parameters
    ----------
    kernels
        Each of them has cases there.
    of
        The variable it switches on, of a case's arguments.
    places
        Where.
    """

    kernels: tuple[str, ...]
    of: Callable[[Point], Fraction]
    places: Callable[[], Iterable[Place]]


EDGE_SUMS = ("supported_edge", "supported_edge_slope")
EDGES = (*EDGE_SUMS, "clamped_edge", "clamped_edge_slope")
BOUNDS = ("supported_edge_bound", "clamped_edge_bound")
FAR_EDGES = ("supported_far_stress", "clamped_far_stress")
BACK_FACE = ("far_stress", *FAR_EDGES)
SUMS = ("delta", "u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
PLATE_FACTORS = ("G", "G_m", "G_minus_1", "G_slope", "C_top", "C_bottom", "K_j", "K_j_bottom")
OMEGAS = ("Omega_1", "Omega_2", "Omega_3", "Omega_4")
LAW = ("indentation", "stiffness", "indentation_slope")


def zero(mode: int) -> float:
    return float(j0_zero(mode, 80))


def ratio(over: str, under: str) -> Callable[[Point], Fraction]:
    return lambda p: p[over] / p[under]


def depth(p: Point) -> Fraction:
    """T, of T itself or of 2 phi h."""
    return p["T"] if "T" in p else 2 * p["phi"] * p["h"]


def of_mode(T: Place) -> Callable[[], Iterable[Place]]:
    """h/b where T = 2 eta j of the first modes is a place."""
    return lambda: [float(T) / (2 * zero(mode)) for mode in (1, 2, 3)]


def last_modes(faded: int, *modes: int) -> Callable[[], Iterable[Place]]:
    return lambda: [faded / (2 * math.pi * mode) for mode in modes]


def cells() -> Iterable[Place]:
    ends = (*contact_tables.CELLS, *contact_tables.FAR_CELLS)
    return {Fraction(end) for cell in ends for end in cell[:2]}


def panels() -> Iterable[Place]:
    m, v0, xi_2, xi_3 = 72.0, 1.0, 7e6, 1e8
    with flint.ctx.workprec(100):
        last = float(last_share(m, v0, xi_2, xi_3))
    ends = (1 - 0.25**power for power in (1, 2, 5))
    return [math.asin(last * x**3) / math.sqrt(xi_2 / m) for x in ends]


def speeds() -> Iterable[Place]:
    energy = contact_impact.stored_energy(contact_tables.REACH, 50, 1, 10, 1.2e11, 8.1e10, 30)
    return [math.sqrt(2 * float(energy) / 1e3)]


def times() -> Iterable[Place]:
    """When the contact passes its reach and turns, of the scene that is in the suite."""
    scene = next(
        c for c in hard_suite.cases() if c.group == "seams of the impact" and c.kernel == "history"
    )
    R, m, v0, h, b, lam, mu = (scene.numbers[x][0] for x in ("R", "m", "v0", "h", "b", "lam", "mu"))
    (crossing,) = contact_impact.history([3], R, m, v0, h, b, lam, mu, 20)
    end = float(contact_impact.impact(R, m, v0, h, b, lam, mu, 20).contact_time)
    return [float(crossing), end / 2]


def wall_shares() -> Iterable[Place]:
    places = [pressure_tables.LOW / y for y in pressure_tables.wall_places()]
    places = [place for place in places if place < 0.9]
    return [places[0], places[-1]]


def simple_modes() -> Iterable[Place]:
    return [simple_impact_tables.FADED / (2 * zero(mode)) for mode in (1, 2, 17)]


def root_of_c1() -> Iterable[Place]:
    """By one step of Newton's from near it, where c_1 falls in a straight line."""
    eta, step = 0.5301974990742, 2.0**-30
    value, beyond = (contact_balls.coefficient(1, eta + x, 1, 20) for x in (0, step))
    return [eta - float(value) * step / float(beyond - value)]


def y_of(mode: int) -> float:
    (place,) = seams()["y"]
    return place / zero(mode)


PAIR = Fraction(int(blocks()["sinh_pair"].value.at))
SEAMS: dict[str, Seam] = {
    "Bessel": Seam(
        ("bessel_j0", "bessel_j1"), lambda p: p["x"], lambda: bessel_tables.seams()[1:]
    ),
    "T of closed forms": Seam(
        (*PLATE_FACTORS, "Omega_1", "Omega_4", "Omega_1_scaled", "Omega_4_scaled"),
        depth, lambda: [PAIR],
    ),
    "T beyond all change": Seam(
        ("C_top", "C_bottom", "K_j", "K_j_bottom", *(f"{name}_scaled" for name in OMEGAS)),
        depth, lambda: [2 * Fraction(int(FAR))],
    ),
    "T of G beyond all change": Seam(PLATE_FACTORS[:4], depth, lambda: [Fraction(int(FAR))]),
    "decay in two pieces": Seam(
        ("G_m", "C_bottom", "K_j_bottom"), depth, lambda: [Fraction(FADES)]
    ),
    "decay of G - 1 in two pieces": Seam(
        ("G_minus_1", "G_slope"), depth, lambda: [Fraction(FADES, 2)]
    ),
    "decay of the constants in two pieces": Seam(OMEGAS, depth, lambda: [Fraction(2 * FADES)]),
    "y of the load": Seam(("sonine", "A_j"), lambda p: p["a"] * p["phi"], lambda: seams()["y"]),
    "T of mode shapes": Seam(
        tuple(mode_forms().keys() - {"mode_g"}), depth, lambda: [mode_forms()["mode_f"][1].at]
    ),
    "T of mode_g": Seam(("mode_g",), depth, lambda: [mode_forms()["mode_g"][1].at]),
    "decay through the thickness": Seam(
        tuple(mode_forms()), lambda p: p["phi"] * (p["h"] - p["z"]), lambda: [Fraction(int(ONCE))]
    ),
    "u of mode_zz": Seam(
        ("mode_zz",),
        lambda p: p["phi"] * (p["h"] + p["z"]),
        lambda: [float(blocks()["sinh_minus"].value.at)],
    ),
    "T of the sums": Seam(
        SUMS, ratio("h", "b"), lambda: [T / (2 * zero(1)) for T in seams()["T"]]
    ),
    "y of the sums": Seam(SUMS, ratio("a", "b"), lambda: [y_of(1)]),
    "axis of the sums": Seam(
        ("sigma_rr", "sigma_tt"), ratio("r", "b"), lambda: [2.0**-30 / zero(1)]
    ),
    "index of kappa": Seam(
        ("kappa_ratio",), lambda p: p["n"], lambda: [moment_tables.kappa_start()]
    ),
    "index of the finite part": Seam(
        ("finite_part_ratio",), lambda p: p["k"], lambda: [moment_tables.finite_part_start()]
    ),
    "cells of the law": Seam((*LAW, "impact_sensitivities"), ratio("b", "h"), cells),
    "short reach of the law": Seam(
        ("indentation",), ratio("a", "h"),
        lambda: [Fraction(contact_tables.REACH, contact_tables.SHORT)],
    ),
    "reach of the law": Seam(LAW, ratio("a", "h"), lambda: [Fraction(contact_tables.REACH)]),
    "far reach of the law": Seam(
        LAW, ratio("a", "h"), lambda: [Fraction(contact_tables.FAR_REACH)]
    ),
    "reach of the inversion": Seam(
        ("contact_radius", "force"), ratio("delta", "h"),
        lambda: [float(contact_balls.indentation(contact_tables.REACH, 50, 1, 10, 30))],
    ),
    "modes of the direct sum": Seam(
        ("indentation",), ratio("b", "h"), lambda: [30 / 3.9]  # as the name in the table says
    ),
    "thinnest sum": Seam(
        ("indentation",), ratio("h", "b"), lambda: [contact_series.THINNEST_SUM]
    ),
    "one sphere": Seam(("indentation",), lambda p: p["R"], lambda: contact_series._ORDINARY),
    "one plate's thickness": Seam(
        ("indentation",), lambda p: p["h"], lambda: contact_series._ORDINARY
    ),
    "one plate's ratio": Seam(("indentation",), ratio("h", "b"), lambda: contact_series._USUAL),
    "reach of an impact": Seam(("impact", "impact_sensitivities"), lambda p: p["v0"], speeds),
    "times of an impact": Seam(("history",), lambda p: p["t"], times),
    "thin edge": Seam(
        (*EDGE_SUMS, *FAR_EDGES[:1]), lambda p: (p["b"] - p["a"]) / p["h"],
        lambda: [Fraction(int(edge_tables.THIN.p), int(edge_tables.THIN.q))],
    ),
    "T of the edge": Seam(EDGE_SUMS, ratio("h", "b"), of_mode(edge_tables.SEAM)),
    "y of the edge": Seam(
        (*EDGE_SUMS[:1], *BACK_FACE), ratio("a", "b"), lambda: [y_of(1), y_of(2)]
    ),
    "modes of the edge": Seam(
        EDGE_SUMS[1:], ratio("h", "b"), last_modes(edge_tables.FADED, 1, 10)
    ),
    "lam = mu": Seam((*EDGES, *BOUNDS, *FAR_EDGES, "mode_g"), ratio("lam", "mu"), lambda: [1]),
    "thin plates of the back face": Seam(
        BACK_FACE, ratio("h", "b"), lambda: [float(back_face_tables.THIN)]
    ),
    "wide contacts of the back face": Seam(
        BACK_FACE, ratio("a", "h"), lambda: [Fraction(int(back_face_tables.WIDE))]
    ),
    "T of the back face": Seam(("far_stress",), ratio("h", "b"), of_mode(PAIR)),
    "modes of the back face": Seam(
        ("far_stress",), ratio("h", "b"), last_modes(back_face_tables.FADED, 1, 10)
    ),
    "sphere": Seam(
        ("sphere_contact",), lambda p: p["a_over_R"], lambda: [math.sqrt(effect_tables.NEAR)]
    ),
    "thin plates of the pressure": Seam(
        ("contact", "pressure"), ratio("b", "h"), lambda: [Fraction(pressure_tables.THIN)]
    ),
    "modes of the pressure": Seam(
        ("contact",), ratio("h", "b"), last_modes(pressure_tables.FADED, 1, 20)
    ),
    "wall of the pressure": Seam(("contact",), ratio("a", "b"), wall_shares),
    "widest contact": Seam(
        ("contact",), ratio("a", "b"), lambda: [float(pressure_tables.WIDEST_SHARE)]
    ),
    "thin plates of simple impacts": Seam(
        ("hertz", "leading"), ratio("b", "h"), lambda: [Fraction(simple_impact_tables.THIN)]
    ),
    "modes of simple impacts": Seam(("plate_of",), lambda p: p["eta"], simple_modes),
    "c_1 = 0": Seam(("plate_of",), lambda p: p["eta"], root_of_c1),
    "panels of the paper's motion": Seam(("corrected",), lambda p: p["t"], panels),
}  # fmt: skip
"""By name, for every kernel that has the switch in its own code or needs it most."""
