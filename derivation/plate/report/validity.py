"""The contact law in the report: its formulas, where it holds, and a map of what it calls for."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.formula.record import Record
from derivation.engine.report.equations import body
from derivation.engine.report.numbers import rounded
from derivation.plate.report.prose import FACTOR
from derivation.scene import edge_remainder, kernels, limits
from derivation.scene.effects import edge, non_hertzian_pressure, spherical_profile
from derivation.scene.model import PLATES

FORMULAS = (
    FACTOR, "P", "delta_half", "delta_side", "delta_thickness", "delta_reduced", "c_1_thin",
    "delta_slope", "contact_work", "contact_integrand",
)  # fmt: skip
"""The plate factor, the law, its small contacts, its slope, and what an impact makes of it."""


def law_context(formulas: Mapping[str, Record]) -> dict[str, Any]:
    """Formulas of the law, which call the plate factor by its name, and its limits."""
    factor = formulas[FACTOR]
    shown = [(formulas[name], None if name == FACTOR else factor) for name in FORMULAS]
    return {
        "formulas": [
            {"name": formula.name, "meaning": formula.meaning, "body": body(formula, named)}
            for formula, named in shown
        ],
        "limits": list(limit_rows()),
    }


def limit_rows() -> list[str]:
    """Parameter, limit, what happens beyond it and the reason; the limits are those of the code."""
    open_, held = f"{non_hertzian_pressure.MAX_A_OVER_H:g}", f"{edge.MAX_A_OVER_B:g}"
    curved = f"{spherical_profile.MAX_A_OVER_R:g}"
    thin, thick = (rounded(ratio) for ratio in PLATES)
    rows = (
        (r"$a/b$, $a/R$", "1", "refused", "the contact would reach the edge, or past the sphere"),
        (r"$a/b$", held, "refused with an edge other than the paper's, or solved pressure",
         "the edge's sums and the kernel are known so far"),
        (r"$a/R$", curved, "refused with \\texttt{spherical\\_profile}",
         "the slope of the spherical profile tends to infinity"),
        (r"$a/h$", open_, "refused with \\texttt{non\\_hertzian\\_pressure}",
         "contact is lost at the centre"),
        (r"$h/b$", f"{thin} to {thick}", "refused outside", "bounds are known for these plates"),
        (r"$\nu$", r"$-1$ to $1/2$", "refused outside", "the material would not be stable"),
        (r"$a/H$", f"{limits.HERTZ_LIMIT:g}", "warned without \\texttt{non\\_hertzian\\_pressure}",
         "the pressure is no longer Hertz's"),
        (r"$a/R$", f"{limits.PARABOLOID_LIMIT:g}", "warned without \\texttt{spherical\\_profile}",
         "the sphere is no paraboloid any more"),
        (r"$w/H$", f"{limits.STRETCH_LIMIT:g}", "warned", "the plate's middle surface stretches"),
        (r"$p_0$ over yield stress", f"{kernels.YIELD_LIMIT:g}", "warned",
         "a metal yields below the contact"),
        ("Zener's number", f"{limits.ZENER_LIMIT:g}", "warned without \\texttt{inertia}",
         "waves carry off 1\\,\\% of the speed"),
        ("contact time over $4H/c_P$", "1", "warned below",
         "echoes through the thickness return during the contact"),
        ("edge's model error", f"{100 * edge_remainder.LARGEST:g}\\,\\%", "refused beyond",
         "what the edge's exact states leave is too much"),
    )  # fmt: skip
    return [" & ".join(row) for row in rows]
