"""The subjects of the paper, and what the files of a subject hand in.

A subject is a folder of this one. A new one is named in `SUBJECTS`, and nowhere else. Each of its
files is a role, and hands in what is listed here, under the name that is listed here. Whatever a
subject does not need is left out.

theory    LINKS     its links of the chain, after those of `chain.py`
kernels   MODULES   its modules of generated code, see `modules.py`
route     ROUTES    the second reference of a formula, by name
cases     CASES     hard cases, as a function that yields them
          LAWS      references of functions that are no formula, by name
prose     ABOUT     what the report says of a link, by name

Its `budgets.toml` states error budgets and domains.
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
)


def handed_in(role: str, name: str) -> Iterator[Any]:
    """Yield what the subjects' files of a role hand in under a name, in the subjects' order."""
    for subject in SUBJECTS:
        path = f"{__package__}.{subject}.{role}"
        if find_spec(path) is not None:
            module = import_module(path)
            if hasattr(module, name):
                yield getattr(module, name)
