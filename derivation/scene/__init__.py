"""From a scene file to the time history of an impact, in numbers alone: SymPy is never loaded.

Read in this order:

1. `scene`: reads and validates the scene file; `bodies` are its tables of sphere, plate and
   materials, `materials` the named ones.
2. `model`: turns the scene into the numbers the kernels take.
3. `effects`: one file each, which answers every question about the effect; `law` asks those that
   are included, and no other file knows an effect by its name.
4. `selection`: which effects are included, by bounds on the change of the results if they are
   omitted (`omission_bounds`, `law_errors`); `effect_selection` is the effects table, and
   `explanation` shows it.
5. `limits`: refuses what lies outside the contact law, warns where it grows inexact.
6. `method_selection`: the fastest method whose error bound meets a tolerance. `motion` takes any
   law on a quasi-static plate, `viscous` by `collocation` also a viscoelastic contact
   (`viscous_law`), and `waves` a plate with inertia: with its modes (`modal`) a time element
   (`time_element`), contacts one after the other (`contact_sequence`), and their time history
   (`wave_motion`).
7. `impact`, `indentation`: simulate an impact, compute a static contact.
8. `sweep`: one simulation per value of a key. `rows`: many scenes at once, whose numbers are
   `columns`; effects are selected (`rows_selection`) and quasi-static impacts computed
   (`static_rows`) in arrays, with the same effects, bounds and laws as of one scene.
9. `result`: the results, `answer` puts them in words; `export` hands them to pandas and xarray,
   `plot` draws them, `comparison` compares the paper's motion with them.
10. `code`: what a module with the law and the impact of one scene is made of.

What cannot be computed raises a `SceneError`; no function returns None or NaN instead. A value that
is NaN is data: the restitution of an incomplete impact, a point of an array out of range.

`kernels` imports the generated package; the commands are in `derivation.commands`.

    >>> from derivation.scene import load, simulate, indent
    >>> result = simulate(load("scene.toml"))
    >>> contacts = indent(load("scene.toml"), force=[10.0, 100.0])

Names are loaded when first used, so that the command line starts quickly.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from derivation.scene.explanation import explain
    from derivation.scene.impact import simulate
    from derivation.scene.indentation import indent
    from derivation.scene.result import Result
    from derivation.scene.scene import (
        Accuracy,
        Effects,
        Impact,
        Inertia,
        Material,
        Measured,
        Plate,
        Scene,
        SceneError,
        Sphere,
        load,
        read,
        schema,
    )

__all__ = [
    "Accuracy",
    "Effects",
    "Impact",
    "Inertia",
    "Material",
    "Measured",
    "Plate",
    "Result",
    "Scene",
    "SceneError",
    "Sphere",
    "explain",
    "indent",
    "load",
    "read",
    "schema",
    "simulate",
]

HOMES = {
    "Result": "result",
    "explain": "explanation",
    "simulate": "impact",
    "indent": "indentation",
}
"""Where a public name lives, if not in `scene`."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{HOMES.get(name, 'scene')}"), name)
