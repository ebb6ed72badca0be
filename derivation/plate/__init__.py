"""The paper on the plate: its derivation, generated functions, references and report."""
