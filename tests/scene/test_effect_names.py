"""Modules outside `effects` call methods of effects and never compare their names."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import derivation.scene
from derivation.scene.effects import BY_NAME, EFFECTS

SCENE = Path(derivation.scene.__file__).parent
FILES = sorted(path for path in SCENE.rglob("*.py") if path.parent.name != "effects")


def names_used(source: str) -> Iterator[str]:
    """Yield names of effects that are compared, looked up, put in a set or read from `effects`."""
    for node in ast.walk(ast.parse(source)):
        inside: list[ast.AST] = []
        match node:
            case ast.Compare() | ast.Set() | ast.MatchValue():
                inside = [node]
            case ast.Subscript(ctx=ast.Load()):
                inside = [node.slice]
            case ast.Call(func=ast.Name(id="set" | "frozenset") | ast.Attribute(attr="get")):
                inside = list(node.args)
            case ast.Attribute(value=ast.Attribute(attr="effects")) if node.attr in BY_NAME:
                yield node.attr
        for each in inside:
            for leaf in ast.walk(each):
                if isinstance(leaf, ast.Constant) and leaf.value in BY_NAME:
                    yield str(leaf.value)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_names_of_effects_are_not_compared(path: Path) -> None:
    assert list(names_used(path.read_text())) == []


@pytest.mark.parametrize(
    "source",
    [
        '"non_hertzian_pressure" in law.effects',
        'effect.name == "non_hertzian_pressure"',
        'law.effects & {"non_hertzian_pressure", "other"}',
        'PARTS = frozenset(["non_hertzian_pressure"])',
        'BY_NAME["non_hertzian_pressure"]',
        'wanted.get("non_hertzian_pressure")',
        "scene.effects.non_hertzian_pressure is not False",
        'match name:\n    case "non_hertzian_pressure":\n        pass',
    ],
)
def test_comparison_of_a_name_is_found(source: str) -> None:
    assert "non_hertzian_pressure" in names_used(source)


def test_requirements_of_effects_are_effects() -> None:
    for effect in EFFECTS:
        assert effect.contains <= BY_NAME.keys() - {effect.name}
        assert effect.requires <= effect.contains
