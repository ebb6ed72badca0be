"""A study: scene, points and tolerance, with the hash that identifies them."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.metadata import version
from typing import Any

import numpy as np

from derivation.scene.scene import Scene
from derivation.sweep.plan import Column, Plan


@cache
def installed_version() -> str:
    """Return the version of the program, which is read from a file."""
    return version("platecontact")


@dataclass(frozen=True)
class Study:
    """A scene, the points at which it is simulated, and the tolerance.

    Attributes
    ----------
    scene
        The scene; varied keys take other values.
    plan
        The points.
    rtol
        Relative tolerance of the results [1], as for `simulate`.
    """

    scene: Scene
    plan: Plan
    rtol: float | None

    @cached_property
    def base(self) -> dict[str, Any]:
        """Data common to all points: scene, tolerance and program version."""
        common = {"scene": self.scene.to_json(), "rtol": self.rtol}
        return common | {"version": installed_version()}

    def to_json(self) -> dict[str, Any]:
        """Return scene, tolerance, program version and points as JSON data."""
        return self.base | {"plan": self.plan.to_json()}

    @cached_property
    def _common(self) -> bytes:
        return _canonical(self.base)

    def points_hash(self, columns: Mapping[str, Column]) -> str:
        """Return the hash of scene, tolerance, version and the values of some points, in order."""
        digest = hashlib.sha256(self._common)
        for key, values in columns.items():
            digest.update(key.encode() + b"\0")
            names = values.dtype.kind == "U"
            digest.update(
                json.dumps(values.tolist()).encode()
                if names
                else np.ascontiguousarray(values, dtype="<f8").tobytes()
            )
        return digest.hexdigest()[:20]

    @cached_property
    def name(self) -> str:
        """Hash of the whole study."""
        return hashlib.sha256(_canonical(self.to_json())).hexdigest()


def _canonical(data: dict[str, Any]) -> bytes:
    return json.dumps(data, sort_keys=True, separators=(",", ":")).encode()
