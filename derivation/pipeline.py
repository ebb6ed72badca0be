"""Measurements of the plate code beyond the stages of `derivation.engine.build`."""

import keyword
import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.activity import Tell, quiet
from derivation.engine.bounded import bounded
from derivation.engine.emit.standalone import standalone
from derivation.engine.files import PACKAGE, expect_writable, measurements, write_file
from derivation.engine.formula.parse import FUNCTIONS, FormulaError, parse
from derivation.engine.formula.size import terms_when_expanded
from derivation.engine.formula.vocabulary import NOTHING
from derivation.engine.measure.judge import Errors
from derivation.engine.measure.record import provenance
from derivation.engine.measure.result import CheckResult, all_kept
from derivation.engine.measure.search import Search, search
from derivation.engine.measure.search import Tell as SearchTell
from derivation.engine.measure.search_record import Book, seconds_of
from derivation.engine.outputs import folder_for, plain, recorded_in, sorted_json
from derivation.engine.rewrite.stabilise import Stable, stabilise
from derivation.engine.rewrite.tested import CodeCheck
from derivation.plate.benchmark import run as accuracy_run
from derivation.plate.benchmark import speed, user_calls
from derivation.plate.contact.cases.check import KERNELS, LIMIT, ContactRow
from derivation.plate.contact.cases.check import check as measure_contact
from derivation.plate.contact.cases.truth import DIGITS
from derivation.plate.impact.oracle import many_digits
from derivation.plate.judge import PACKAGE as GENERATED
from derivation.plate.paper import PAPER
from derivation.plate.search.targets import recorded, targets
from derivation.scene.effects import BY_NAME, EFFECTS, WHOLE_PLATE
from derivation.scene.impact import selected_effects, simulate
from derivation.scene.model import NUMBERS, model_of
from derivation.scene.result import Result
from derivation.scene.scene import Scene, SceneError, load, read
from generated import contact_law, impact

MAX_TERMS = 5000
"""Largest number of terms of an expanded formula that can be rewritten."""
REWRITE_SECONDS = 30
"""Largest processor time [s] for rewriting a formula."""
MEASURED_CONTACT = measurements() / "contact.json"
MEASURED_SPEED = measurements() / "speed.json"
MEASURED_ACCURACY = measurements() / "accuracy.json"
EXAMPLE = PACKAGE / "scene" / "examples" / "paper.toml"


def check_contact(progress: Tell = quiet) -> CheckResult:
    """Compare contact law, its inversion and impact with both references; takes minutes.

    Raises
    ------
    derivation.engine.oracle.agreement.OracleError
        If the two references contradict each other.
    """
    kernels: dict[str, Callable[..., Any]] = {
        name: impact.impact if name == "impact" else getattr(contact_law, name) for name in KERNELS
    }
    rows = measure_contact(kernels, processes=os.cpu_count() or 1, tell=progress)
    cells = [
        (r.kernel, r.points, r.digits, f"{r.max_error:.2g}", f"{r.double.max_ulp:.3g}",
         f"{r.double.ratio:.2f}", f"{r.budget:g}", r.passed)
        for r in rows
    ]  # fmt: skip
    return CheckResult(
        "Errors of the contact law",
        (
            "function",
            "#points",
            "#agreeing digits",
            "#max error",
            "#max ULP",
            "#fraction of budget",
            "#budget",
            "passed",
        ),
        cells,
        lambda: contact_data(rows),
        all(row.passed for row in rows),
        listings=[("Worst arguments", [f"{r.kernel}: {' '.join(r.worst)}" for r in rows])],
        budgeted=rows,
    )


def contact_data(rows: tuple[ContactRow, ...]) -> dict[str, Any]:
    """Return the rows of the contact law as plain data, with their provenance."""
    found = [
        asdict(row) | {"double": _short(row.double), "single": row.single and _short(row.single)}
        for row in rows
    ]
    return {"provenance": provenance(DIGITS, GENERATED), "limit": LIMIT, "rows": plain(found)}


def _short(errors: Errors) -> dict[str, Any]:
    """Return the recorded part of the errors of a function in a format."""
    kept = ("points", "max_ulp", "needed", "ratio", "dtype")
    worst = [exact for _, exact, _ in errors.worst.arguments]
    return {name: getattr(errors, name) for name in kept} | {"worst": worst}


def check_speed(progress: Tell = quiet) -> CheckResult:
    """Measure run times of contact law, impact and start of the program on this machine."""
    examples = sorted(EXAMPLE.parent.glob("*.toml"))
    solved = [path for path in examples if selected_effects(load(path))[1].law.solved]
    timings = speed.measure(examples, solved, progress, user_calls.planned())
    columns = ("measurement", "#measured", "#limit", "passed")
    cells = [(t.name, f"{t.value:.3g} {t.unit}", f"{t.limit:g}", t.kept) for t in timings]
    return CheckResult(
        "Run times", columns, cells, lambda: speed.as_data(timings), all_kept(timings)
    )


