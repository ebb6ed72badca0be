"""Step 28: coupling of a contact to the plate's modes that conserves energy.

A growing contact is treated as a sequence of flat punches, each a step of its static law P(a),
delta(a). A punch of radius c distributes dP so that J0(phi r) has the mean sh(c phi) under it,
sh y = sin(y)/y. The modal force, and the modal weight in the gap, are therefore

    P_j(a) = int_0^a P'(c) sh(c phi_j) dc,   s_j = dP_j/dP = sh(a phi_j);

for Hertz pressure P_j = P g(a phi_j), g(y) = 3 (sin y - y cos y)/y^3. With the static compliance
c_j of each mode on the axis, the sphere displacement z and its weight m g

    m z'' = m g - P,   q_j'' + omega_j^2 q_j = omega_j^2 c_j P_j,   z = D + sum s_j q_j,
    D = delta - sum c_j P_j s_j,

so that static modes leave z = delta(a), and

    m z'^2/2 - m g z + E_c + sum (q_j'^2 + omega_j^2 q_j^2)/(2 omega_j^2 c_j),
    E_c = int P dD + sum q_j (P s_j - P_j)

is conserved for any delta(a). In a viscoelastic contact the pressure keeps its shape: it is that
of P times (1 + A_v P'/P), and so is the modal force, which ends with the force. The energy then
decreases at the rate A_v P' (z' - sum (P_j/P) q_j'); an infinite plate in series, w' = Y P,
takes Y P^2. With s_j = 1, the indentation at the axis, and E_c = int P dD, the energy
decreases at the rate sum (P - P_j) q_j'.

The same weight defines a static law of its own. If the mean of the gap under the next punch is
zero, where a sphere's r^2/(2R) has the mean a^2/(3R), then delta = a^2/(3R) + sum K_j sh(y) s(y),
and the work P d delta is stored in plate and gap. Because sh(y) s(y) is half the mean of s between
0 and 2y, the plate's part Q of the law at the axis becomes

    Q_V(a) = (1/4a) int_0^(2a) Q(x) dx:   c_n -> 2^(n+1)/(n+3) c_n,   c_1 -> c_1, c_3 -> (8/3) c_3.
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import SINE_MINUS, pressure, sonine
from derivation.plate.contact.theory.law import contact_law
from derivation.plate.contact.theory.spherical_profile import flat_punch
from derivation.plate.vocabulary import Formula, P, R, a, k, phi, q_j, q_rate, r

_t, _u, _y = sp.symbols("t u y", positive=True)
_m, _g, _A, _Y, _v, _z, _growth = sp.symbols("m g A_v Y v z a'", real=True)
MODES = 3
"""Number of modes in the proofs; the energy contains no product of two modes."""
_P, _D, _work = (sp.Function(name)(a) for name in ("P", "D", "W"))
_modal_forces, _modal_weights = (
    [sp.Function(f"{name}_{j}")(a) for j in range(MODES)] for name in ("P", "s")
)
_q, _rate, _omega, _c = (
    sp.symbols(f"{name}_:{MODES}", positive=True) for name in ("q", "v", "omega", "c")
)

MODAL_WEIGHT = sp.sin(a * phi) / (a * phi)
"""sh(a phi)."""
MODAL_FORCE = P * 3 * SINE_MINUS / (a * phi) ** 3
"""P_j for Hertz pressure."""


@cache
def growing_contact() -> Proof:
    """Prove the modal force of a growing contact, and that Hertz pressure is that of one."""
    flat_punch()
    c, depth = sp.symbols("c u_1", positive=True)
    step = sp.diff(P * (c / a) ** 3, c)
    # The punch's pressure is step/(2 pi c sqrt(c^2 - r^2)); with c^2 = r^2 + u^2, c dc = u du.
    density = (step / (2 * sp.pi * c**2)).subs(c, sp.sqrt(r**2 + _u**2))
    spread = sp.integrate(density, (_u, 0, depth)).subs(depth, sp.sqrt(a**2 - r**2))
    felt = sp.integrate(step * MODAL_WEIGHT.subs(a, c), (c, 0, a))
    hertz = pressure().expression
    return prove(
        "Growing contact",
        "The contact is a sequence of flat punches of every radius up to $a$, where $P$ is "
        "proportional to $a^3$. Their pressures add up to Hertz's, and their transforms "
        "to Sonine's integral.",
        lambda force, weight: {
            "pressure": spread + hertz,
            "modal force": felt - force,
            "transform": -2 * sp.pi * hertz.subs(r, 0) * sonine().expression - force,
            "modal weight": sp.diff(force / P * a**3, a) / sp.diff(a**3, a) - weight,
        },
        *(MODAL_FORCE, MODAL_WEIGHT),
    )


def gap_energy(q: sp.Expr, force: sp.Expr, weight: sp.Expr, modal_force: sp.Expr) -> sp.Expr:
    """Return one mode's term of E_c - int P dD."""
    return q * (force * weight - modal_force)


