"""The effects, from what each effect's class says of itself, and what a scene's selection says."""

import inspect
from textwrap import fill

import platecontact as pc

from derivation.engine.files import PACKAGE
from derivation.scene.effects import EFFECTS
from derivation.scene.effects.effect import Effect
from docs.generators.markdown import block, code, table

EXAMPLE = PACKAGE / "scene" / "examples" / "glass_pane.toml"


def anchor(effect: Effect) -> str:
    """Return the name of the target of an effect's section."""
    return f"effect-{effect.name}".replace("_", "-")


def link(effect: Effect) -> str:
    """Return a link to the section of an effect."""
    return f"[`{effect.name}`](#{anchor(effect)})"


def table_rows() -> list[tuple[str, ...]]:
    """Return a row for each effect."""
    return [(link(e), e.adds, code(e.parameter), e.source) for e in EFFECTS]


def all_effects() -> str:
    """Return the table of all effects."""
    return table(("effect", "adds", "parameter", "source"), table_rows())


def entries() -> str:
    """Return a section for each effect, with its equation."""
    parts = []
    for effect in EFFECTS:
        parts += [
            f"({anchor(effect)})=\n## `{effect.name}`",
            f"{_upper(effect.adds)}. {inspect.getdoc(type(effect))}",
            block(effect.equation),
            _facts(effect),
        ]
    return "\n\n".join(parts)


def choice() -> str:
    """Return for each effect how the program selects it, and the consequence of including it."""
    rows = [(link(e), e.adds, code(e.parameter), _rule(e), _consequence(e)) for e in EFFECTS]
    return table(("effect", "adds", "parameter", "selection", "consequence"), rows)


def example() -> str:
    """Return an example scene with the output of `explain`."""
    scene = pc.load(EXAMPLE)
    said = fill(str(pc.explain(scene)), 80)
    return "\n\n".join([block(EXAMPLE.read_text(), "toml"), block(said)])


def _facts(effect: Effect) -> str:
    facts = [f"Parameter: {code(effect.parameter)}", f"Source: {effect.source}"]
    facts.append(f"Selection: {_rule(effect)}")
    if effect.requires:
        facts.append(f"Requires: {_names(effect.requires)}")
    if effect.contains:
        facts.append(f"Its equation contains: {_names(effect.contains)}")
    facts.append(f"Consequence: {_consequence(effect)}")
    return "\n".join(f"- {fact}" for fact in facts)


def _names(names: frozenset[str]) -> str:
    return ", ".join(link(effect) for effect in EFFECTS if effect.name in names)


def _rule(effect: Effect) -> str:
    if effect.always_included:
        return "always included"
    if effect.within:
        return f"by its error bound, as a part of `{effect.within}`"
    return "by its error bound" if effect.selectable else "only if the scene enables it"


def _consequence(effect: Effect) -> str:
    if effect.always_included:
        return "the basis of the contact law"
    facts = {
        "the plate has inertia; static contacts are unaffected": effect.dynamic,
        "acts during an impact only": not effect.static and not effect.dynamic,
        "the pressure follows from an integral equation": effect.solved,
        "the contact loses energy": effect.viscous or effect.plastic,
        "the plate loses energy": effect.damps,
        "changes the contact law": not (
            effect.dynamic or effect.solved or effect.viscous or effect.plastic
        )
        and effect.static,
    }
    return "; ".join(text for text, holds in facts.items() if holds)


def _upper(said: str) -> str:
    return said[0].upper() + said[1:]
