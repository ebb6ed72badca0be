"""Solutions of each case on several meshes and with several time steps, and their record."""

import ast
import hashlib
import json
import platform
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from derivation.checks.finite_elements import cases
from derivation.checks.finite_elements.cases import ElementCase
from derivation.checks.finite_elements.impact import (
    ElementImpact,
    WideContactError,
    results,
    simulate_impact,
)
from derivation.checks.finite_elements.mesh import Grading, contactless_mesh, graded_mesh
from derivation.checks.finite_elements.plate import Plate, System
from derivation.engine.activity import Progress, quiet
from derivation.engine.files import measurements, write_file
from derivation.engine.measure.origin import dump
from derivation.engine.outputs import json_by_line

MEASURED: Path = measurements() / "elastodynamics.json"
RESULTS = (
    "contact_time", "max_indentation", "max_force", "max_contact_radius", "restitution",
    "total_time", "max_tensile_stress",
)  # fmt: skip
REACH_FACTORS = 1.05, 1.25
"""Reach of the fine mesh over the contact radius on a half-space, and the factor by which it is
increased if the contact is wider."""
MAX_DURATION = 300.0
"""Longest duration of an impact over the contact time on a half-space."""
LEAST = {"contact_time": 1e-4, "total_time": 1e-4, "max_force": 1e-4}
"""Smallest error estimates of results that depend on single nodes [1]; for others except the
contact radius `LEAST_ERROR`."""
LEAST_ERROR = 2e-5
FREQUENCIES = 4


@dataclass(frozen=True)
class ElementSetting:
    """Mesh and time steps of a solution.

    Parameters
    ----------
    grading
        Density of the mesh.
    steps
        Number of time steps in the contact time on a half-space.
    """

    grading: Grading
    steps: int


BEST = ElementSetting(Grading(contact=12, far=2.0), 400)
COARSER = ElementSetting(Grading(contact=8, thickness=1.0, far=3.0, edge=1), 400)
LONGER = ElementSetting(BEST.grading, 200)
"""Settings of the recorded solution, of one on a coarser mesh, and of one with longer steps."""
MODAL = ((5, 6), (4, 6), (5, 5))
"""Number of layers towards the edge, where stresses are singular, and polynomial degree: of the
recorded solution, and of two others for the error estimate."""


def solve_impact(
    case: ElementCase, setting: ElementSetting, *, until_end: bool = True
) -> tuple[ElementImpact, float]:
    """Return an impact's results, and half the node distance at the largest contact radius [m]."""
    plate, reach = case.plate, REACH_FACTORS[0] * case.radius
    while True:
        mesh = graded_mesh(plate.radius, plate.thickness, reach, setting.grading)
        system = System(plate, mesh)
        step = case.time / setting.steps
        try:
            history = simulate_impact(
                system, case.sphere, step, MAX_DURATION * case.time, until_end=until_end
            )
        except WideContactError:
            reach *= REACH_FACTORS[1]
            continue
        widest = int(history.width.max())
        apart = float(np.diff(system.contact_radii)[widest - 1])
        return results(history, system), apart / 2.0


def impact_row(case: ElementCase) -> dict[str, Any]:
    """Return the row of an impact: inputs, results and their relative error estimates."""
    best, apart = solve_impact(case, BEST)
    others = [solve_impact(case, setting)[0] for setting in (COARSER, LONGER)]
    errors = {}
    for name in RESULTS:
        value = getattr(best, name)
        changes = sum(abs(getattr(other, name) / value - 1.0) for other in others)
        least = apart / value if name == "max_contact_radius" else LEAST.get(name, LEAST_ERROR)
        errors[name] = float(f"{max(changes, least):.2g}")
    return {
        **inputs(case),
        "parameters": {
            "thickness_over_radius": case.plate.thickness / case.plate.radius,
            "contact_radius_over_thickness": case.radius / case.plate.thickness,
            "contact_time_over_echo": case.time / case.echo,
        },
        "edge_echo": case.edge_echo,
        "elements": {name: float(f"{getattr(best, name):.7g}") for name in RESULTS},
        "errors": errors,
        "contacts": best.contacts,
        "contacts_of_others": [other.contacts for other in others],
        "energy_error": float(f"{best.energy - 1.0:.2g}"),
    }


def inputs(case: ElementCase) -> dict[str, Any]:
    """Return the inputs of an impact as tables of a scene, in SI units."""
    plate, sphere = asdict(case.plate), asdict(case.sphere)
    speed, exact = sphere.pop("speed"), sphere.pop("exact")
    tables = {"sphere": sphere, "plate": plate, "impact": {"speed": speed}}
    return {"name": case.name, "group": case.group, "scene": tables, "spherical_profile": exact}


