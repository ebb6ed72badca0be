"""Formulas, findings and committed measurements -> what the report's templates show."""

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

import sympy as sp

from derivation.formula.ball import enclose, to_ball
from derivation.formula.record import Formula
from derivation.formula.symbols import M, eta, r, z
from derivation.paper.misprints import Finding
from derivation.reference.contact_balls import finite_part
from derivation.report.equations import body, equation, folded, right_side
from derivation.report.latex import escape, unit
from derivation.report.numbers import number, rounded
from derivation.report.references import cited
from derivation.report.spoken import spoken
from derivation.theory.equilibrium import force_balance, hooke
from derivation.theory.thin_remainder import coefficient_remainder_ball
from derivation.theory.thin_roots import root

ROOT_DIGITS = 12
"""Digits certified of what the roots add, more than are shown."""
FACTOR = "G"
"""The plate factor, by whose name it is called in formulas after its own link."""
ABOUT = {
    "equilibrium": "One mode of the plate is u = g(z) phi J1(phi r), w = f(z) J0(phi r). Put into "
    "Hooke's law and the balance of forces it leaves two ordinary differential equations in z.",
    "mode shapes": "On exp(s z) the two equations are a 2x2 matrix; the roots of its determinant "
    "and their multiplicities give the solution space.",
    "stresses": "Hooke's law of the mode. The normal stresses in the plane have a second part "
    "that goes with J1(phi r)/r.",
    "face conditions": "No shear on either face, no pressure on the far face, A_j on the loaded "
    "one: four linear equations for C_k = A_j Omega_k.",
    "loaded mode": "The same shapes with the constants just found.",
    "influence": "The deflection of each face per pressure coefficient, and what remains of it "
    "when the plate becomes a half-space.",
    "plate factor": "The influence coefficients over the half-space's depend on T = 2 phi h alone.",
    "Hertz": "Hertz's pressure, its transform (Sonine's integral) and the contact radius, which "
    "follows from the half-space's influence coefficient.",
    "contact law": "The indentation is the deflection under the sphere's centre.",
    "interior": "Sums over the modes give the fields at any point.",
    "divergence": "For large j the modes feel a half-space: phi^3 K_j tends to a constant, and the "
    "sums in the paper's gamma_k diverge for every k.",
    "contact split": "A contour integral turns the sum for the indentation into Hertz's term, the "
    "side wall's integral and a sum that dies exponentially with the thickness.",
    "plate series": "For small contacts the two convergent parts are expanded in powers of the "
    "contact radius; the coefficients depend on h/b alone.",
    "thin plate": "For thin plates the sums become integrals over T, with finite parts M_k and a "
    "logarithm. What they leave out is a sum of residues at T_n, the roots of sinh T = T and "
    "sinh T = -T in the first quadrant, by height. With it the law is exact for every h/b.",
    "reversion": "Lagrange's inversion, of the paper's series and of the right one.",
    "impact": "The energy integral, the contact time as an integral of an analytic function, and "
    "the paper's linearisation.",
    "sensitivity": "An impact depends on seven parameters through two numbers, its energy number "
    "and h/b, beside plain powers. What these two do to peaks and contact time follows from the "
    "energy integral; the rest is exponents.",
    "substitution": "If the law's slope lies within known factors of a simpler one's, so do an "
    "impact's results. It lies between S_1 = 1 + 3 c_1 A/2 and S_1 - K_3 A^3 for every a < b, so "
    "that Hertz's law, and its first correction, know their own error.",
    "edge": "The paper's edge is a soft hinge: w = 0 and sigma_rr = -2 mu u/b. A clamp takes its "
    "mean motion away, a simple support its force and moment, by the exact states of stretching "
    "and bending; w = 0 on the middle plane's rim. The sums over the modes are residues.",
    "true pressure": "Not assumed but solved for: the pressure is Abel's transform of chi(t), and "
    "chi(t) + int N(t, s) chi(s) ds = (E*/pi) (delta - f(t)) on (0, a), where f belongs to the "
    "sphere's profile and N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2b). The kernel k is the slope "
    "by a/b of S = (R/2a) d delta/da of Hertz's pressure; chi(a) = 0 fixes delta. Last, a bound "
    "of what assuming Hertz's pressure changes at given force, a being Hertz's radius of it.",
    "curvature": "A growing contact is a sequence of flat punches. Where it is not small beside "
    "the sphere the paraboloid gives way to the sphere's own profile.",
    "effects": "Each effect adds a share to the law's slope at equal force. What it can add at "
    "most says whether a scene needs it.",
    "plate motion": "The law is static. These numbers say when the plate's own motion matters.",
    "viscosity": "A contact whose force lags behind its elastic part by a time A_v takes a part of "
    "the speed. In the plane of the velocity and the root of the elastic energy the motion is a "
    "spiral, which says how much at most.",
    "far face": "A plate breaks where it is drawn most: on the far face, under the axis. What its "
    "modes add up to there is, of a thin plate, a function of a/h and a logarithm of b/h; the "
    "edge's states of stretching and bending add their own stress.",
    "dynamic modes": "The first six links again, with the plate's own inertia. A load that "
    "oscillates bends and stretches the plate apart, with stiffnesses B_a and B_s: x = phi h, "
    "kappa = (omega h/c_T)^2, gamma = mu/(lambda + 2 mu), p^2 = x^2 - gamma kappa, q^2 = x^2 - "
    "kappa. Both fall with the frequency where they are finite, by the motion's kinetic energy, so "
    "that between two poles of either there is one branch of free waves; these are orthogonal.",
    "bending branch": "Below the speed of shear waves B_a vanishes once: on A0, the lowest branch. "
    "For thin plates it is Kirchhoff's bending and carries the whole load, for short waves it is "
    "Rayleigh's wave. Its share y of the face's deflection obeys y'' + omega_0^2 y = r_0 A_j. Here "
    "xi = kappa/x^2 and w = 1 - xi.",
    "closure": "A plate that moves is a set of oscillators q_j of static compliance c_j, and each "
    "feels only the part P_j of the force. With z = D + sum s_j q_j, s_j = dP_j/dP and D = delta - "
    "sum c_j P_j s_j no energy is lost or made, whatever the static law: int P dD + sum q_j (P s_j "
    "- P_j) is the contact's. With s_j = 1, the indentation at the axis, some leaks. The same "
    "weight turns the static law into the variational one.",
    "held modes": "A thin plate's modes J0(k r/b) - c I0(k r/b) whose edge has no slope, or no "
    "moment. Green's identity makes them orthogonal, and makes (J1/J0 + I1/I0)/k grow from one "
    "zero of J0 to the next, so that there is one mode between neighbouring ones. W_n says how a "
    "force on the axis moves it: the sum of W_n/k_n^4 is the deflection at rest.",
}


