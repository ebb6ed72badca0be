"""The engine: derivation, code generation, checks and report for any paper."""
