"""Contact and impact of a sphere on an elastic plate: simulations, formulas, code.

    >>> import platecontact as pc
    >>> pc.formula("G").unit
    '1'
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ... )
    >>> print(f"{pc.simulate(scene).contact_time:.3g} s")
    9.26e-05 s

`load` reads a scene from a file, `read` from nested mappings.

All quantities are in SI units. Each name is loaded at its first use; a simulation does not load
SymPy.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    __version__: str
    from derivation import diagnose, formula
    from derivation.scene import (
        Accuracy,
        Effects,
        Impact,
        Inertia,
        Material,
        Measured,
        Plate,
        Result,
        Scene,
        SceneError,
        Sphere,
        explain,
        indent,
        load,
        read,
        schema,
        simulate,
    )
    from derivation.sweep import sweep

    from .digits import reference
    from .formulary import formulas, misprints, rewrite

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
    "diagnose",
    "explain",
    "formula",
    "formulas",
    "indent",
    "load",
    "misprints",
    "read",
    "reference",
    "rewrite",
    "schema",
    "simulate",
    "sweep",
]

HOMES = {
    "diagnose": "derivation",
    "formula": "derivation",
    "formulas": ".formulary",
    "misprints": ".formulary",
    "reference": ".digits",
    "rewrite": ".formulary",
    "sweep": "derivation.sweep",
}
"""The module of each name; the default is `derivation.scene`. The modules of this package have
relative names, because an installed copy is called `platecontact`."""


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("platecontact")
    if name not in __all__:
        from derivation.engine.nearest import did_you_mean

        suggestion = did_you_mean(name, __all__)
        raise AttributeError(
            f"module 'platecontact' has no attribute {name!r}; {suggestion}".rstrip("; ")
        )
    return getattr(import_module(HOMES.get(name, "derivation.scene"), __name__), name)


def __dir__() -> list[str]:
    return sorted(__all__)