def accuracy(
    methods: Sequence[str] = (),
    quick: bool = False,
    scene: Path | None = None,
    out: Path | None = None,
    progress: Tell = quiet,
    update: bool = False,
) -> tuple[dict[str, Any], Path | None]:
    """Measure accuracy against run time, and write the result to a file if one is given.

    Parameters
    ----------
    methods
        Families of methods; all if empty.
    quick
        Whether to run fewer methods and rounds.
    scene
        A scene file instead of the paper's case.
    out
        File for the result.
    progress
        Called at each step.
    update
        Whether to replace the project's committed measurement.

    Raises
    ------
    ValueError
        If a method is unknown, the scene cannot be used, or `update` is combined with other
        options.
    OSError
        If the file cannot be written.
    """
    if update and (methods or scene is not None or out is not None):
        raise ValueError(
            "--update replaces the whole committed measurement and cannot be combined with "
            "--method, --scene or --out; remove --update, or these options"
        )
    path = recorded_in(MEASURED_ACCURACY, update, out)
    regime = None
    if scene is not None:
        case = model_of(load(scene))
        regime = accuracy_run.scene_regime(**dict(zip(NUMBERS, case.numbers, strict=True)))
    data = accuracy_run.measure(methods, quick, regime, progress)
    if path is not None:
        write_file(path, sorted_json(data))
    return data, path


def rewritten(text: str, variable: str = "x") -> tuple[Stable, str, CodeCheck]:
    """Return the stable form of a formula, its NumPy module, and the result of testing it.

    Raises
    ------
    ValueError
        If the formula cannot be read, no rule applies, or it needs too much time or memory.
    """
    if not variable.isidentifier() or keyword.iskeyword(variable) or variable in FUNCTIONS:
        raise ValueError(
            f"--variable: expected a name such as x, got {variable!r}; use another name"
        )
    symbol = sp.Symbol(variable, positive=True)

    def work() -> tuple[Stable, str, CodeCheck]:
        expression = parse(text, NOTHING, {variable: symbol})
        if terms_when_expanded(expression) > MAX_TERMS:
            raise FormulaError(
                f"the formula has more than {MAX_TERMS} terms when expanded; simplify it"
            )
        stable = stabilise(expression, symbol)
        return stable, *standalone(stable)

    return bounded(work, "rewriting the formula", REWRITE_SECONDS)


def search_worse(
    duration: str,
    seed: int = 1,
    functions: Sequence[str] = (),
    out: Path | None = None,
    progress: SearchTell | None = None,
) -> tuple[Search, Book]:
    """Search for larger errors for some time, and write each new worst case to a file.

    Raises
    ------
    ValueError
        If the duration or a function name is invalid, or the file contains something else.
    """
    seconds, chosen = seconds_of(duration), targets(functions)
    path = folder_for(None, PAPER.report_folder) / "search.toml" if out is None else out
    expect_writable(path)
    book = Book(path, chosen, *recorded(PAPER.measured, MEASURED_CONTACT))
    found = search(chosen, seed, seconds, tell=progress, keep=book.keep)
    book.keep(found)
    return found, book


def in_doubles(scene: Scene) -> Result:
    """Return the impact of a scene in double precision by the law of the references.

    That is the paper's law: a quasi-static plate with the paper's edge, a rigid paraboloid and
    Hertz's pressure.

    Raises
    ------
    derivation.scene.scene.SceneError
        If the scene requires an effect beyond that law, disables one of it, or exceeds its range.
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
    """Return the effects beyond the paper's law that the scene or its tolerance requires."""
    wanted = scene.effects.model_dump()
    if not model_of(scene).density and wanted["inertia"] is not True:
        # Without density it is unknown whether plate inertia matters.
        wanted["inertia"] = False
        scene = read(scene.to_json() | {"effects": wanted})
    return sorted(selected_effects(scene)[1].law.effects - WHOLE_PLATE - {"hertz"})


def time_of_reference(known: Result, digits: int) -> str:
    """Return the estimated run time of `reference`, in words."""
    seconds = many_digits.expected_seconds(_motion(known), known.max_contact_radius, digits)
    time = f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"
    return f"estimated time: about {time} on an idle machine"


def reference(known: Result, digits: int, progress: Tell) -> many_digits.ImpactReference:
    """Return contact law and impact of a scene to many digits, by both references.

    Raises
    ------
    ValueError
        If the references do not reach this number of digits.
    """
    try:
        return many_digits.reference(_motion(known), digits, progress)
    except ArithmeticError as error:  # an interval too wide, a zero not certified, no convergence
        raise ValueError(
            f"--digits: {digits} digits cannot be reached for this scene ({error}); use fewer"
        ) from None


def _motion(known: Result) -> many_digits.Motion:
    m = known.model
    return m.R, m.m, m.v0, m.h, m.b, m.lam, m.mu