def coupling_loss(rate: sp.Expr, force: sp.Expr, modal_force: sp.Expr) -> sp.Expr:
    """Return one mode's term of the energy lost per time with the indentation at the axis."""
    return rate * (force - modal_force)


def _energy_rate(energy: sp.Expr, rates: dict[sp.Expr, sp.Expr]) -> sp.Expr:
    """Return the rate of an energy; generic functions end as plain symbols.

    int P dD has the slope P D', and P_j has s_j P'.
    """
    growth = sp.Add(*(sp.diff(energy, variable) * rate for variable, rate in rates.items()))
    slopes = {sp.diff(_work, a): _P * sp.diff(_D, a)}
    slopes |= {
        sp.diff(f, a): s * sp.diff(_P, a)
        for f, s in zip(_modal_forces, _modal_weights, strict=True)
    }
    return growth.xreplace(slopes)


def _plain(expression: sp.Expr) -> sp.Expr:
    """Replace generic functions and their slopes by symbols, and expand products."""
    functions = (_P, _D, *_modal_forces, *_modal_weights)
    names = {sp.diff(f, a): sp.Symbol(f"{f.func}'") for f in functions}
    return sp.expand(expression.xreplace(names | {f: sp.Symbol(str(f.func)) for f in functions}))


def _loss(weights: list[sp.Expr], stored: sp.Expr, lag: sp.Expr, admittance: sp.Expr) -> sp.Expr:
    """Return the energy's rate, for the modal weights in the gap.

    The contact stores int P dD and `stored`; it is viscoelastic, in series with an infinite plate.
    """
    load = [f * (1 + lag * _growth * sp.diff(_P, a) / _P) for f in (_P, *_modal_forces)]
    energy = _m * _v**2 / 2 - _m * _g * _z + _work + stored
    for q, v, omega, c in zip(_q, _rate, _omega, _c, strict=True):
        energy += (v**2 + omega**2 * q**2) / (2 * omega**2 * c)
    gap = _D + sp.Add(*(s * q for s, q in zip(weights, _q, strict=True)))
    way = sp.diff(gap, a) * _growth + admittance * load[0]
    way += sp.Add(*(s * v for s, v in zip(weights, _rate, strict=True)))
    rates = {a: _growth, _z: way, _v: _g - load[0] / _m, **dict(zip(_q, _rate, strict=True))}
    for q, v, omega, c, driven in zip(_q, _rate, _omega, _c, load[1:], strict=True):
        rates[v] = omega**2 * (c * driven - q)
    return _energy_rate(energy, rates).subs(_v, way)


@cache
def conservation() -> Proof:
    """Prove the energy along the motion: conserved, dissipated, radiated, or spuriously lost."""
    triples = list(zip(_q, _modal_weights, _modal_forces, strict=True))
    stored = sp.Add(*(gap_energy(q, _P, s, f) for q, s, f in triples))
    slope = sp.diff(_D + sp.Add(*(q * s for q, s, _ in triples)), a)
    way = slope * _growth + sp.Add(*(s * v for s, v in zip(_modal_weights, _rate, strict=True)))
    moved = sp.Add(*(f / _P * v for f, v in zip(_modal_forces, _rate, strict=True)))
    lost = _A * sp.diff(_P, a) * _growth * (way - moved)
    taken = _Y * (_P + _A * _growth * sp.diff(_P, a)) ** 2
    nothing, axis = sp.Integer(0), [sp.Integer(1)] * MODES
    pairs = zip(_modal_forces, _rate, strict=True)
    leaked = sp.Add(*(coupling_loss(v, _P, f) for f, v in pairs))
    return prove(
        "Energy of contact and modes",
        f"For generic $P$, $D$ and $s_j$ and {MODES} modes, the energy is differentiated along the "
        "motion, with $z'$ from the coupling. In static loading $q_j = c_j P_j$.",
        {
            "conserved energy": _plain(_loss(_modal_weights, stored, nothing, nothing)),
            "retardation and infinite plate": _plain(
                _loss(_modal_weights, stored, _A, _Y) + lost + taken
            ),
            "at the axis": _plain(_loss(axis, nothing, nothing, nothing) + leaked),
        }
        | _static(),
    )