def navier() -> list[str]:
    """Navier's equations of a field u(r, z), w(r, z): what Hooke's law leaves of the balance."""
    u, w = (sp.Function(name)(r, z) for name in "uw")
    rows = []
    for force in force_balance(hooke(u, w)):
        terms = sp.expand(force.doit())
        whole = sp.collect(terms, [*sorted(terms.atoms(sp.Derivative), key=str), u, w])
        rows.append(equation("0", whole).replace(r"{\left(r,z \right)}", ""))
    return rows


def chain_context(links: Sequence[tuple[str, Sequence[Formula]]]) -> dict[str, Any]:
    """The chain at a glance: what each link is built on, how much it holds."""
    home = {f.name: place for place, (_, found) in enumerate(links, 1) for f in found}
    rows = []
    for place, (name, found) in enumerate(links, start=1):
        built = {home[name] for f in found for name in f.sources if name in home} - {place}
        on = ", ".join(str(n) for n in sorted(built)) or "--"
        equations = sorted({f.equation for f in found if f.equation}, key=_equation_order)
        printed = ", ".join(f"({e})" for e in equations)
        rows.append(f"{place} & {escape(name)} & {on} & {len(found)} & {printed}")
    decided = Counter(f.proof.method for _, found in links for f in found)
    return {
        "formulas": sum(decided.values()),
        "decided": ", ".join(f"{count} were decided {how}" for how, count in decided.items()),
        "rows": rows,
    }


def _equation_order(text: str) -> tuple[int, str]:
    digits = re.match(r"\d+", text)
    return (int(digits[0]) if digits else 0, text)


def link_context(
    name: str, formulas: Sequence[Formula], shown: Mapping[str, Formula]
) -> dict[str, Any]:
    """A link of the chain: its formulas, which refer to those shown, and each proof once."""
    proofs = {formula.proof.step: formula.proof for formula in formulas}
    return {
        "title": name[0].upper() + name[1:],
        "about": ABOUT[name],
        "cited": cited(name),
        "formulas": [formula_context(formula, shown) for formula in formulas],
        "proofs": [
            {
                "step": proof.step,
                "argument": proof.argument,
                "method": proof.method,
                "residuals": ", ".join(proof.residuals),
            }
            for proof in proofs.values()
        ],
    }


def roots_context(formulas: Mapping[str, Formula]) -> dict[str, Any]:
    """The first roots, and what they add to the closed form of c_1, computed in balls."""
    closed, M_2 = formulas["c_1_thin"].expression, finite_part(2, ROOT_DIGITS)
    rows = []
    for ratio in ("1/20", "1/10", "1/5", "1/3", "1/2", "1"):
        value = enclose(closed, {eta: to_ball(Fraction(ratio)), M[2]: M_2})
        share = coefficient_remainder_ball(2, Fraction(ratio), ROOT_DIGITS)
        texts = (value.str(6, radius=False), (value + share).str(6, radius=False))
        rows.append(f"${ratio}$ & ${texts[0]}$ & {number(float(share))} & ${texts[1]}$")
    return {
        "first": [root_text(n) for n in (1, 2)],
        "height": root(1).imag.str(5, radius=False),
        "rows": rows,
    }


