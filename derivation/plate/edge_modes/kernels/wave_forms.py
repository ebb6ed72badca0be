"""Turns the theory of held plates with a thickness into statements their code is printed from.

With xi = kap/x^2, k2^2 = k^2 left, g1 = bent and g2 k2^2 = k^2 turned nothing cancels for thin
plates. With M = 2 I1/(k2 I0) and L = (1 - M)/k2^2 = I2/(k2^2 I0) nothing does where k2 vanishes.
The edge is J1 = q J0,

    q = k [beta (1 + left) - turned M/2]/bent,

by which N/J0^2 is a function of q. The first mode of a support, whose k vanishes at nu = -1, is

    bent R(-k^2) + J0 [turned R(k2^2)/I0 + (n xi k^2/8 - goal)(1 + left)] = 0,
    R(y) = y/8 I0 - I2 at sqrt(y), R(-k^2) = J2 - (k^2/8) J0,   goal = (1 + nu)/(1 - nu),

where all terms but the last are positive for k < j_1, and so are those of psi and of

    w = c V(k2^2) - V(-k^2),   V(y) = I0(sqrt(y)) - I0(r sqrt(y)).
"""

from functools import cache
from math import factorial
from typing import NamedTuple

import sympy as sp

from derivation.engine.formula.proof import Proof, lower_bessel, prove
from derivation.engine.rewrite.form import Step
from derivation.plate.edge_modes.theory import mindlin
from derivation.plate.edge_modes.theory import waves as theory
from derivation.plate.edge_modes.theory.mindlin import ROTARY, k_2, shear, slack
from derivation.plate.edge_modes.theory.waves import I0, I1, J0, J1
from derivation.plate.vocabulary import eta, k_n, nu, x_h

k, x, xi, less, root = sp.symbols("k x xi less root", positive=True)
left, bent, turned, mean, q, slope, change = sp.symbols(
    "left bent turned mean q slope change", real=True
)
j0, j1, i0, goal, beta, c, t = sp.symbols("j0 j1 i0 goal beta c t", real=True)
curl, steep, curl_2, steep_2 = sp.symbols("curl steep curl_2 steep_2", real=True)
growth, growth_2, short, short_2 = sp.symbols("growth growth_2 short short_2", real=True)
r, square, rate, lacking = sp.symbols("r square rate lacking", real=True)
excess, rise = sp.symbols("excess rise", real=True)


class WaveBlock(NamedTuple):
    """A printed function of plain statements."""

    name: str
    arguments: tuple[sp.Symbol, ...]
    steps: tuple[Step, ...]
    results: tuple[sp.Expr, ...]
    summary: str

    def undone(self, value: sp.Expr) -> sp.Expr:
        """An expression in its symbols with every step put back."""
        for step in reversed(self.steps):
            value = value.subs(step.symbol, step.expression)
        return value

    @property
    def values(self) -> tuple[sp.Expr, ...]:
        """What it returns, of its arguments."""
        return tuple(self.undone(value) for value in self.results)


def of_xi(value: sp.Expr) -> sp.Expr:
    """Of the theory's expression in xi."""
    return sp.collect(sp.expand(value.subs(shear, slack())), mindlin.xi).subs(mindlin.xi, xi)


def _parts() -> dict[sp.Symbol, sp.Expr]:
    """left, bent and turned of xi."""
    return {left: of_xi(mindlin.left()), bent: of_xi(mindlin.u_1()), turned: of_xi(mindlin.u_2())}


_RATE = 2 * bent * turned / (bent + turned - bent * turned)
"""d log(xi)/d log(k) on Mindlin's branch."""


