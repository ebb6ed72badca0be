"""Step 17: slopes of the contact law, and sensitivities of the impact's results to each parameter.

With a = h A in the energy integral, A_m depends on eta = h/b and on the energy number Y, which is m
v0^2/2 over (4/3) E* h^5/R^2. Every result is a product of powers of the parameters times a function
of these two. Where results change smoothly they are locally Y^p eta^q: seven logarithmic
derivatives follow from p and q, and

    p of A_m = E/(2 U),   q = -E_eta/(2 U),   A^5 E = int_0^A x^3 d(x^2 (1 + F)),

with 2 U = sum n D_n, E = sum n D_n/(n + 3) of step 16. The contact time is sqrt(m/(E* h))
A_m^(-1/2) I up to a constant factor; its integrand has no singularity that depends on the
parameters.
"""

from collections.abc import Callable, Mapping
from functools import cache

import sympy as sp

from derivation.engine.formula.dimension import Dimension
from derivation.engine.formula.dimension import unit as dimension_of
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.contact.theory.hertz import contact_radius
from derivation.plate.contact.theory.plate_series import small_contact
from derivation.plate.contact.theory.split import lateral_bracket, reduced_split
from derivation.plate.impact.theory.impact import contact_time, orders, work_of_contact
from derivation.plate.modes.theory.plate_factor import plate_factor_slope, plate_factors
from derivation.plate.vocabulary import (
    BY_NAME,
    J1,
    D,
    D_eta,
    Formula,
    R,
    T,
    a,
    a_ratio,
    alpha,
    b,
    c_A,
    eta,
    h,
    j_n,
    lam,
    m,
    mu,
    u_t,
    v0,
)

PARAMETERS = (R, m, v0, h, b, lam, mu)
"""Parameters of a scene, in the order of the generated functions."""
RESULTS = {
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "max_contact_radius": "m",
}
"""Results of an impact with their units, in the order of the generated functions."""

_p, _q, _y = sp.symbols("p q y", positive=True)
_A = sp.Symbol("A_m", positive=True)
_MODULUS = sp.Symbol("E", positive=True)


def reduced_modulus() -> sp.Expr:
    """Return E* from the force of step 8, P = (4/3) E* a^3/R."""
    return sp.Rational(3, 4) * contact_radius().expression * R / a**3


def energy_scale() -> sp.Expr:
    """Return (4/3) E* h^5/R^2, with a symbol for E*."""
    return sp.Rational(4, 3) * _MODULUS * h**5 / R**2


@cache
def energy_number() -> Formula:
    """Return the impact energy over (4/3) E* h^5/R^2, on which A_m depends in addition to h/b."""
    value = sp.factor(m * v0**2 / 2 / energy_scale().subs(_MODULUS, reduced_modulus()))
    C = contact_radius().expression / a**3 / R
    proof = prove(
        "Energy number",
        r"$C a_m^5 \sum n D_n/(n + 3) = m v_0^2/2$ with $a_m = h A_m$.",
        lambda value: {"energy": C * (h * _A) ** 5 - _A**5 * m * v0**2 / 2 / value},
        value,
    )
    sources = ("contact_work", "P")
    return Formula(
        "energy_number", r"\mathcal{Y}", "impact energy divided by $(4/3) E^* h^5/R^2$", value,
        "1", "13", sources, proof,
    )  # fmt: skip


# --- slopes of the law


