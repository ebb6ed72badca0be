"""Accuracy against run time.

Committed measurements of methods for the contact law of the paper's case, in arrays. Each point
is one setting; better methods are further up and to the left.
"""

import json

import numpy as np
from matplotlib.figure import Figure

from derivation.engine.files import ROOT

METHODS = (
    "generated code", "series in a/h", "thin-plate closed form", "Chebyshev polynomial",
    "cubic interpolation", "direct sum",
)  # fmt: skip
rows = json.loads((ROOT / "reports" / "data" / "accuracy.json").read_text())["rows"]
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for family, marker in zip(METHODS, "os^vD*", strict=True):
    points = [
        (row["vector"]["seconds"], row["errors"]["total"])
        for row in rows
        if (row["task"], row["case"], row["family"]) == ("law", "paper", family)
        and row["arithmetic"] == "float64" and row["vector"]
    ]  # fmt: skip
    axes.semilogx(*np.transpose(sorted(points)), marker, label=family, alpha=0.8)
axes.set(
    xlabel="time per point [s]", ylabel="correct digits [1]",
    title="Methods for the contact law",
)  # fmt: skip
axes.legend(loc="center")
