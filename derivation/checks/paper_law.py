"""Impacts by the paper's contact law, the only one with references to many digits."""

from derivation.scene.effects import BY_NAME, EFFECTS, WHOLE_PLATE
from derivation.scene.errors import SceneError
from derivation.scene.impact import selected_effects, simulate
from derivation.scene.model import model_of
from derivation.scene.result import Result
from derivation.scene.scene import Scene, read


def in_doubles(scene: Scene) -> Result:
    """Return the impact of a scene in double precision by the paper's contact law.

    It includes a quasi-static plate with the paper's edge, a rigid paraboloid, Hertz's pressure.

    Raises
    ------
    derivation.scene.scene.SceneError
        If the scene requires an effect that the law does not include, disables an effect of the
        law, or exceeds its range.
    """
    switched = scene.effects.model_dump()
    known = {name: name in WHOLE_PLATE for name in BY_NAME if name != "hertz"}
    missing = sorted(name for name in WHOLE_PLATE if switched[name] is False)
    needed = _needed(scene)
    if missing or needed:
        model = model_of(scene)
        beyond = (e for e in EFFECTS if e.name in known and e.name not in WHOLE_PLATE)
        applied = {
            e.name
            for e in beyond
            if not e.not_applicable_reason(model) and switched[e.name] is not False
        }
        names = sorted({*missing, *needed, *applied})
        lines = [f"{name} = {str(known[name]).lower()}" for name in names]
        parts = [f"requires {', '.join(needed)}"] if needed else []
        parts += [f"disables {', '.join(missing)}"] if missing else []
        raise SceneError(
            "effects: `reference` is available for the paper's contact law only, but this scene "
            f"{' and '.join(parts)}; run `simulate`, or to use the paper's law write below "
            f"[effects] {', '.join(lines)}"
        )
    return simulate(read(scene.to_json() | {"effects": known}))


def _needed(scene: Scene) -> list[str]:
    """Return the required effects that the paper's law does not include."""
    wanted = scene.effects.model_dump()
    if not model_of(scene).density and wanted["inertia"] is not True:
        # Without density it is unknown whether plate inertia matters.
        wanted["inertia"] = False
        scene = read(scene.to_json() | {"effects": wanted})
    return sorted(selected_effects(scene)[1].law.effects - WHOLE_PLATE - {"hertz"})
