"""From a scene file to the course of an impact, in numbers alone: SymPy is never loaded.

Read in this order:

1. `scene`: reads and validates the scene file.
2. `model`: turns the scene into the numbers the kernels take.
3. `effects`: one file each; `law` adds up those that are in.
4. `gate`: which effects the scene calls for, by bounds of what leaving them out changes
   (`left_out`); `explanation` shows it.
5. `limits`: refuses what lies outside the contact law, warns where it grows inexact.
6. `choice`: the cheapest method whose error bound meets a tolerance; `motion` is the one
   that takes any law, `viscous` by `collocation` the one that also takes a contact that lags
   (`viscous_law`), `waves` the one for a plate that moves: of its oscillators (`modal`) an
   element of time (`dynamics`), contacts one after the other (`bounces`), and their course
   (`wave_motion`).
7. `impact`, `indentation`: simulate an impact, press the sphere in by a given amount.
8. `sweep`: one simulation per value of a key.
9. `result`: what comes out, as JSON, CSV and a notebook table; `plot` draws it, `comparison`
   sets the paper's own motion beside it.
10. `code`: what a module with the law and the impact of one scene is made of.

`kernels` is the only door to the generated package; `commands` is the command line.

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
    from derivation.scene.scene import Scene, SceneError, load, read, schema

__all__ = ["Scene", "SceneError", "explain", "indent", "load", "read", "schema", "simulate"]

HOMES = {"explain": "explanation", "simulate": "impact", "indent": "indentation"}
"""Where a public name lives, if not in `scene`."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{HOMES.get(name, 'scene')}"), name)
