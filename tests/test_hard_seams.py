"""No switch of the generated code without hard cases on both sides of it, or a reason why not."""

import ast
import math
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import flint
import pytest
from mpmath import mp, mpf

import generated
from derivation.formula.ulp import ordinal
from derivation.measure import hard_check
from derivation.measure.grids import seams
from derivation.measure.hard import Case
from derivation.measure.hard_places import OFFSETS
from derivation.reference import contact_balls, contact_impact
from derivation.reference.printed_motion_balls import last_share
from derivation.reference.zeros import j0_zero
from derivation.rewrite import (
    bessel_tables,
    contact_tables,
    edge_tables,
    effect_tables,
    far_face_tables,
    held_tables,
    moment_tables,
    pressure_tables,
    simple_impact_tables,
)
from derivation.rewrite.automatic import FADES
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import FAR, ONCE
from derivation.rewrite.mode_forms import mode_forms
from generated import contact_series, inertia, plate_waves, true_pressure
from generated.plate_waves import branches

Point = Mapping[str, Fraction]
Place = float | Fraction

SWITCHES: dict[str, dict[str, str]] = tomllib.loads(
    (Path(__file__).parent / "switches.toml").read_text()
)
"""By module and as code: a name of `SEAMS`, or the reason why it is none."""

REASONS = {"domain", "range", "iteration", "shape", "bound", "end"}

_CHOICES = {"minimum", "maximum", "min", "max", "clip", "heaviside", "searchsorted", "int"}
_PLAIN = {"manifest", "as_printed", "__init__"}
"""Modules without numerics of their own, or with none that promises anything."""


# --- what the generated code switches on


def switches(source: str) -> set[str]:
    """Comparisons and choices in a module, but for those that state a domain by `inside`."""
    found: set[str] = set()

    def visit(node: ast.AST) -> None:
        name = ""
        if isinstance(node, ast.Call):
            function = node.func
            name = function.attr if isinstance(function, ast.Attribute) else ""
            name = function.id if isinstance(function, ast.Name) else name
        if name == "inside":
            return
        if name in _CHOICES and isinstance(node, ast.Call) and (node.args or name == "heaviside"):
            found.add(ast.unparse(node))
        if isinstance(node, ast.Compare) and not isinstance(node.ops[0], ast.Is | ast.IsNot):
            found.add(ast.unparse(node))
        for child in ast.iter_child_nodes(node):
            visit(child)

    visit(ast.parse(source))
    return {text for text in found if ".kind " not in text}


def modules() -> list[Path]:
    (folder,) = generated.__path__
    return [path for path in sorted(Path(folder).glob("*.py")) if path.stem not in _PLAIN]


@pytest.mark.parametrize("path", modules(), ids=lambda path: path.stem)
def test_every_switch_is_known(path: Path) -> None:
    """A new one needs a name here: that of its cases' seam, or the reason why it has none."""
    known = SWITCHES.get(path.stem, {})
    found = switches(path.read_text())
    assert found - known.keys() == set(), "switches without a name"
    assert known.keys() - found == set(), "names without a switch"


def test_a_new_switch_is_noticed() -> None:
    (source,) = (path.read_text() for path in modules() if path.stem == "edge")
    for line in ("np.where(T < 3.0, low, high)", "np.maximum(y, _THIN)", "int(7 / eta)"):
        assert switches(f"{source}\nx = {line}\n") - SWITCHES["edge"].keys()


def names(module: str) -> set[str]:
    return {name for value in SWITCHES[module].values() for name in value.split(", ")}


def test_every_name_is_a_seam_or_a_reason() -> None:
    named = {name for module in SWITCHES for name in names(module)}
    assert named - REASONS == SEAMS.keys()


# --- where they are


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