@cache
def law_slopes() -> tuple[Formula, ...]:
    """Return d delta/da by its series, and the modes' part of d delta/da and of h dF/dh."""
    series = small_contact().expression
    delta = a**2 / R * series.subs(a_ratio, a / h)
    slope = a / R * (2 + sp.Add(*((n + 2) * c * (a / h) ** n for n, c in _shown(series).items())))
    lateral, mode = reduced_split()
    weight = plate_factors()[2].expression.subs(T, 2 * eta * j_n) / (j_n * J1**2)
    excess_slope = plate_factor_slope().expression.subs(T, 2 * eta * j_n)
    sinc = 4 * alpha / sp.pi * sp.sin(alpha * j_n) / (alpha * j_n) * weight
    y = alpha * j_n
    shape = 3 * (sp.sin(y) - y * sp.cos(y)) / y**3
    deeper = 8 * alpha / (3 * sp.pi) * shape * excess_slope / (j_n * J1**2)
    bracket = -8 / sp.pi**2 * lateral_bracket(alpha)
    side = -4 / sp.pi**2 * sp.sinh(alpha * _y) / _y
    proof = prove(
        "Slopes of the contact law",
        r"The series is differentiated with respect to $a$. The split is multiplied by $\alpha^2$ "
        r"and differentiated with respect to $\alpha$ and, at fixed $\alpha$, with respect to "
        r"$\log(h/b)$.",
        lambda slope, sinc, deeper: {
            "series": sp.diff(delta, a) - slope,
            "mode": sp.diff(alpha**2 * mode.expression, alpha) / (2 * alpha) - sinc,
            "finite radius": sp.diff(bracket, alpha) / (2 * alpha) - side,
            "finite radius's weight": lateral.expression.function * alpha**2
            - bracket
            * sp.besselk(0, lateral.expression.variables[0])
            / sp.besseli(0, lateral.expression.variables[0]),
            "thickness": eta * sp.diff(mode.expression, eta) - deeper,
        },
        *(slope, sinc, deeper),
    )
    return (
        Formula(
            "delta_slope",
            r"\mathrm{d}\delta/\mathrm{d}a",
            "derivative of the indentation with respect to the contact radius, for $a < 4 h$ and "
            "$a < b$",
            slope,
            "1",
            "6",
            ("delta_reduced",),
            proof,
        ),
        Formula(
            "slope_modes",
            r"\frac{R}{2a}\frac{\mathrm{d}\delta_h}{\mathrm{d}a}",
            r"contribution of the thickness to $d \delta/da$, divided by the half-space's",
            sinc,
            "1",
            "6",
            ("F_modes",),
            proof,
            summed=True,
        ),
        Formula(
            "F_thickness",
            r"h\,\partial F/\partial h",
            r"derivative of $\delta R/a^2$ with respect to $\log h$ at fixed $a$ and $b$",
            deeper,
            "1",
            "6",
            ("F_modes", "G_slope"),
            proof,
            summed=True,
        ),
    )


def _shown(series: sp.Expr) -> dict[int, sp.Symbol]:
    """Return the coefficients of a series in A by their order."""
    return {n: c for n, c in c_A.items() if series.has(c)}


# --- scaling


def power_laws() -> dict[str, sp.Expr]:
    """Return the powers of the parameters in each result, apart from the function of Y and eta."""
    travel = h**2 / R
    # Half the contact time is sqrt(m/2) (a_m^2/R) I/sqrt(C a_m^5), a_m = h A_m.
    C = energy_scale() / h**5
    time = sp.sqrt(m / 2) * travel / sp.sqrt(C * h**5)
    force = sp.Rational(4, 3) * _MODULUS * h**3 / R
    laws = {"contact_time": 2 * time, "max_indentation": travel, "max_force": force}
    return {**laws, "max_contact_radius": h}


def logarithmic(expression: sp.Expr) -> tuple[sp.Rational, ...]:
    """Return the exponents of R, m, v0, h, b and E* in a product of powers."""
    logarithm = sp.expand_log(sp.log(expression), force=True)
    return tuple(sp.simplify(x * sp.diff(logarithm, x)) for x in (*PARAMETERS[:5], _MODULUS))


@cache
def exponents() -> dict[str, tuple[sp.Rational, ...]]:
    """Return the exponents of R, m, v0, h, b and E* in every result, in `energy` and in `eta`."""
    exponents_by_name = {name: logarithmic(law) for name, law in power_laws().items()}
    energy = logarithmic(m * v0**2 / 2 / energy_scale())
    return {**exponents_by_name, "energy": energy, "eta": logarithmic(h / b)}


@cache
def scaling() -> Proof:
    """Prove independence of units: exponents weighted by dimensions give the result's dimension."""
    stress = dimension_of("Pa")
    units = [*(dimension_of(BY_NAME[str(x)].unit) for x in PARAMETERS[:5]), stress]
    table = exponents()
    residuals = {}
    for name, unit in RESULTS.items():
        rows = zip(table[name], table["energy"], table["eta"], strict=True)
        totals = [own + _p * energy + _q * ratio for own, energy, ratio in rows]
        for basis in ("length", "mass", "time"):
            terms = (_part(u, basis) * x for u, x in zip(units, totals, strict=True))
            residuals[f"{name}, {basis}"] = sp.expand(
                sp.Add(*terms) - _part(dimension_of(unit), basis)
            )
    return prove(
        "Scaling of an impact",
        "A result is a product of powers times Y^p eta^q, for any p and q.",
        residuals,
    )


