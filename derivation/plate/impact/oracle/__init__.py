"""Reference values in ball arithmetic, from the original expressions: the impact."""
