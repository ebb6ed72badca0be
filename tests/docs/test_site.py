"""The documentation site: content of its generated parts, and detection of defects by its hooks.

The complete site is built by `.ci/run`, with warnings as errors, because this takes too long here.
"""

import re
import runpy
from pathlib import Path

import numpy as np
import platecontact as pc
import pytest

import generated as package
from derivation.engine.files import ROOT
from derivation.scene.effects import EFFECTS
from derivation.scene.input.materials import MATERIALS
from docs.generators import PARTS, gallery, names, part, used
from docs.generators.sphinx_hooks import escape_bars, far, problems
from generated.manifest import KERNELS

PAGES = {page: page.read_text() for page in sorted((ROOT / "docs").rglob("*.md"))}
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```|`[^`\n]+`", re.MULTILINE | re.DOTALL)


def test_every_part_is_used_once() -> None:
    assert sorted(name for text in PAGES.values() for name in used(text)) == sorted(PARTS)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_between_pages_have_targets(page: Path) -> None:
    for link in LINK.findall(CODE.sub("", PAGES[page])):
        if not re.match(r"https?:|#", link):
            assert (page.parent / link.partition("#")[0]).is_file(), link


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_page_is_in_a_table_of_contents(page: Path) -> None:
    if page.parent != ROOT / "docs":
        assert f"\n{page.stem}\n" in PAGES[page.parent / "index.md"] or page.stem == "index"


def test_scene_keys_equal_those_of_the_model() -> None:
    text = part("scene_keys")
    shown = set(re.findall(r"\{#key-(\w+)-([\w-]+)\}", text))
    for name, table in (("sphere", pc.Sphere), ("plate", pc.Plate), ("accuracy", pc.Accuracy)):
        accepted = {key.replace("_", "-") for key in table.model_fields}
        assert {key for table_name, key in shown if table_name == name} == accepted
    row = next(line for line in text.splitlines() if "{#key-plate-poissons-ratio}" in line)
    assert "> -1, < 0.5" in row
    row = next(line for line in text.splitlines() if "{#key-impact-speed}" in line)
    assert "**required**" in row
    assert "`m/s`" in row


def test_every_effect_and_material_is_described() -> None:
    table, entries, choice = part("effects_table"), part("effects"), part("effect_choice")
    for effect in EFFECTS:
        anchor = f"effect-{effect.name}".replace("_", "-")
        assert f"(#{anchor})" in table
        assert f"(#{anchor})" in choice
        assert f"({anchor})=" in entries
        assert effect.equation in entries
    for name in MATERIALS:
        assert f"| `{name}` |" in part("materials")


def test_every_command_and_function_is_described() -> None:
    commands = part("commands")
    for name in ("simulate", "check hard-cases", "diagnose"):
        assert f"`platecontact {name}`" in commands
        assert f"Usage: platecontact {name} " in commands
    for name in pc.__all__:
        assert re.search(rf"auto\w+:: platecontact\.{name}\b", part("api"))
    assert "autofunction:: generated.contact_law.indentation" in part("functions")
    assert re.search(r"members: .*\bhistory\b.*\bbound_of\b", part("api"))
    assert "members: contact_time" in part("functions")  # of the paper's motion
    for status in ("0", "1", "2"):
        assert f"| `{status}` |" in part("exit_status")


def test_broken_links_and_external_files_are_found(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        '<script src="https://example.org/x.js"></script><p id="here"></p>'
        '<a href="#here"></a><a href="#there"></a><a href="b.html"></a>'
    )
    actual = "\n".join(problems(tmp_path))
    assert len(actual.splitlines()) == 3
    assert all(text in actual for text in ("x.js", "#there", "b.html"))


def test_names_more_than_two_clicks_away_are_found(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text('<a href="a.html"></a><p id="here"></p>')
    (tmp_path / "a.html").write_text('<a href="b.html#two"></a><p id="one"></p>')
    (tmp_path / "b.html").write_text('<p id="two"></p><p id="three"></p>')
    assert list(far(tmp_path, ("here", "one", "two", "three"))) == ["three: more than two clicks"]


def test_index_has_every_name() -> None:
    rows = part("names").splitlines()
    assert any("`plate.loss_factor`](#key-plate-loss-factor)" in row for row in rows)
    for name in ("generated.influence.G", "platecontact.simulate"):
        assert any(f"{{py:obj}}`~{name}`" in row for row in rows)
    shown = {name.rpartition(".")[2] for name in names.anchors() if name.startswith("generated.")}
    assert {kernel["name"] for kernel in KERNELS} <= shown
    assert set(package.__all__) <= shown
    assert len(rows) == 2 + len(list(names.anchors()))


def test_mutually_exclusive_keys_are_stated() -> None:
    text = part("scene_keys")
    assert "Exactly one of these is required: `half_thickness`, or `thickness`." in text


@pytest.mark.parametrize("script", gallery.scripts(), ids=lambda script: script.stem)
def test_figures_have_curves_with_units(script: Path) -> None:
    axes = runpy.run_path(str(script))["figure"].axes
    assert axes
    for panel in axes:
        if panel.get_label() == "<colorbar>":
            assert "[" in panel.get_ylabel()
            continue
        assert all(np.isfinite(line.get_ydata()).all() for line in panel.lines)
        assert panel.lines or panel.collections
        below = panel.get_shared_x_axes().get_siblings(panel)
        assert any("[" in axes.get_xlabel() for axes in below)
        assert "[" in panel.get_ylabel()


def test_gallery_has_at_least_15_figures() -> None:
    assert len(gallery.scripts()) >= 15


def test_vertical_bars_are_escaped_in_docstrings() -> None:
    lines = ["of |F| and |x J_1(x)/J_0(x)|", "    |code|", "``|set|``"]
    escape_bars(None, "", "", None, None, lines)  # type: ignore[arg-type]
    assert lines == ["of ``|F|`` and ``|x J_1(x)/J_0(x)|``", "    |code|", "``|set|``"]