def _part(unit: Dimension, basis: str) -> sp.Rational:
    value = getattr(unit, basis)
    return sp.Rational(value.numerator, value.denominator)


@cache
def modulus_slope() -> Formula:
    """Return d log E*/d log lam; d log E*/d log mu is 1 minus this."""
    logarithm = sp.log(reduced_modulus())
    value = lam * mu / ((lam + mu) * (lam + 2 * mu))
    proof = prove(
        "Slopes of the modulus",
        "The logarithm of $E^*$ is differentiated; $E^*$ is homogeneous of degree 1 in both "
        "moduli.",
        lambda value: {
            "derivative with respect to lam": lam * sp.diff(logarithm, lam) - value,
            "derivative with respect to mu": mu * sp.diff(logarithm, mu) - (1 - value),
        },
        value,
    )
    return Formula(
        "modulus_by_lam",
        r"\partial\log E^*/\partial\log\lambda",
        r"derivative of $\log E^*$ with respect to $\log \lambda$; that to $\log \mu$ is 1 minus "
        r"this one",
        value,
        "1",
        "7",
        ("P",),
        proof,
    )


# --- an impact by its energy and by h/b


def weighted(weights: Mapping[int, sp.Expr], factor: Callable[[int], sp.Expr]) -> sp.Expr:
    """Return the sum of D_n times a factor for each n."""
    return sp.Add(*(factor(n) * weight for n, weight in weights.items()))


def _weights() -> dict[int, sp.Expr]:
    return {n: sp.Integer(1) if n == 2 else D[n] for n in orders()}


def _eta_weights() -> dict[int, sp.Expr]:
    return {n: sp.Integer(0) if n == 2 else D_eta[n] for n in orders()}


@cache
def peaks() -> tuple[Formula, ...]:
    """Return logarithmic derivatives of the peaks with respect to energy number and eta."""
    D_n, slopes = _weights(), _eta_weights()
    work = weighted(D_n, lambda n: sp.Rational(n, n + 3))
    rise, lift = weighted(D_n, sp.Integer), weighted(D_n, lambda _: sp.Integer(1))
    work_slope = weighted(slopes, lambda n: sp.Rational(n, n + 3))
    lift_slope = weighted(slopes, lambda _: sp.Integer(1))
    by_energy, by_eta = work / rise, -work_slope / rise
    indentation_by_energy, depth_by_eta = work / lift, (lift_slope - work_slope) / lift

    def grown(value: sp.Expr) -> sp.Expr:
        """Return the derivative with respect to log A_m, where D_n is proportional to A^(n - 2)."""
        return sp.Add(*((n - 2) * D[n] * sp.diff(value, D[n]) for n in orders()[1:]))

    def deeper(value: sp.Expr) -> sp.Expr:
        return sp.Add(*(D_eta[n] * sp.diff(value, D[n]) for n in orders()[1:]))

    energy_by_radius = (grown(work) + 5 * work) / work
    energy_by_eta = deeper(work) / work
    depth = (grown(lift) + 2 * lift) / lift
    proof = prove(
        "Derivatives of the peaks",
        r"The energy number is $A^5 E$ and the indentation is $A^2 (1 + F)$. The radius $A$ is "
        r"varied so that the energy number increases, and so that it stays constant while "
        r"$\eta$ increases.",
        lambda by_energy, by_eta, indentation_by_energy, depth_by_eta: {
            "work": work - work_of_contact(),
            "radius by energy": energy_by_radius * by_energy - 1,
            "radius by eta": energy_by_radius * by_eta + energy_by_eta,
            "indentation by energy": depth * by_energy - indentation_by_energy,
            "indentation by eta": depth * by_eta + deeper(lift) / lift - depth_by_eta,
        },
        *(by_energy, by_eta, indentation_by_energy, depth_by_eta),
    )
    rows = (
        ("radius_by_energy", r"\partial\log a_m/\partial\log\mathcal{Y}", by_energy),
        ("radius_by_thickness", r"\partial\log(a_m/h)/\partial\log\eta", by_eta),
        (
            "indentation_by_energy",
            r"\partial\log\delta_m/\partial\log\mathcal{Y}",
            indentation_by_energy,
        ),
        ("indentation_by_thickness", r"\partial\log(\delta_m/h^2)/\partial\log\eta", depth_by_eta),
    )
    meanings = (
        (
            r"derivative of $\log a_m$ with respect to the logarithm of the energy; that of the "
            r"force is three times as large"
        ),
        r"derivative of $\log(a_m/h)$ with respect to $\log(h/b)$ at fixed energy number",
        "derivative of the logarithm of the largest indentation with respect to that of the energy",
        r"derivative of $\log(\delta R/h^2)$ with respect to $\log(h/b)$ at fixed energy number",
    )
    return tuple(
        Formula(name, latex, meaning, value, "1", "13", ("contact_work",), proof)
        for (name, latex, value), meaning in zip(rows, meanings, strict=True)
    )


