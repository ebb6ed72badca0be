"""Accuracy against run time.

Committed measurements of methods for the contact law of the paper's case, in arrays. Each point
is one setting; better methods are further up and to the left.
"""

import json

import numpy as np
from matplotlib.figure import Figure

from derivation.engine.files import ROOT

LABELS = {
    "production": "generated function",
    "small-a series": "series for small contacts",
    "thin-plate closed form": "closed form of thin plates",
    "Chebyshev surrogate": "Chebyshev polynomial",
    "table of cubics": "table of cubics",
    "direct sum": "sum over modes",
}
rows = json.loads((ROOT / "reports" / "data" / "accuracy.json").read_text())["rows"]
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for family, label in LABELS.items():
    points = [
        (row["vector"]["seconds"], row["errors"]["total"])
        for row in rows
        if (row["task"], row["regime"], row["family"]) == ("law", "paper", family)
        and row["arithmetic"] == "float64" and row["vector"]
    ]  # fmt: skip
    axes.semilogx(*np.transpose(sorted(points)), "o", label=label, markersize=4)
axes.set(
    xlabel="time per point [s]", ylabel="correct digits [1]",
    title="Methods for the contact law",
)  # fmt: skip
figure.legend(loc="outside right center")
