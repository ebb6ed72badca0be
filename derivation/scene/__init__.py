"""Simulates impacts from scene files, with NumPy and SciPy; SymPy is never loaded.

The modules and folders in reading order:

1. `scene` reads and validates the scene file; `input` has its tables (`bodies`, `settings`), the
   built-in `materials` and the messages.
2. `model` converts the scene into the quantities of the contact law.
3. `effects` has one module for each effect. `contact_law` combines the included effects (`law`); no
   other module uses the name of an effect.
4. `selection` selects the effects by bounds on the change of the results if they are omitted
   (`omission_bounds`), and then the fastest method whose error bound meets the tolerance
   (`method_selection`, `achieved_accuracy`). `limits` rejects scenes outside the range of the
   contact law, and warns where it is inaccurate. `explanation` prints all of it.
5. `quasi_static` simulates impacts on a plate without inertia: `motion` for an elastic contact,
   `viscous` and `plastic` for viscoelastic and plastic ones.
6. `dynamic` simulates impacts on a plate with inertia: modes (`modal`), tables of the contact
   (`contact_tables`), the scaled problem (`problem`), one time element (`time_element`), the
   sequence of contacts (`contact_sequence`), the time history (`wave_motion`) and the results.
   `numerics` has the quadrature and the collocation that both kinds of impacts use.
7. `impact` and `indentation` simulate an impact and compute static contacts. `measured` determines
   a material constant from a measured restitution.
8. `rows` computes many scenes at once in arrays, with the same effects, bounds and laws; `sweep`
   simulates a scene for each value of a key.
9. `result` contains the results; `output` prints, exports and draws them.
10. `code` generates a module with the law and the impact of one scene.

A scene that cannot be computed raises a `SceneError`. NaN occurs only as the restitution of an
incomplete impact, and in arrays for arguments outside the range.

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
