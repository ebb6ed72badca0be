"""`python -m derivation.checks.finite_elements`: compute missing cases of the record."""

from derivation.checks.finite_elements.record import compute_missing
from derivation.engine.console import progress_bar

if __name__ == "__main__":
    with progress_bar("elastodynamics") as progress:
        compute_missing(progress=progress)