def plate_row(plate: Plate) -> dict[str, Any]:
    """Return the row of a plate: its lowest natural frequencies omega b/c_S and their errors."""
    rows = []
    for layers, degree in MODAL:
        mesh = contactless_mesh(plate.radius, plate.thickness, layers, degree)
        scale = plate.radius / plate.shear_wave_speed
        rows.append(System(plate, mesh).bending_frequencies(FREQUENCIES) * scale)
    errors = np.sum([np.abs(other / rows[0] - 1.0) for other in rows[1:]], axis=0)
    return {
        **plate_inputs(plate),
        "frequencies": [float(f"{x:.8g}") for x in rows[0]],
        "errors": [float(f"{max(x, 1e-8):.2g}") for x in errors],
    }


def plate_inputs(plate: Plate) -> dict[str, Any]:
    """Return the quantities on which a plate's natural frequencies depend."""
    ratio = plate.thickness / plate.radius
    return {
        "edge": plate.edge,
        "thickness_over_radius": ratio,
        "poissons_ratio": plate.poissons_ratio,
    }


def compute_missing(path: Path = MEASURED, progress: Progress = quiet) -> dict[str, Any]:
    """Compute the cases that are missing from a record or outdated, and return the record.

    The record is written after each case.
    """
    record = read(path)
    version = source_hash()
    known = {_key(row): row for row in record["impacts"] + record["plates"]}
    wanted: list[ElementCase | Plate] = [*cases.impacts(), *cases.plates()]
    impacts: list[dict[str, Any]] = []
    plates: list[dict[str, Any]] = []
    todo = []
    for item in wanted:
        row = known.get(_key(_inputs(item) | {"source": version}))
        if row is None:
            todo.append(item)
        else:
            (impacts if isinstance(item, ElementCase) else plates).append(row)
    for number, item in enumerate(todo):
        progress(item.name if isinstance(item, ElementCase) else "plate", number + 1, len(todo))
        if isinstance(item, ElementCase):
            impacts.append(impact_row(item) | {"source": version})
        else:
            plates.append(plate_row(item) | {"source": version})
        record = {**header(), "impacts": impacts, "plates": plates}
        write_file(path, to_json(record))
    return record


def _inputs(item: ElementCase | Plate) -> dict[str, Any]:
    return inputs(item) if isinstance(item, ElementCase) else plate_inputs(item)


def _key(row: Mapping[str, Any]) -> str:
    """Return the inputs of a row and the hash of the code, as text."""
    names = ("scene", "spherical_profile", "edge", "thickness_over_radius", "poissons_ratio")
    return json.dumps([row.get(name) for name in (*names, "source")])


def header() -> dict[str, Any]:
    """Return the versions of the programs and the settings of the solutions."""
    import scipy

    settings = {"best": BEST, "coarser_mesh": COARSER, "longer_steps": LONGER}
    provenance = {
        "numpy": np.__version__,
        "python": platform.python_version(),
        "scipy": scipy.__version__,
    }
    return {
        "provenance": provenance,
        "settings": {
            name: dict(sorted(asdict(setting).items())) for name, setting in settings.items()
        },
    }


def read(path: Path = MEASURED) -> dict[str, Any]:
    """Return a record, empty if there is none."""
    empty: dict[str, Any] = {"impacts": [], "plates": []}
    if not path.exists():
        return empty
    record: dict[str, Any] = json.loads(path.read_text())
    return empty | record


def to_json(record: Mapping[str, Any]) -> str:
    """Return a record as JSON, one row per line."""
    return json_by_line(record, "impacts", "plates")


def source_hash() -> str:
    """Return a hash of the computing code without docstrings, comments and imports."""
    digest = hashlib.sha256(repr((BEST, COARSER, LONGER, MODAL)).encode())
    for name in ("mesh", "plate", "impact"):
        tree = ast.parse((Path(__file__).parent / f"{name}.py").read_text())
        for node in ast.walk(tree):
            body = getattr(node, "body", None)
            if isinstance(body, list):
                body[:] = [x for x in body if not (_is_text(x) or isinstance(x, ast.ImportFrom))]
        digest.update(dump(tree).encode())
    return digest.hexdigest()[:16]


def _is_text(node: ast.AST) -> bool:
    """Return whether a statement is a docstring."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
