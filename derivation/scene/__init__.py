"""Simulates impacts from scene files, with NumPy and SciPy; SymPy is never loaded.

The modules in reading order:

1. `scene` reads and validates the scene file; its tables are in `bodies` (sphere, plate and own
   materials) and `settings`; `materials` has the built-in materials.
2. `model` converts the scene into the quantities of the contact law.
3. `effects` has one module for each effect. `law` combines the included effects; no other module
   uses the name of an effect.
4. `selection` selects the effects by bounds on the change of the results if they are omitted
   (`omission_bounds`, `law_errors`). `effect_selection` makes the effects table, and `explanation`
   prints it.
5. `limits` rejects scenes outside the range of the contact law, and warns where it is inaccurate.
6. `method_selection` selects the fastest method whose error bound meets the tolerance, and states
   the `achieved_accuracy`. `motion` is for a quasi-static plate, `viscous` with `collocation` and
   `viscous_law` for a viscoelastic contact, `plastic` for a plastic one, and `waves` for plate
   inertia: modes (`modal`), tables of the contact (`contact_tables`), the scaled problem
   (`dynamic_problem`), one time element (`time_element`), the sequence of contacts
   (`contact_sequence`), the time history (`wave_motion`) and the results (`dynamic_results`).
7. `impact` and `indentation` simulate an impact and compute static contacts.
8. `sweep` simulates a scene for each value of a key. `rows` computes many scenes at once in arrays
   (`columns`, `rows_selection`, `static_rows`), with the same effects, bounds and laws.
9. `result` holds the results, `answer` formats them, `export` converts them for pandas and xarray,
   `plot` draws them, and `comparison` compares them with the paper's motion.
10. `code` generates a module with the law and the impact of one scene.

A scene that cannot be computed raises a `SceneError`. NaN occurs only as a value: the restitution
of an incomplete impact, or a number of an array outside the range.

`kernels` imports the generated package; the commands are in `derivation.commands`.

    >>> from derivation.scene import load, simulate, indent
    >>> result = simulate(load("scene.toml"))
    >>> contacts = indent(load("scene.toml"), force=[10.0, 100.0])

Names are loaded at their first use, to keep the start of the command line short.
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
"""The module of each public name; the default is `scene`."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{HOMES.get(name, 'scene')}"), name)
