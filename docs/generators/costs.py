"""What accuracy costs: the committed measurements as figures and tables."""

import json
from itertools import groupby

from derivation.plate.report import readme
from derivation.plate.report.dynamic_benchmark import benchmark_rows, dynamic_benchmark_figure
from derivation.plate.reporting import benchmark_record, measurement
from docs.generators import gallery
from docs.generators.markdown import table

COLUMNS = {
    "method": "method", "modes": "modes", "milliseconds": "CPU time [ms]",
    "error": "largest relative error", "bound": "stated bound",
}  # fmt: skip
"""Heads of the columns of impacts with plate inertia."""


def law() -> str:
    """Return what the contact law and quasi-static impacts cost."""
    script = gallery.FOLDER / "accuracy_time.py"
    title, about = gallery.described(script)
    picture = gallery.written(script.stem, gallery.drawn(script), title)
    return "\n\n".join([about, picture, "\n".join(readme.lines(benchmark_record()))])


def inertia() -> str:
    """Return what impacts with plate inertia cost."""
    data = json.loads(measurement()["moving"])
    title = "Largest relative error against the time of an impact"
    parts = [gallery.written("inertia_cost", dynamic_benchmark_figure(data), title)]
    for study, rows in groupby(benchmark_rows(data), key=lambda row: row["study"]):
        kept = list(rows)
        columns = [name for name in COLUMNS if any(row[name] for row in kept)]
        cells = ([row[name] for name in columns] for row in kept)
        parts += [f"### {study.capitalize()}", table([COLUMNS[name] for name in columns], cells)]
    return "\n\n".join(parts)
