"""`python -m derivation.checks.finite_elements`: compute what the record lacks."""

from derivation.checks.finite_elements.record import computed
from derivation.engine.console import counted

if __name__ == "__main__":
    with counted("elastodynamics") as progress:
        computed(progress=progress)