EDGES = ("supported_edge", "clamped_edge", "supported_edge_slope", "clamped_edge_slope")
BOUNDS = ("supported_edge_bound", "clamped_edge_bound")
FAR_EDGES = ("supported_far_stress", "clamped_far_stress")
FAR_FACE = ("far_stress", *FAR_EDGES)
SUMS = ("delta", "u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
PLATE_FACTORS = ("G", "G_m", "G_minus_1", "G_slope", "C_top", "C_bottom", "K_j", "K_j_bottom")
OMEGAS = ("Omega_1", "Omega_2", "Omega_3", "Omega_4")
LAW = ("indentation", "stiffness", "indentation_slope")
LOWEST = ("bending_frequency", "bending_residue", "bending_share")


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
        c for c in hard_check.cases() if c.group == "seams of the impact" and c.kernel == "history"
    )
    R, m, v0, h, b, lam, mu = (scene.numbers[x][0] for x in ("R", "m", "v0", "h", "b", "lam", "mu"))
    (crossing,) = contact_impact.history([3], R, m, v0, h, b, lam, mu, 20)
    end = float(contact_impact.impact(R, m, v0, h, b, lam, mu, 20).contact_time)
    return [float(crossing), end / 2]


def wall_shares() -> Iterable[Place]:
    places = [true_pressure._LOW / y for y in pressure_tables.wall_places()]
    places = [place for place in places if place < 0.9]
    return [places[0], places[-1]]


def simple_modes() -> Iterable[Place]:
    return [simple_impact_tables.FADED / (2 * zero(mode)) for mode in (1, 2, 17)]


def root_of_c1() -> Iterable[Place]:
    """By one step of Newton's from near it, where c_1 falls in a straight line."""
    eta, step = 0.5301974990742, 2.0**-30
    value, beyond = (contact_balls.coefficient(1, eta + x, 1, 20) for x in (0, step))
    return [eta - float(value) * step / float(beyond - value)]


def gam(p: Point) -> Fraction:
    return (1 - 2 * p["nu"]) / (2 * (1 - p["nu"]))


def root(x: Fraction) -> Fraction:
    """The square root to many digits."""
    return Fraction(math.isqrt(int(x * 2**200)), 2**100)


def both_roots(p: Point) -> Fraction:
    """p + q, where both are real."""
    squares = p["x"] ** 2 - gam(p) * p["kap"], p["x"] ** 2 - p["kap"]
    return sum(map(root, squares), Fraction(0)) if min(squares) >= 0 else Fraction(0)


def half_part() -> Iterable[Place]:
    """J0/I0 = 1/2 at the first mode of a simple support."""
    with mp.workdps(30):
        k = mp.findroot(lambda k: mp.besselj(0, k) / mp.besseli(0, k) - 0.5, 1.3)
        rise = mp.besselj(1, k) / mp.besselj(0, k) + mp.besseli(1, k) / mp.besseli(0, k)
        return [float(1 - 2 * k / rise)]


Condition = Callable[[Any, Any], Any]


def of_branch(
    kind: str, nu: float, index: int, conditions: Mapping[float, Condition]
) -> Callable[[], Iterable[Place]]:
    """x near a first guess, where a branch fulfils a condition in p^2 and q^2."""

    def places() -> Iterable[Place]:
        with mp.workdps(30):
            level = (1 - 2 * mpf(nu)) / (2 * (1 - mpf(nu)))

            def bracket(x: Any, kap: Any) -> Any:
                p, q, m = x * x - level * kap, x * x - kap, (2 * x * x - kap) ** 2
                if kind == "symmetric":
                    return m / (p * share(p)) - 4 * x * x / share(q)
                return m * share(p) - 4 * x * x * q * share(q)

            def excess(x: Any, condition: Condition) -> Any:
                start = mpf(float(branches(float(x), nu, index + 1, kind)[0][index])) ** 2
                ends = start * (1 - mpf(10) ** -12), start * (1 + mpf(10) ** -12)
                kap = mp.findroot(lambda kap: bracket(x, kap), ends)
                return condition(x * x - level * kap, x * x - kap)

            for guess, condition in conditions.items():
                ends = guess, guess * 1.001
                yield float(mp.findroot(lambda x, c=condition: excess(x, c), ends))

    return places


def at_x(
    kind: str, nu: float, index: int, conditions: Mapping[float, Condition]
) -> tuple[tuple[str, ...], Callable[[Point], Fraction], Callable[[], Iterable[Place]]]:
    """A seam of a branch's residue in x."""
    return (f"{kind}_residue",), lambda p: p["x"], of_branch(kind, nu, index, conditions)


