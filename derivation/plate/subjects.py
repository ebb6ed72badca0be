"""The subjects of the paper, and the names that the files of a subject export.

A subject is a folder next to this module. To add one, name it in `SUBJECTS`. Each of its files has
a role and exports what is listed here, under the listed name. Files that a subject does not need
are omitted.

theory    STEPS     its steps of the derivation, after those of `chain.py`
kernels   MODULES   its modules of generated code, see `modules.py`
route     ROUTES    the second reference of a formula, by name
cases     CASES     hard cases, as a function that yields them
          LAWS      references of functions that are not formulas, by name
prose     ABOUT     text of the report about a step, by name

Its `budgets.toml` contains error budgets and domains.
"""

from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from typing import Any

SUBJECTS = (
    "modes",
    "contact",
    "impact",
    "edge",
    "pressure",
    "back_face",
    "effects",
    "viscosity",
    "waves",
    "edge_modes",
    "plasticity",
    "damping",
    "stretching",
    "sphere",
)


def exports(role: str, name: str) -> Iterator[Any]:
    """Yield the objects that the subjects' files of a role export under a name, in order."""
    for subject in SUBJECTS:
        path = f"{__package__}.{subject}.{role}"
        if find_spec(path) is not None:
            module = import_module(path)
            if hasattr(module, name):
                yield getattr(module, name)
