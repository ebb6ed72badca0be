"""The effects tables of scenes as the report shows them, by the selection of every simulation."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.report.latex import code, escape, prose
from derivation.scene import explain
from derivation.scene.effects import EFFECTS
from derivation.scene.scene import Scene

HEADS = ("effect", "parameter", "value", "max. change", "status", "reason")
"""Heads of the effects table, shorter than on the screen."""


def effects_context(scenes: Mapping[str, Scene]) -> dict[str, Any]:
    """What effects there are, and what each scene calls for."""
    return {
        "effects": [" & ".join([code(e.name), prose(e.adds), source(e.source)]) for e in EFFECTS],
        "heads": HEADS,
        "scenes": [scene_context(name, scene) for name, scene in scenes.items()],
    }


def scene_context(name: str, scene: Scene) -> dict[str, Any]:
    """The effects table of a scene and the decision in a sentence."""
    found = explain(scene)
    rows = [
        " & ".join(
            [code(effect), code(parameter), *map(cell, (value, bound)), status, prose(reason)]
        )
        for effect, parameter, value, bound, status, reason in found.effects.lines()
    ]
    return {
        "name": name,
        "rows": rows,
        "says": sentence(str(found)),
        "notes": list(found.notes),
    }


def cell(text: str) -> str:
    """A number of the table; small ones as powers of ten."""
    mantissa, e, power = text.partition("e")
    if not (e and power.lstrip("+-").isdigit()):
        return text
    return rf"${mantissa}\cdot10^{{{int(power)}}}$" if int(power) else mantissa


def sentence(text: str) -> str:
    """Words with effects' names in typewriter, and numbers as powers of ten."""
    head, stop, rest = text.partition(". ")
    label, _, names = head.partition(": ")
    shown = ", ".join(code(name) for name in names.split(", "))
    return f"{capital(label)}: {shown}{stop}{prose(rest)}"


def capital(text: str) -> str:
    """A text that begins a sentence."""
    return text[:1].upper() + text[1:]


def source(text: str) -> str:
    """Who derived it."""
    return escape(text)
