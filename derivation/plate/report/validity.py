"""Values of the template: formulas of the contact law, and its range of validity."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.formula.record import Record
from derivation.engine.report.equations import body
from derivation.engine.report.latex import unit
from derivation.engine.report.numbers import rounded
from derivation.plate.report.prose import FACTOR
from derivation.scene import kernels
from derivation.scene.contact_law import edge_remainder, limits
from derivation.scene.effects import edge, non_hertzian_pressure, spherical_profile
from generated.simple_impact import PLATES

FORMULAS = (
    FACTOR, "P", "delta_half", "delta_lateral", "delta_thickness", "delta_reduced", "c_1_thin",
    "delta_slope", "contact_work", "contact_integrand",
)  # fmt: skip
"""The plate factor, the law, its series for small contacts, its slope, and the impact."""


def law_context(formulas: Mapping[str, Record]) -> dict[str, Any]:
    """Return the formulas of the law, and its limits."""
    factor = formulas[FACTOR]
    shown = [(formulas[name], None if name == FACTOR else factor) for name in FORMULAS]
    return {
        "formulas": [
            {
                "name": formula.name,
                "meaning": formula.meaning,
                "unit": unit(formula.unit),
                "body": body(formula, named),
            }
            for formula, named in shown
        ],
        "limits": list(limit_rows()),
    }


def limit_rows() -> list[str]:
    """Return parameter, limit, consequence beyond it and reason; limits are those of the code."""
    open_, held = f"{non_hertzian_pressure.MAX_A_OVER_H:g}", f"{edge.MAX_A_OVER_B:g}"
    curved, solved = (
        f"{effect.MAX_A_OVER_R:g}" for effect in (spherical_profile, non_hertzian_pressure)
    )
    thin, thick = (rounded(ratio) for ratio in PLATES)
    rows = (
        (r"$a/b$, $a/R$", "1", "rejected", "the contact would reach the edge or the whole sphere"),
        (r"$a/b$", held, "rejected with another edge than the paper's, or non-Hertzian pressure",
         "the series for the edge and for the pressure are tabulated up to this limit"),
        (r"$a/R$", curved, "rejected with \\texttt{spherical\\_profile}",
         "the slope of the spherical profile tends to infinity"),
        (r"$a/R$", solved, "rejected with \\texttt{non\\_hertzian\\_pressure}",
         "the pressure is resolved up to this limit"),
        (r"$a/h$", open_, "rejected with \\texttt{non\\_hertzian\\_pressure}",
         "contact is lost at the centre"),
        (r"$h/b$", f"{thin} to {thick}", "rejected", "the error bounds are proved for this range"),
        (r"$\nu$", r"$-1$ to $1/2$", "rejected", "the material would be unstable"),
        (r"$a/H$", f"{limits.HERTZ_LIMIT:g}",
         "warning without \\texttt{non\\_hertzian\\_pressure}",
         "the pressure differs from Hertz's"),
        (r"$a/R$", f"{limits.PARABOLOID_LIMIT:g}", "warning without \\texttt{spherical\\_profile}",
         "the sphere differs from a paraboloid"),
        (r"$w/H$", f"{limits.STRETCH_LIMIT:g}", "warning",
         "the plate stretches; the model error includes this at any deflection"),
        (r"$p_0$ / yield stress", f"{kernels.YIELD_LIMIT:g}", "warning",
         "a metal yields below the contact"),
        ("Zener parameter", f"{limits.ZENER_LIMIT:g}", "warning without \\texttt{inertia}",
         "bending waves reduce the rebound speed by 1\\,\\%"),
        ("contact time / ($4H/c_P$)", "1", "warning below, without all wave branches",
         "waves across the thickness are neglected"),
        ("model error of the edge", f"{100 * edge_remainder.LARGEST:g}\\,\\%", "rejected",
         "the approximation of the edge is too inaccurate"),
    )  # fmt: skip
    return [" & ".join(row) for row in rows]