def _static() -> dict[str, sp.Expr]:
    """Return delta minus the modes' depth, and the energy of P d delta, for q_j = c_j P_j."""
    rest = [c * f for c, f in zip(_c, _modal_forces, strict=True)]
    depth = _D + sp.Add(*(s * q for s, q in zip(_modal_weights, rest, strict=True)))
    law = sp.Function("delta")(a)
    own = law - sp.Add(*(s * q for s, q in zip(_modal_weights, rest, strict=True)))
    stored = _work + sp.Add(
        *(
            gap_energy(q, _P, s, f) + q**2 / (2 * c)
            for q, s, f, c in zip(rest, _modal_weights, _modal_forces, _c, strict=True)
        )
    )
    work = _energy_rate(stored, {a: sp.Integer(1)}) - _energy_rate(depth, {a: sp.Integer(1)}) * _P
    return {
        "static indentation": sp.expand(depth.subs(_D, own) - law),
        "static energy": _plain(work),
    }


@cache
def variational_law() -> Proof:
    """Prove half the mean over [0, 2a], power by power, and the sphere under the next punch."""
    contact = {formula.name: formula.expression for formula in contact_law()}
    K_j, squares = contact["K_j"], {sp.cos(_y) ** 2: 1 - sp.sin(_y) ** 2}
    n = sp.Symbol("n", positive=True)
    s = SINE_MINUS.subs(a * phi, _y)
    mean = sp.integrate(s.subs(_y, 2 * _y * _t), (_t, 0, 1)) / 2
    doubled = sp.expand(sp.expand_trig(mean - sp.sin(_y) / _y * s))
    half = sp.integrate(_u ** (n + 2), (_u, 0, 2 * a)) / (4 * a)
    ratio = 2 ** (n + 1) / (n + 3)
    gap = sp.integrate((a * sp.sin(_t)) ** 2 / (2 * R) * sp.sin(_t), (_t, 0, sp.pi / 2))
    whole = sp.integrate(_u**2 / R, (_u, 0, 2 * a)) / (4 * a)
    # Work P d delta compared with that of modes of compliance c, sum c P_j^2/2, and of the gap.
    felt = (MODAL_FORCE / P).subs(P, 1) * a**3
    compliance = sp.Symbol("c", positive=True)
    depth = gap + compliance * felt * MODAL_WEIGHT
    gap_energy = sp.integrate(gap * 3 * a**2, a)
    stored = a**3 * depth - compliance * felt**2 / 2 - gap_energy
    return prove(
        "Variational law",
        "Under a flat punch the mean of $r^2/(2R)$, of $s$, and of every power of $a$ is taken; "
        "the work is that for $P = a^3$.",
        lambda law, index: {
            "sphere": gap - a**2 / (3 * R),
            "law": sp.expand(sp.expand_trig(mean - (law / K_j).subs(a, _y / phi))).subs(squares),
            "half-space": gap + whole - a**2 / R,
            "mean": doubled.subs(squares),
            "power": sp.powsimp(sp.expand_power_base(half)) / a ** (n + 2) - ratio,
            "index": sp.powsimp(ratio.subs(n, 2 * k - 3) - index),
            "work": sp.diff(stored, a) - a**3 * sp.diff(depth, a),
            "pointwise": contact["delta"] - K_j * SINE_MINUS,
        },
        *(K_j * SINE_MINUS * MODAL_WEIGHT, 4 ** (k - 1) / (2 * k)),
    )


def coupling() -> tuple[Formula, ...]:
    """Return modal force, modal weight, contact energy, spurious loss, and variational law."""
    growing, energy, variational = growing_contact(), conservation(), variational_law()
    return (
        Formula(
            "mode_force",
            "P_j",
            "modal force: part of the force of Hertz pressure that acts on a mode",
            MODAL_FORCE,
            "N",
            "",
            ("p", "sonine"),
            growing,
        ),
        Formula(
            "mode_mean",
            "s_j",
            "modal weight in the gap: mean of $J_0$ under a flat punch",
            MODAL_WEIGHT,
            "1",
            "",
            ("mode_force",),
            growing,
        ),
        Formula(
            "gap_energy",
            r"E_c - \int P\,\mathrm{d}D",
            "energy of the contact in addition to its static part",
            gap_energy(q_j, P, MODAL_WEIGHT, MODAL_FORCE),
            "J",
            "",
            ("mode_force", "mode_mean"),
            energy,
            summed=True,
        ),
        Formula(
            "coupling_loss",
            r"-\dot E",
            "spurious power loss of the pointwise coupling",
            coupling_loss(q_rate, P, MODAL_FORCE),
            "W",
            "",
            ("mode_force",),
            energy,
            summed=True,
        ),
        Formula(
            "delta_variational",
            r"\delta_V - a^2/(3R)",
            "indentation by the variational law minus that of the half-space",
            variational.claims[0],
            "m",
            "6",
            ("K_j", "mode_mean"),
            variational,
            summed=True,
        ),
        Formula(
            "variational_ratio",
            "c_{2k-3}^V/c_{2k-3}",
            "coefficient of the variational law divided by that of the law at the axis",
            variational.claims[1],
            "1",
            "",
            ("delta_variational",),
            variational,
        ),
    )
