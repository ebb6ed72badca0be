"""The index of names: every scene key, effect, function, class and command, with a link."""

from collections.abc import Iterator

import platecontact as pc

from derivation.scene.effects import EFFECTS
from docs.generators import commands, effects, functions, scene_keys
from docs.generators.markdown import table

Row = tuple[str, str, str, str]
"""Name, link, kind or module, and meaning."""


def text() -> str:
    """Return the table of all names in alphabetical order."""
    rows = sorted(rows_of_names(), key=lambda row: (row[0].lower(), row[2]))
    return table(("name", "kind or module", "meaning"), (row[1:] for row in rows))


def rows_of_names() -> Iterator[Row]:
    """Yield a row for each name."""
    for key, meaning in scene_keys.meanings():
        yield key.partition(".")[2], f"[`{key}`](#{_key_anchor(key)})", "scene key", meaning
    for effect in EFFECTS:
        yield effect.name, effects.link(effect), "effect", effect.adds
    for module, names in functions.modules():
        for name in names:
            place = f"generated.{module}.{name}"
            yield name, f"{{py:obj}}`~{place}`", f"`generated.{module}`", functions.summary(place)
    for name in pc.__all__:
        place = f"platecontact.{name}"
        yield name, f"{{py:obj}}`~{place}`", "`platecontact`", functions.summary(place)
    for name, said in commands.summaries():
        yield name, commands.link(name), "command", said


def anchors() -> Iterator[str]:
    """Yield the anchor of each name in the site."""
    yield from (_key_anchor(key) for key, _ in scene_keys.meanings())
    yield from (effects.anchor(effect) for effect in EFFECTS)
    yield from (
        f"generated.{module}.{name}" for module, names in functions.modules() for name in names
    )
    yield from (f"platecontact.{name}" for name in pc.__all__)
    yield from (commands.anchor(name) for name, _ in commands.summaries())


def _key_anchor(key: str) -> str:
    return f"key-{key.replace('.', '-').replace('_', '-')}"