def _slope_of(value: sp.Expr, others: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    """d/dk of what depends on k, xi by `change`, and others."""
    by_xi = sum(sp.diff(value, s) * sp.diff(part, xi) for s, part in _parts().items())
    total = sp.diff(value, k) + (by_xi + sp.diff(value, xi)) * change
    return total + sum(sp.diff(value, s) * each for s, each in others.items())


def _changes() -> tuple[Step, ...]:
    """Of xi and k2^2 by k."""
    return (
        Step(change, xi * _RATE / k, "of xi by k, on Mindlin's branch"),
        Step(square, _slope_of(k**2 * left, {}), "of k2^2 by k"),
    )


def _wave() -> WaveBlock:
    steps = (
        Step(xi, (root / (k * eta)) ** 2, "kap/x^2"),
        *(Step(symbol, value) for symbol, value in _parts().items()),
    )
    results = (xi, left, bent, turned, k * sp.sqrt(sp.Max(left, 0)))
    return WaveBlock("_wave", (k, eta, nu, root), steps, results,
                 "xi, k2^2/k^2, g1, g2 k2^2/k^2 and k2.")  # fmt: skip


def _cutoff() -> WaveBlock:
    steps = (
        Step(xi, (root / x) ** 2),
        *(Step(symbol, value) for symbol, value in _parts().items()),
        Step(rate, _RATE),
    )
    return WaveBlock("_to_cutoff", (x, nu, root), steps, (x * (1 + left / ((1 - left) * rate)),),
                 "A step of Newton's in log x, for k2 = 0.")  # fmt: skip


def _edge() -> WaveBlock:
    value = k * (beta * (1 + left) - turned * mean / 2) / bent
    steep_q = _slope_of(value, {mean: (less - mean**2 / 4) * square})
    steps = (
        Step(q, value),
        *_changes(),
        Step(slope, sp.collect(sp.expand(steep_q), (change, square), sp.factor)),
        Step(excess, j1 - q * j0),
        Step(rise, j0 - j1 / k + q * j1 - slope * j0),
    )
    arguments = (k, nu, beta, xi, left, bent, turned, mean, less, j0, j1)
    return WaveBlock("_edge", arguments, steps, (q, excess, rise),
                 "q, J1 - q J0 that vanishes at a mode, and its slope by k.")  # fmt: skip


def _first() -> WaveBlock:
    bracket = turned * curl_2 / i0 + (ROTARY * xi * k**2 / 8 - goal) * (1 + left)
    value = bent * curl + j0 * bracket
    others = {
        curl: -2 * k * steep, curl_2: steep_2 * square, i0: i0 * mean / 4 * square, j0: -j1
    }  # fmt: skip
    steps = (*_changes(), Step(excess, value), Step(rise, _slope_of(value, others)))
    arguments = (k, nu, goal, xi, left, bent, turned, mean, j0, j1, i0, curl, steep, curl_2,
                 steep_2)  # fmt: skip
    return WaveBlock("_first_edge", arguments, steps, (excess, rise),
                 "What vanishes at the first mode of a support, and its slope by k.")  # fmt: skip


def _start() -> WaveBlock:
    """By the lowest power of k, where 3 n xi = x^2."""
    u = sp.Symbol("u", positive=True)
    lowest = 2 * curls(2)[1] * u + eta**2 / 12 * u - 2 * goal
    return WaveBlock("_first_power", (eta, goal), (), (sp.solve(lowest, u)[0],),
                 "k^4 of the first mode of a support, near nu = -1.")  # fmt: skip


def _support() -> WaveBlock:
    return WaveBlock("_support", (nu,), (), ((1 + nu) / (1 - nu), theory.SUPPORTED),
                 "goal, and beta of a simple support.")  # fmt: skip


def _clamp() -> WaveBlock:
    chi = sp.Symbol("chi", real=True)
    steps = (Step(chi, theory.CLAMP, "measured"),)
    return WaveBlock("_clamp", (eta, nu), steps, (theory.CLAMPED.subs(theory.CLAMP, chi),),
                 "beta of a clamp.")  # fmt: skip


def _corrected() -> WaveBlock:
    both = (sp.besselj(order, k) for order in (0, 1))
    moved = (lower_bessel(sp.diff(f, k)) for f in both)
    plain = {sp.besselj(0, k): j0, sp.besselj(1, k): j1}
    results = tuple(f + lacking * d.subs(plain) for f, d in zip((j0, j1), moved, strict=True))
    return WaveBlock("_moved", (k, lacking, j0, j1), (), results,
                 "J0 and J1 at the root that k rounded lacks so much of.")  # fmt: skip


def _weight() -> WaveBlock:
    total, turn, of_w, of_psi = sp.symbols("total turn of_w of_psi", real=True)
    steps = (
        Step(total, 1 + left),
        Step(turn, (k * eta) ** 2 / 3),
        Step(of_w, 1 + (q**2 - left * (k * mean / 2) ** 2) / 2
             - 2 * (q / k + left * mean / 2) / total, "of w, over J0^2"),
        Step(of_psi, bent**2 * (1 + q**2 - 2 * q / k) / 2
             + (turned * k) ** 2 * (mean**2 / 4 - less) / 2
             + 2 * bent * turned * (q / k - mean / 2) / total),
        Step(t, 1 + theory.BULGE * turn * total),
    )  # fmt: skip
    N = of_w + turn * of_psi
    value = (q * (1 - c * t) / j1) ** 2 * (1 + turn * bent**2) / (2 * sp.pi * N)
    return WaveBlock("_weight", (k, eta, nu, left, bent, turned, mean, less, q, j1, c), steps,
                 (t, value), "t and W.")  # fmt: skip


def _part() -> WaveBlock:
    scaled = sp.Symbol("scaled", positive=True)
    return WaveBlock("_part", (j0, scaled, k_2), (), (j0 / scaled * sp.exp(-k_2),),
                 "c, of I0 e^(-k2).")  # fmt: skip


def _energy() -> WaveBlock:
    w, psi = sp.symbols("w psi", real=True)
    steps = (
        Step(w, c * growth_2 - growth),
        Step(psi, k**2 * r / 2 * (bent * short + c * turned * short_2)),
    )
    arguments = (k, eta, r, c, bent, turned, growth, growth_2, short, short_2)
    return WaveBlock("_energy", arguments, steps, ((w**2 + eta**2 / 3 * psi**2) * r,),
                 "(w^2 + (eta^2/3) psi^2) r.")  # fmt: skip


def _first_weight() -> WaveBlock:
    N, turn, bulge, axis = sp.symbols("N turn bulge axis", real=True)
    steps = (
        Step(turn, (k * eta) ** 2 / 3),
        Step(bulge, theory.BULGE * turn * (1 + left), "t - 1"),
        Step(axis, (growth_2 - growth) / i0 - c * bulge, "1 - c t"),
    )
    value = axis**2 * (1 + turn * bent**2) / (2 * sp.pi * N)
    arguments = (k, eta, nu, left, bent, c, i0, growth, growth_2, N)
    return WaveBlock("_first_weight", arguments, steps, (1 + bulge, value),
                 "t and W of the first mode of a support.")  # fmt: skip


def _face() -> WaveBlock:
    near, far = sp.symbols("near far", real=True)
    return WaveBlock(
        "_face",
        (c, t, near, far),
        (),
        ((near - t * far) / (1 - c * t),),
        "Of the loaded face less that on the axis: J0's less 1, and c times I0's.",
    )


@cache
def blocks() -> tuple[WaveBlock, ...]:
    """The printed functions, by need."""
    return (
        _wave(), _cutoff(), _support(), _clamp(), _edge(), _corrected(), _part(), _weight(),
        _start(), _first(), _energy(), _first_weight(), _face(),
    )  # fmt: skip


def curls(count: int) -> tuple[sp.Rational, ...]:
    """R by powers of y, from y^1 on."""
    return tuple(
        sp.Rational(1, 8 * 4**m * factorial(m) ** 2)
        - sp.Rational(1, 4 ** (m + 1) * factorial(m) * factorial(m + 2))
        for m in range(count)
    )


# --- proofs


@cache
def forms() -> Proof:
    """The code's forms are those of the theory."""
    g_1, g_2 = theory.g_1, theory.g_2
    names = {
        k: k_n, left: k_2**2 / k_n**2, bent: g_1, turned: g_2 * k_2**2 / k_n**2,
        mean: 2 * I1 / (k_2 * I0), less: (1 - 2 * I1 / (k_2 * I0)) / k_2**2, j0: J0, j1: J1,
        i0: I0, t: theory.FACE, c: theory.PART, xi: (1 - g_2 * k_2**2 / k_n**2) / ROTARY,
    }  # fmt: skip

    def of(value: sp.Expr) -> sp.Expr:
        return value.subs(names, simultaneous=True)

    # Gam = k^2 + k2^2 ties g1 and g2; J1 = q J0 at a mode.
    tied = {g_2: (k_n**2 + k_2**2 - g_1 * k_n**2) / k_2**2}
    at_edge = (theory.TURN - beta * theory.BEND) * J0 / (g_1 * k_n)
    mode = {J1: q * J0}
    edge, first, weight, whole = _edge(), _first(), _weight(), _first_weight()
    t_of, W_of = (of(value).subs(mode) for value in weight.values)
    theirs = theory.WEIGHT.subs({theory.t: theory.FACE, theory.N: theory.NORM})
    theirs = theirs.subs(mindlin.c, theory.PART)
    support = at_edge.subs(beta, theory.SUPPORTED) * 2 * g_1 / k_n
    first_of = of(first.undone(excess).subs(_curls())).subs(goal, (1 + nu) / (1 - nu))
    t_first, W_first = (of(value.subs(_growths(0))) for value in whole.values)
    energy = of(_energy().values[0].subs(_growths(r)).subs(_shorts()))
    psi, w = mindlin.rotation(g_1, g_2), mindlin.DEFLECTION
    at_r = {sp.Symbol("r", positive=True): r, mindlin.c: theory.PART}
    kinetic = ((w**2 + eta**2 / 3 * psi**2) * sp.Symbol("r", positive=True)).subs(at_r)
    branch = mindlin.on_lower_branch().subs(shear, slack())
    x_there = sp.sqrt(3 * ROTARY * xi / (bent * turned)).subs(_parts())
    plain_N = sp.Symbol("N", real=True)
    return prove(
        "Forms of held waves",
        "Rotations tied by Gam = k^2 + k2^2, J1 = q J0 at a mode; slopes by differentiation of "
        "functions of k, with any slope of xi.",
        {
            "edge": (of(edge.undone(excess)) - at_edge).subs(tied),
            "branch": branch.subs(mindlin.xi, xi).subs(x_h, x_there) - _RATE.subs(_parts()),
            "face": t_of - theory.FACE,
            "weight": W_of - theirs.subs(mode),
            "first edge": lower_bessel(first_of - support).subs(tied),
            "first face": t_first - theory.FACE,
            "first weight": W_first.subs(plain_N, theory.N)
            - theory.WEIGHT.subs({theory.t: theory.FACE, mindlin.c: theory.PART}),
            "energy": lower_bessel(energy - kinetic),
            "clamp": _clamp().values[0] - theory.CLAMPED,
            "shape": _on_face(theory.ON_FACE),
            "share": _on_face(theory.UNDER_PUNCH),
        }
        | _slopes(edge, first),
    )


def _on_face(of_theory: sp.Expr) -> sp.Expr:
    """The printed form less the theory's, of the same c and t."""
    both = sp.expand(of_theory).subs({mindlin.c: c, theory.t: t})
    first = both.subs(c, 0)
    near, far = sp.symbols("near far", real=True)
    second = sp.cancel((first - both) / t)  # c times the part I0
    printed = _face().values[0].subs({near: first - 1, far: second - c})
    return 1 + printed - both / (1 - c * t)


def _curls() -> dict[sp.Symbol, sp.Expr]:
    """R(-k^2) and R(k2^2)."""
    return {
        curl: sp.besselj(2, k) - k**2 / 8 * sp.besselj(0, k),
        curl_2: left * k**2 / 8 * I0 - sp.besseli(2, k_2),
    }


def _growths(at: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """V(-k^2) and V(k2^2) at r."""
    inner = [sp.besselj(0, k_n * at), sp.besseli(0, k_2 * at)]
    return {growth: J0 - inner[0], growth_2: I0 - inner[1]}


def _shorts() -> dict[sp.Symbol, sp.Expr]:
    """2 J1/y and 2 I1/y."""
    return {
        short: 2 * sp.besselj(1, k_n * r) / (k_n * r),
        short_2: 2 * sp.besseli(1, k_2 * r) / (k_2 * r),
    }


def _slopes(edge: WaveBlock, first: WaveBlock) -> dict[str, sp.Expr]:
    """Both slopes, xi being any function of k."""
    of_k = sp.Function("xi")(k)
    parts = {s: value.subs(xi, of_k) for s, value in _parts().items()}
    partner = k * sp.sqrt(parts[left])
    y = sp.Symbol("y", positive=True)
    ratio = 2 * sp.besseli(1, y) / (y * sp.besseli(0, y))
    R, R_2 = (part.subs({left: y**2 / k**2, k_2: y}) for part in _curls().values())
    R = R.subs(k, y)
    known = {
        mean: ratio, less: (1 - ratio) / y**2, i0: sp.besseli(0, y), curl_2: R_2,
        steep_2: sp.diff(R_2, y) / (2 * y),
    }  # fmt: skip
    known = {s: value.subs(y, partner) for s, value in known.items()}
    known |= {curl: R.subs(y, k), steep: -(sp.diff(R, y) / (2 * y)).subs(y, k)}
    known |= {j0: sp.besselj(0, k), j1: sp.besselj(1, k), **parts}
    found = {}
    for name, block in (("slope", edge), ("first slope", first)):
        # `change` stands for any slope of xi.
        steps = tuple(s for s in block.steps if s.symbol != change)
        free = block._replace(steps=steps)
        value, growing = (free.undone(s).subs(known).subs(xi, of_k) for s in (excess, rise))
        left_over = lower_bessel((sp.diff(value, k) - growing).subs(sp.diff(of_k, k), change))
        found[name] = left_over.subs(of_k, xi).subs(xi, xi / 4)  # k2^2 > 0
    return found
