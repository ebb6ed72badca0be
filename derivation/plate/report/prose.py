"""Texts of the report about derivation steps, and the bibliography."""

from pathlib import Path

from derivation.engine.report.references import References
from derivation.plate.subjects import exports

FACTOR = "G"
"""The plate factor, which is printed as a function after the step that derives it."""
REFERENCES = References(Path(__file__).with_name("references.toml"))
ABOUT = {step: text for about in exports("prose", "ABOUT") for step, text in about.items()}
"""Text about each derivation step, from the `prose` of the subjects."""