def share(square: Any) -> Any:
    """tanh(y)/y of y^2."""
    size = mp.sqrt(abs(square))
    return (mp.tanh(size) if square > 0 else mp.tan(size)) / size if size else mpf(1)


def sizes(square: Any) -> tuple[Any, Any]:
    """|cosh| and |sinh| of a root of a square, over its exponential if it is real."""
    size = mp.sqrt(abs(square))
    if square > 0:
        return mp.cosh(size) * mp.exp(-size), mp.sinh(size) * mp.exp(-size)
    return abs(mp.cos(size)), abs(mp.sin(size))


def smallest(p: Any, q: Any) -> Any:
    (cosh_p, sinh_p), (cosh_q, sinh_q) = sizes(p), sizes(q)
    return min(sinh_p, sinh_q) - min(cosh_p, cosh_q)


def lifted(p: Any, q: Any) -> Any:
    return sizes(p)[1] * mp.sqrt(abs(p)) - sizes(q)[1] / mp.sqrt(abs(q))


A1_CLOSE: dict[float, Condition] = {
    1.42: lambda p, _: p + plate_waves._CLOSE,
    1.83: lambda p, _: p - plate_waves._CLOSE,
}
S0_CLOSE: dict[float, Condition] = {
    0.37: lambda _, q: q + plate_waves._CLOSE,
    3.5: lambda _, q: q - plate_waves._CLOSE,
}


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
        (*EDGES, *FAR_EDGES), lambda p: (p["b"] - p["a"]) / p["h"],
        lambda: [Fraction(int(edge_tables.THIN.p), int(edge_tables.THIN.q))],
    ),
    "T of the edge": Seam(EDGES, ratio("h", "b"), of_mode(edge_tables.SEAM)),
    "y of the edge": Seam(
        (*EDGES[:2], *FAR_FACE), ratio("a", "b"), lambda: [y_of(1), y_of(2)]
    ),
    "modes of the edge": Seam(
        EDGES[1:3], ratio("h", "b"), last_modes(edge_tables.FADED, 1, 10)
    ),
    "lam = mu": Seam((*EDGES, *BOUNDS, *FAR_EDGES, "mode_g"), ratio("lam", "mu"), lambda: [1]),
    "thin far face": Seam(FAR_FACE, ratio("h", "b"), lambda: [float(far_face_tables.THIN)]),
    "wide contacts of the far face": Seam(
        FAR_FACE, ratio("a", "h"), lambda: [Fraction(int(far_face_tables.WIDE))]
    ),
    "T of the far face": Seam(("far_stress",), ratio("h", "b"), of_mode(PAIR)),
    "modes of the far face": Seam(
        ("far_stress",), ratio("h", "b"), last_modes(far_face_tables.FADED, 1, 10)
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
    "modes at infinity": Seam(
        ("clamped_modes", "supported_modes"), lambda p: p["count"],
        lambda: [held_tables.modes_before(bessel_tables.asymptotic_start()) + 1],
    ),
    "part of the first mode": Seam(("supported_modes",), lambda p: p["nu"], half_part),
    "x of the lowest branch": Seam(LOWEST, lambda p: p["x"], lambda: [inertia._SHALLOW]),
    "x of its share": Seam(LOWEST[2:], lambda p: p["x"], lambda: [inertia._SMALL]),
    "T of its share": Seam(
        LOWEST[2:], lambda p: 2 * p["x"], lambda: [float(blocks()["sinh_minus"].value.at)]
    ),
    "q = 0": Seam(("dynamic_influence",), lambda p: p["kap"] / p["x"] ** 2, lambda: [1]),
    "p = 0": Seam(("dynamic_influence",), lambda p: gam(p) * p["kap"] / p["x"] ** 2, lambda: [1]),
    "2 q = p": Seam(
        ("dynamic_influence",), lambda p: (4 - gam(p)) * p["kap"] / (3 * p["x"] ** 2), lambda: [1]
    ),
    "p + q of the influence": Seam(("dynamic_influence",), both_roots, lambda: [inertia._NEAR]),
    "smallest in bending": Seam(*at_x("antisymmetric", 0.3, 1, {1.17: smallest})),
    "smallest in stretching": Seam(*at_x("symmetric", 0.3, 1, {1.12: smallest})),
    "cosh p = cosh q": Seam(
        *at_x("antisymmetric", -0.2, 1, {0.86: lambda p, q: sizes(p)[0] - sizes(q)[0]})
    ),
    "p sinh p = sinh(q)/q": Seam(*at_x("symmetric", -0.2, 1, {5.15: lifted})),
    "small p": Seam(*at_x("antisymmetric", 0.3, 1, A1_CLOSE)),
    "small q": Seam(*at_x("symmetric", 0.3, 0, S0_CLOSE)),
    "p = 0 of a branch": Seam(*at_x("antisymmetric", 0.3, 1, {1.6: lambda p, _: p})),
    "q = 0 of a branch": Seam(*at_x("symmetric", 0.3, 0, {3.35: lambda _, q: q})),
}  # fmt: skip
"""By name, for every kernel that has the switch in its own code or needs it most."""


