"""Impacts against finite elements, from the recorded cases: the report's tables and figure."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from derivation.engine.report.figures import STYLE
from derivation.engine.report.latex import escape
from derivation.engine.report.numbers import number, rounded
from derivation.scene.dynamic.model_error import ROUGHLY_RESOLVED
from generated.bessel import bessel_j0_zeros
from generated.inertia import bending_frequency

Row = Mapping[str, Any]
RESULTS = {
    "contact_time": "contact time",
    "max_indentation": "indentation",
    "max_force": "force",
    "restitution": "restitution",
}
"""Results that are compared, by their name in the data."""
STRESS = "max_tensile_stress"
MARKS = {"paper": ("o", "paper's edge"), "simply-supported": ("s", "simply supported"),
         "clamped": ("^", "clamped")}  # fmt: skip
SHOWN = 0.3
"""Poisson's ratio of the natural frequencies in the table."""


def elastodynamics_context(data: Row) -> dict[str, Any]:
    """Return the values of the template: rows of both tables, and largest differences."""
    rows = list(_compared(data))
    rejected = [row for row in data["impacts"] if "rejected" in row.get("program", {})]
    errors = [row["errors"][name] for row in rows for name in RESULTS]
    stresses = [x for row in rows for x in _stress_difference(row)]
    return {
        "stresses": len(stresses),
        "stress_median": rounded(float(np.median(stresses)) if stresses else 0.0),
        "stress_largest": rounded(max(stresses, default=0.0)),
        "cases": len(rows),
        "rejected": len(rejected),
        "within": sum(_excess(row) <= 1.0 for row in rows),
        "own_median": rounded(float(np.median(errors)) if errors else 0.0),
        "own_largest": rounded(max(errors, default=0.0)),
        "rows": [_impact_row(row) for row in rows],
        "plates": [_plate_row(row) for row in data["plates"] if row["poissons_ratio"] == SHOWN],
        "exact": number(from_exact(data["plates"])),
    }


def elastodynamics_figure(data: Row) -> Figure:
    """Draw the largest difference against the stated error and against the contact time."""
    rows = list(_compared(data))
    with mpl.rc_context(STYLE | {"font.size": 8}):
        figure = Figure(figsize=(6.5, 2.9), layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True)
        for edge, (mark, label) in MARKS.items():
            chosen = [row for row in rows if row["scene"]["plate"]["edge"] == edge]
            differences = [max(_differences(row).values()) for row in chosen]
            stated = [_stated(row) + max(row["errors"][k] for k in RESULTS) for row in chosen]
            waits = [row["elements"]["contact_time"] / row["edge_echo"] for row in chosen]
            left.plot(stated, differences, mark, ms=3.5, mfc="none", label=label)
            right.plot(waits, differences, mark, ms=3.5, mfc="none")
        ends = np.array([1e-4, 1.0])
        left.plot(ends, ends, "k:", lw=0.8)
        right.axvline(1.0, color="k", ls=":", lw=0.8)
        left.set(xscale="log", yscale="log", xlabel="stated bound, model and element error",
                 ylabel="largest relative difference")  # fmt: skip
        right.set(xscale="log", xlabel="contact time / earliest edge reflection [1]")
        left.legend(fontsize=7)
    return figure


def _compared(data: Row) -> Iterator[Row]:
    """Yield the impacts that the program has simulated."""
    yield from (row for row in data["impacts"] if "values" in row.get("program", {}))


def _differences(row: Row) -> dict[str, float]:
    """Return the relative differences of the results [1]."""
    values, elements = row["program"]["values"], row["elements"]
    return {name: abs(values[name] / elements[name] - 1.0) for name in RESULTS}


def _stress_difference(row: Row) -> Iterator[float]:
    """Yield the relative difference of the tensile stress if the elements resolve it [1]."""
    value = row["program"]["values"][STRESS]
    if value is not None and row["errors"][STRESS] <= ROUGHLY_RESOLVED:
        yield abs(value / row["elements"][STRESS] - 1.0)


def _stated(row: Row) -> float:
    """Return the stated bound and model error of the simulation [1]."""
    return float(row["program"]["bound"] + row["program"]["model_error"])


def _excess(row: Row) -> float:
    """Return the largest difference relative to stated error plus error of the elements [1]."""
    stated = _stated(row)
    return max(x / (stated + float(row["errors"][name])) for name, x in _differences(row).items())


def _impact_row(row: Row) -> str:
    """Return the cells of an impact: differences, and errors of the elements, in 1/1000."""
    values, elements = row["program"]["values"], row["elements"]
    cells = [escape(row["name"]), f"{row['contacts']}/{row['program']['contacts']}"]
    for name in RESULTS:
        difference = 1e3 * (values[name] / elements[name] - 1.0)
        cells.append(rf"${difference:+.2f}$ ({1e3 * row['errors'][name]:.2f})")
    return " & ".join([*cells, f"{1e3 * _stated(row):.2g}"])


def _plate_row(row: Row) -> str:
    """Return the cells of a plate: its natural frequencies."""
    label = MARKS[row["edge"]][1]
    numbers = [f"{x:.5g}" for x in row["frequencies"]]
    return " & ".join([label, f"{row['thickness_over_radius']:g}", *numbers, _worst(row["errors"])])


def _worst(errors: Sequence[float]) -> str:
    return rounded(max(errors))


def from_exact(plates: Sequence[Row]) -> float:
    """Return the largest difference from the exact frequencies on the paper's edge [1]."""
    differences = [0.0]
    for row in plates:
        if row["edge"] == "paper":
            half, own = row["thickness_over_radius"] / 2.0, np.array(row["frequencies"])
            exact = bending_frequency(bessel_j0_zeros(own.size) * half, row["poissons_ratio"])
            differences.append(float(np.abs(own * half / exact - 1.0).max()))
    return max(differences)
