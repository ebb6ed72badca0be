"""The example notebook: all cells run, and their outputs have HTML, LaTeX or images."""

import os
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

from derivation.engine.files import ROOT

NOTEBOOK = ROOT / "reports" / "platecontact.ipynb"
RICH = {"text/html", "text/markdown", "text/latex", "image/svg+xml"}


@pytest.fixture(scope="module")
def executed(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """Return the code cells as executed by a new kernel with its settings in another folder."""
    home = tmp_path_factory.mktemp("jupyter")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    variables = ("IPYTHONDIR", "JUPYTER_RUNTIME_DIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR")
    environment = {**os.environ, **dict.fromkeys(variables, str(home)), "PYTHONPATH": str(ROOT)}
    NotebookClient(notebook, timeout=300, startup_timeout=300, kernel_name="python3").execute(
        cwd=str(home), env=environment
    )
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def _shown(cells: list[Any], source: str) -> dict[str, str]:
    """Return the output, by type, of the cell whose last line is `source`."""
    [cell] = [cell for cell in cells if cell.source.splitlines()[-1] == source]
    [output] = cell.outputs
    return dict(output.data)


def test_notebook_is_committed_without_outputs() -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        assert cell.cell_type == "markdown" or (not cell.outputs and cell.execution_count is None)


def test_every_cell_has_one_formatted_output(executed: list[Any]) -> None:
    assert len(executed) > 10
    for cell in executed:
        assert [output.output_type for output in cell.outputs] == ["execute_result"], cell.source
        if "np.round" not in cell.source:  # arrays are shown as text
            assert RICH & set(cell.outputs[0].data), cell.source


@pytest.mark.parametrize(
    ("source", "kind", "expected"),
    [
        ('formula("G")', "text/markdown", ("G(T)", "plate factor of the contact face", "to zero")),
        ('formula("G")', "text/latex", (r"$\displaystyle G(T) = ",)),
        ('formula("K_j").proof', "text/markdown", ("symbolically",)),
        ("scene", "text/html", ("<td>plate</td><td>edge</td><td>simply-supported</td>",)),
        ("explain(scene, rtol=1e-4)", "text/html", ("<td>bending</td>", "tolerance 0.0001")),
        (
            "result",
            "text/html",
            ("contact time", "max tensile stress", "Strength: no failure predicted"),
        ),
        ("result.dynamics", "text/html", ("<th>", "energ")),
        ("result.history()", "text/html", ("plate energy [J]", "12 of 201 times")),
    ],
)
def test_output_of_cells_contains_the_expected_text(
    source: str, kind: str, expected: tuple[str, ...], executed: list[Any]
) -> None:
    shown = _shown(executed, source)[kind]
    assert [text for text in expected if text not in shown] == [], shown


def test_output_of_diagnose_shows_the_correction(executed: list[Any]) -> None:
    [own] = [cell for cell in executed if cell.source.startswith("diagnose(")]
    shown = own.outputs[0].data["text/markdown"]
    assert r"Omega\_3: different" in shown
    assert "phi" in shown
    assert r"\neq" in shown
    assert "given -" in shown
    assert "derived -" in shown


def test_output_of_static_contacts_and_of_generated_code(executed: list[Any]) -> None:
    contacts = _shown(executed, "indent(scene, force=[10, 100, 1000])")["text/html"]
    assert contacts.count("<tr>") == 4
    assert "<td>100</td>" in contacts
    code = _shown(executed, 'Code(scene_code(quasi_static), language="python")')
    assert "def impact(" in code["text/plain"] or "impact" in code["text/html"]


def test_reports_folder_has_one_notebook() -> None:
    assert sorted(path.name for path in Path(NOTEBOOK.parent).glob("*.ipynb")) == [NOTEBOOK.name]