def missing(seam: Seam, cases: Iterable[Case]) -> list[str]:
    """Kernels and places without cases at the place, and 1 and 32 ULP to either side."""
    values: dict[str, set[float]] = {kernel: set() for kernel in seam.kernels}
    for case in cases:
        if case.kernel in values:
            for point in case.points:
                if all(map(math.isfinite, point.values())):
                    values[case.kernel].add(value_of(seam, point))
    return [
        f"{kernel} at {float(place):.17g}"
        for place in seam.places()
        for kernel, found in values.items()
        if not surrounded(place, found)
    ]


def value_of(seam: Seam, point: Mapping[str, float]) -> float:
    """The variable as a double; NaN where it has no meaning."""
    try:
        return float(seam.of({name: Fraction(x) for name, x in point.items()}))
    except (ZeroDivisionError, OverflowError, KeyError):
        return math.nan


def surrounded(place: Place, found: Iterable[float]) -> bool:
    """Whether values lie as `OFFSETS` do, up to what rounding the variable makes of them.

    Whole numbers are their own neighbours.
    """
    if isinstance(place, int) and place > 1:
        return {place + offset for offset in OFFSETS if place + offset > 0} <= set(found)
    middle = ordinal(float(place))
    steps = [ordinal(x) - middle for x in found if math.isfinite(x)]
    near = sorted(step for step in steps if abs(step) <= 80)
    beside = [step for step in near if abs(step) <= 4]
    return (
        len(near) >= len(OFFSETS)
        and near[0] <= -14
        and near[-1] >= 14
        and any(step < 0 for step in beside)
        and any(step > 0 for step in beside)
    )


@pytest.mark.parametrize("name", SEAMS)
def test_every_seam_has_cases_on_both_sides(name: str) -> None:
    assert missing(SEAMS[name], hard_check.cases()) == []


@pytest.mark.parametrize("name", ["thin edge", "sphere", "index of kappa", "cells of the law"])
def test_a_seam_without_cases_is_noticed(name: str) -> None:
    seam = SEAMS[name]
    others = [case for case in hard_check.cases() if case.kernel != seam.kernels[0]]
    assert missing(seam, others)
    moved = Seam(seam.kernels, seam.of, lambda: [float(x) * 1.001 for x in seam.places()])
    assert missing(moved, hard_check.cases())


def test_every_kernel_with_a_switch_of_its_own_is_in_the_suite() -> None:
    """Of the modules whose every seam is named above, no kernel is left out."""
    tried = {case.kernel for case in hard_check.cases()}
    for name in SWITCHES:
        if names(name) - REASONS:
            kernels = {k.name for k in hard_check.kernels().values() if k.module == name}
            assert kernels - tried <= UNTRIED, name


UNTRIED = {
    "plate_coefficients",
    "side_wall",
    "bending",
    "zener_number",
    "bending_period",
    "echo_time",
}
"""Coefficients, whose seams are those of the law that they make; the effects without a switch."""
