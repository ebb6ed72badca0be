"""The paper on the plate: its derivation, generated functions, references and report."""

CITATION = "Elastodynamic contact in plate-like bodies"
"""Title of the paper."""
