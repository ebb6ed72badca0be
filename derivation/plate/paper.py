"""The paper on the plate, as the engine sees it."""

from typing import TYPE_CHECKING

from derivation.engine.files import ROOT, measurements
from derivation.engine.package import Package
from derivation.engine.paper import Paper, Report
from derivation.plate.derived import CHAIN
from derivation.plate.misprints import ERRATA

if TYPE_CHECKING:
    from derivation.engine.measure.check import Judge


def _package() -> Package:
    from derivation.plate.package_pipeline import PACKAGE

    return PACKAGE


def _judge() -> "Judge":
    from derivation.plate.judge import JUDGE

    return JUDGE


def _report() -> Report:
    from derivation.plate import reporting
    from derivation.plate.report.front import SUBTITLE
    from derivation.plate.report.sections import PROSE

    return Report(
        ROOT / "reports",
        measurements() / "check.json",
        PROSE,
        SUBTITLE,
        write=reporting.report,
    )


PAPER = Paper(
    title="Contact of a rigid sphere with an elastic plate",
    chain=CHAIN,
    errata=ERRATA,
    package=_package,
    judge=_judge,
    report=_report,
)
