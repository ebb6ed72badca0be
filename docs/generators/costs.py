"""What accuracy costs: the committed measurements in a few tables."""

import json

from derivation.checks import dynamic_benchmark
from derivation.plate.report import readme
from derivation.plate.reporting import benchmark_record, measurement
from docs.generators.markdown import table


def law() -> str:
    """Return what the contact law and quasi-static impacts cost."""
    return "\n".join(readme.lines(benchmark_record()))


def inertia() -> str:
    """Return what impacts with plate inertia cost."""
    heads = [head.lstrip("#") for head in dynamic_benchmark.COLUMNS]
    return table(heads, dynamic_benchmark.cells(json.loads(measurement()["moving"])))