@cache
def times() -> tuple[Formula, ...]:
    """Return the change of the time's integrand with log A_m and, at fixed A_m, with log eta.

    With N = sum n D_n q^(n-1), S = sum n D_n/(n+3) (1 + ... + q^(n+2)) the integrand is 2 N/sqrt(S)
    and changes by 2 (N' - N S'/(2 S))/sqrt(S); q is fixed, and nothing is singular.
    """
    integrand = contact_time()[0].expression
    q = 1 - u_t**2
    D_n = _weights()

    def parts(weights: Mapping[int, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
        stored = weighted(
            weights, lambda n: sp.Rational(n, n + 3) * sp.Add(*(q**i for i in range(n + 3)))
        )
        return weighted(weights, lambda n: n * q ** (n - 1)), stored

    N, S = parts(D_n)
    n_0, s_0, n_1, s_1 = sp.symbols("N S N_1 S_1", positive=True)
    rule = 2 * (n_1 - n_0 * s_1 / (2 * s_0)) / sp.sqrt(s_0)
    whole = 2 * n_0 / sp.sqrt(s_0)
    proofs = {
        "integrand": integrand - whole.subs({n_0: N, s_0: S}),
        "rule": sp.diff(whole, n_0) * n_1 + sp.diff(whole, s_0) * s_1 - rule,
    }
    values, grown = {}, {}
    for name, slope in (
        ("radius", {n: (n - 2) * weight for n, weight in D_n.items()}),
        ("thickness", _eta_weights()),
    ):
        N_slope, S_slope = parts(slope)
        values[name] = rule.subs({n_0: N, s_0: S, n_1: N_slope, s_1: S_slope})
        grown[name] = sp.Add(*(slope[n] * sp.diff(integrand, D[n]) for n in orders()[1:]))
        for label, part, change in (("N", N, N_slope), ("S", S, S_slope)):
            moved = sp.Add(*(slope[n] * sp.diff(part, D[n]) for n in orders()[1:]))
            proofs[f"{label} by {name}"] = sp.expand(moved - change)
    proof = prove(
        "Derivatives of the contact time",
        "At fixed $u$, numerator and radicand are differentiated with respect to each $D_n$; the "
        "quotient rule gives the derivative of the integrand.",
        lambda *claims: proofs
        | {f"by {name}": claim - grown[name] for claim, name in zip(claims, values, strict=True)},
        *values.values(),
    )  # fmt: skip
    rows = (
        ("time_by_radius", r"\partial_{\log A_m}", r"$\log(a_m/h)$"),
        ("time_by_thickness", r"\partial_{\log\eta}", r"$\log(h/b)$ at fixed $a_m/h$"),
    )
    return tuple(
        Formula(
            name,
            rf"{latex}\,\mathrm{{d}}I/\mathrm{{d}}u",
            f"derivative of the contact time's integrand with respect to {by}",
            value,
            "1",
            "13",
            ("contact_integrand",),
            proof,
        )
        for (name, latex, by), value in zip(rows, values.values(), strict=True)
    )


def sensitivity() -> tuple[Formula, ...]:
    """Return the formulas of this step."""
    scaling()
    return (*law_slopes(), energy_number(), modulus_slope(), *peaks(), *times())
