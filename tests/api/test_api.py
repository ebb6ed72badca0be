"""`import platecontact`: every public name is there, documented, and its examples run."""

import doctest
import importlib
import subprocess
import sys
from pathlib import Path

import platecontact
import pytest


def test_an_installed_copy_needs_no_other_name() -> None:
    """There the package's folder is called `platecontact`, not `derivation/api`."""
    place = Path(platecontact.__file__).parent
    for path in place.glob("*.py"):
        assert "derivation.api" not in path.read_text(), path


def test_names_complete_and_resolve() -> None:
    assert dir(platecontact) == sorted(platecontact.__all__)
    for name in platecontact.__all__:
        assert getattr(platecontact, name).__doc__, name


def test_an_unknown_name_is_no_attribute() -> None:
    with pytest.raises(AttributeError, match="'platecontact' has no attribute 'simulat'"):
        platecontact.simulat  # noqa: B018


@pytest.mark.parametrize("module", ["", ".digits", ".formulary"])
def test_examples_run(module: str) -> None:
    found = doctest.testmod(importlib.import_module(f"platecontact{module}"))
    assert found.attempted > 0
    assert found.failed == 0


@pytest.mark.parametrize("module", ["bodies", "export", "result", "scene"])
def test_examples_of_scenes_run(module: str) -> None:
    found = doctest.testmod(importlib.import_module(f"derivation.scene.{module}"))
    assert found.attempted > 0
    assert found.failed == 0


def test_a_simulation_loads_no_sympy(tmp_path: Path) -> None:
    """From a folder that is not the checkout."""
    program = (
        "import sys, platecontact as pc\n"
        "scene = pc.read({'sphere': {'radius': 0.01, 'material': 'steel'},\n"
        "    'plate': {'radius': 0.3, 'thickness': 0.05, 'material': 'glass'},\n"
        "    'impact': {'speed': 1.0}})\n"
        "assert 0 < pc.simulate(scene).restitution < 1\n"
        "heavy = {'sympy', 'flint', 'mpmath', 'pandas', 'xarray', 'matplotlib'}\n"
        "assert not heavy & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], cwd=tmp_path, check=True)
