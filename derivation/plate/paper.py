"""The `Paper` object of the paper on the plate."""

from typing import TYPE_CHECKING

from derivation.engine.files import ROOT, measurements
from derivation.engine.package import Package
from derivation.engine.paper import Paper, Report
from derivation.plate.derived import CHAIN
from derivation.plate.misprints import ERRATA

if TYPE_CHECKING:
    from derivation.engine.measure.check import Judge


def _package() -> Package:
    from derivation.plate.forms import AUTOMATIC, SCALES, stable_forms
    from derivation.plate.render import render

    parts = ("kernels*", "runtime*", "budgets.toml", "*.j2")
    sources = ("plate/budgets.toml", "plate/templates", *(f"plate/*/{part}" for part in parts))
    return Package("generated", stable_forms, render, sources, AUTOMATIC, SCALES)


def _judge() -> "Judge":
    from derivation.plate.judge import JUDGE

    return JUDGE


def _report() -> Report:
    from derivation.plate.reporting import REPORT

    return REPORT


PAPER = Paper(
    title="Contact of a rigid sphere with an elastic plate",
    folder=ROOT,
    records=measurements(),
    chain=CHAIN,
    errata=ERRATA,
    package=_package,
    judge=_judge,
    report=_report,
    committed=True,
)
