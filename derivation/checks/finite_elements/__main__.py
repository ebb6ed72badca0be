"""`python -m derivation.checks.finite_elements`: compute missing cases of the record."""

from derivation.checks.finite_elements.record import computed
from derivation.engine.console import counted

if __name__ == "__main__":
    with counted("elastodynamics") as progress:
        computed(progress=progress)
