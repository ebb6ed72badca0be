"""What the report says of the plate's links, and what the plate's derivation builds on."""

from pathlib import Path

from derivation.engine.report.references import References
from derivation.plate.subjects import handed_in

FACTOR = "G"
"""The plate factor, by whose name it is called in formulas after its own link."""
REFERENCES = References(Path(__file__).with_name("references.toml"))
ABOUT = {link: text for about in handed_in("prose", "ABOUT") for link, text in about.items()}
"""A few sentences by link, as the subjects hand them in."""
