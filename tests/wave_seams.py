"""Where the generated code of the plate's waves and of held plates switches."""

import math
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf
from seams import Place, Point, Seam

from derivation.plate.blocks import blocks
from derivation.plate.cases import suite as hard_suite
from derivation.plate.edge_modes import cases as hard_held_families
from derivation.plate.edge_modes.oracle import modes as held_balls
from derivation.plate.edge_modes.oracle import waves as held_wave_balls
from generated import edge_mode_numbers, wave_numbers
from generated.plate_waves import branches

LOWEST = ("bending_frequency", "bending_residue", "bending_share")


def gam(p: Point) -> Fraction:
    return (1 - 2 * p["nu"]) / (2 * (1 - p["nu"]))


def root(x: Fraction) -> Fraction:
    """The square root to many digits."""
    return Fraction(math.isqrt(int(x * 2**200)), 2**100)


def both_roots(p: Point) -> Fraction:
    """p + q, where both are real."""
    squares = p["x"] ** 2 - gam(p) * p["kap"], p["x"] ** 2 - p["kap"]
    return sum(map(root, squares), Fraction(0)) if min(squares) >= 0 else Fraction(0)


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
    1.42: lambda p, _: p + wave_numbers.CLOSE,
    1.83: lambda p, _: p - wave_numbers.CLOSE,
}
S0_CLOSE: dict[float, Condition] = {
    0.37: lambda _, q: q + wave_numbers.CLOSE,
    3.5: lambda _, q: q - wave_numbers.CLOSE,
}


def partner_at_infinity(edge: held_balls.Edge) -> Callable[[], Iterable[Place]]:
    """h/b of the hard case at which k2 of a mode passes the switch of I0, as the oracle says."""

    def places() -> Iterable[Place]:
        group = hard_held_families.SEAMS
        (case,) = (
            c for c in hard_suite.cases() if c.group == group and c.kernel == f"{edge}_waves"
        )
        place, nu = case.numbers["eta"][2], case.numbers["nu"][0]
        n = int(case.numbers["count"][0])
        for side, below in ((2.0, True), (-2.0, False)):
            k2 = held_wave_balls.wave(edge, n, place + side * math.ulp(place), nu, 25).k2
            assert bool(k2 < edge_mode_numbers.START) is below
        return [place]

    return places


def on_face(p: Point) -> Fraction:
    """The distance from the axis, or the punch's radius."""
    return p["r"] if "r" in p else p["a"]


FACE = ("wave_shape", "wave_share")
WAVE_SEAMS: dict[str, Seam] = {
    "clamped partner at infinity": Seam(
        ("clamped_waves",), lambda p: p["eta"], partner_at_infinity("clamped")
    ),
    "supported partner at infinity": Seam(
        ("supported_waves",), lambda p: p["eta"], partner_at_infinity("supported")
    ),
    "small k on the face": Seam(
        FACE, lambda p: p["k"] * on_face(p), lambda: [edge_mode_numbers.SMALL]
    ),
    "small k2 on the face": Seam(
        FACE, lambda p: p["k2"] * on_face(p), lambda: [edge_mode_numbers.SMALL]
    ),
    "x of the lowest branch": Seam(LOWEST, lambda p: p["x"], lambda: [wave_numbers.SHALLOW]),
    "x of its share": Seam(LOWEST[2:], lambda p: p["x"], lambda: [wave_numbers.SMALL]),
    "T of its share": Seam(
        LOWEST[2:], lambda p: 2 * p["x"], lambda: [float(blocks()["sinh_minus"].value.at)]
    ),
    "q = 0": Seam(("dynamic_influence",), lambda p: p["kap"] / p["x"] ** 2, lambda: [1]),
    "p = 0": Seam(("dynamic_influence",), lambda p: gam(p) * p["kap"] / p["x"] ** 2, lambda: [1]),
    "2 q = p": Seam(
        ("dynamic_influence",), lambda p: (4 - gam(p)) * p["kap"] / (3 * p["x"] ** 2), lambda: [1]
    ),
    "p + q of the influence": Seam(("dynamic_influence",), both_roots, lambda: [wave_numbers.NEAR]),
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
"""By name, likewise."""