def root_text(n: int) -> str:
    """T_n to a few digits."""
    T = root(n)
    return rf"{T.real.str(6, radius=False)} + {T.imag.str(6, radius=False)}\,\mathrm{{i}}"


def formula_context(formula: Formula, known: Mapping[str, Formula] | None = None) -> dict[str, Any]:
    """A formula as the template shows it, with the numbers of those known that it comes from."""
    known = known or {}
    whole, factor = right_side(formula), known.get(FACTOR)
    sources = [reference(source, known) for source in formula.sources]
    if factor and whole.free_symbols == factor.expression.free_symbols:
        factor = None  # a formula of the plate factor's own link
    if factor and folded(whole, factor) != whole and FACTOR not in formula.sources:
        sources.append(f"with {reference(FACTOR, known)}")
    return {
        "name": formula.name,
        "meaning": formula.meaning,
        "unit": unit(formula.unit),
        "equation": formula.equation,
        "sources": ", ".join(sources),
        "body": body(formula, factor),
    }


def reference(name: str, known: Collection[str]) -> str:
    """A formula's name, with the number of its equation if it is known."""
    place = rf"~(\ref{{eq:{name}}})" if name in known else ""
    return rf"\texttt{{{escape(name)}}}{place}"


def finding_context(finding: Finding) -> dict[str, Any]:
    """A comparison as the template shows it."""
    printed, diagnosis = finding.printed, finding.diagnosis
    formula = finding.formula
    return {
        "equation": printed.equation,
        "name": printed.name,
        "says": printed.says,
        "printed": as_printed(printed.symbol, printed.full or printed.latex),
        "derived": body(formula),
        "equal": not finding.is_misprint,
        "kind": diagnosis.kind[0].upper() + diagnosis.kind[1:],
        "repair": spoken(finding.repair[0].upper() + finding.repair[1:].rstrip(".")),
        "dimension": spoken(diagnosis.dimension or ""),
        "method": diagnosis.method,
    }


def as_printed(left: str, right: str) -> str:
    """A printed equation, in the lines the paper gives it."""
    right = right.rstrip(". ")
    if "&" in right:
        return rf"\begin{{aligned}} {left} ={{}}& {right} \end{{aligned}}"
    return f"{left} = {right}"


def accuracy_tables(check: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """The generated kernels, and for contrast the formulas as printed."""
    promised = [row for row in check["rows"] if row["passed"] is not None]
    printed = [row for row in check["rows"] if row["passed"] is None]
    yield {"caption": "Generated functions", "rows": [accuracy_row(row) for row in promised]}
    yield {
        "caption": "The formulas as printed, at the same points, for contrast",
        "rows": [accuracy_row(row) for row in printed],
    }


def accuracy_row(row: Mapping[str, Any]) -> str:
    """Cells of one row; a result that is not a number counts as infinitely wrong."""
    errors = row["double"]
    cells = [
        escape(row["kernel"]),
        str(errors["points"]),
        number(errors["max_ulp"]) if not errors["not_finite"] else r"$\infty$",
        number(errors["p99_ulp"]),
        number(errors["rms_ulp"]),
        "" if row["budget"] is None else f"{row['budget']:g}",
        "" if errors["ratio"] is None else number(errors["ratio"]),
    ]
    return " & ".join(cells)


def rewrite_rows(row: Mapping[str, Any]) -> Iterator[str]:
    """Cells of a formula's rules: what the form is without and with each."""
    for index, applied in enumerate(row["applied"]):
        name = rf"\texttt{{{escape(row['name'])}}}" if index == 0 else ""
        (fewer, more), (without, within) = applied["operations"], applied["worst"]
        cells = [name, escape(applied["rule"]), escape(applied["cause"]), str(fewer), str(more)]
        yield " & ".join([*cells, number(without), number(within)])


def contact_row(row: Mapping[str, Any]) -> str:
    """Cells of a row of the contact law's errors."""
    cells = [escape(row["kernel"]), str(row["points"]), str(row["digits"])]
    return " & ".join([*cells, number(row["max_error"]), number(row["p99_error"])])


def contact_impacts(rows: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Over what the measured impacts reach: c_1 A, h/b and a/h."""
    cases = [case for row in rows for case in row["cases"]]
    ends = {}
    for key in ("c1_A", "h_over_b", "a_over_h"):
        values = [case[key] for case in cases]
        ends[f"{key}_low"], ends[f"{key}_high"] = rounded(min(values)), rounded(max(values))
    return ends
