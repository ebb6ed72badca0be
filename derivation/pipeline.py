"""The main job, stage by stage; a stage's result is kept until its sources change.

1 derive     equilibrium equations -> proven formulas
2 rewrite    formulas -> stable forms, proved equal
3 generate   forms -> the NumPy package
4 misprints  printed formulas against derived ones
5 check      generated code against both oracles
6 report     LaTeX, PDF and HTML, in `reporting`
"""

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.derived import formulas
from derivation.emit.standalone import standalone
from derivation.files import PACKAGE, ROOT, expect_writable, measurements, write_file
from derivation.formula.parse import parse
from derivation.measure import bounds, hard_check, speed
from derivation.measure.accuracy import run as accuracy_run
from derivation.measure.check import Progress, Row
from derivation.measure.check import check as measure
from derivation.measure.contact import KERNELS, LIMIT
from derivation.measure.contact import Row as ContactRow
from derivation.measure.contact import check as measure_contact
from derivation.measure.contact_truth import DIGITS
from derivation.measure.hard_record import find_references
from derivation.measure.record import plain, provenance, to_json
from derivation.measure.search import Search, Tell, search
from derivation.measure.search_cases import Book, seconds_of
from derivation.measure.search_targets import targets
from derivation.produce import expect_recordable, folder_for
from derivation.reference import many_costs, many_digits
from derivation.rewrite.account import Account, accounts
from derivation.rewrite.stabilise import Stable, stabilise
from derivation.scene.choice import solve
from derivation.scene.effects import BY_NAME
from derivation.scene.impact import gated, simulate
from derivation.scene.law import WHOLE_PLATE
from derivation.scene.model import NUMBERS, Model, model_of
from derivation.scene.result import Result
from derivation.scene.scene import load, read
from generated import contact_law, impact

REPORTS = ROOT / "reports"
KEPT_EVERY = 20
"""Truths of random scenes after which they are written."""
MEASURED = measurements() / "check.json"
MEASURED_CONTACT = measurements() / "contact.json"
REWRITTEN = measurements() / "rewrite.json"
MEASURED_SPEED = measurements() / "speed.json"
MEASURED_HARD = measurements() / "hard.json"
MEASURED_BOUNDS = measurements() / "bounds.json"
MEASURED_ACCURACY = measurements() / "accuracy.json"
EXAMPLE = PACKAGE / "scene" / "examples" / "paper.toml"


def check(digits: int = 50, record: bool = False, tell: Progress | None = None) -> tuple[Row, ...]:
    """Stage 5: measure the generated package against both oracles; keep the result if asked.

    Raises
    ------
    derivation.reference.routes.OracleError
        If the two oracles contradict each other.
    """
    if record:
        expect_recordable(MEASURED)
    rows = measure(digits, progress=tell)
    if record:
        write_file(MEASURED, to_json(rows, digits))
    return rows


def check_contact(record: bool = False, tell: Progress | None = None) -> tuple[ContactRow, ...]:
    """Measure the contact law, its inversion and the impact against both oracles: minutes.

    Raises
    ------
    derivation.reference.routes.OracleError
        If the two oracles contradict each other.
    """
    if record:
        expect_recordable(MEASURED_CONTACT)
    kernels: dict[str, Callable[..., Any]] = {
        name: impact.impact if name == "impact" else getattr(contact_law, name) for name in KERNELS
    }
    rows = measure_contact(kernels, processes=os.cpu_count() or 1, tell=tell)
    if record:
        text = json.dumps(contact_data(rows), indent=1, sort_keys=True) + "\n"
        write_file(MEASURED_CONTACT, text)
    return rows


def contact_table(rows: tuple[ContactRow, ...]) -> tuple[tuple[str, ...], list[tuple[Any, ...]]]:
    """Columns and cells of the contact law's errors."""
    columns = (
        "kernel",
        "#points",
        "#digits shared",
        "#max",
        "#max ULP",
        "#used",
        "#budget",
        "kept",
    )
    cells = [
        (r.kernel, r.points, r.digits, f"{r.max_error:.2g}", f"{r.double.max_ulp:.3g}",
         f"{r.double.ratio:.2f}", f"{r.budget:g}", r.passed)
        for r in rows
    ]  # fmt: skip
    return columns, cells


def contact_data(rows: tuple[ContactRow, ...]) -> dict[str, Any]:
    """Rows of the contact law as plain data, with what they were measured with."""
    found = plain([asdict(row) for row in rows])
    return {"provenance": provenance(DIGITS), "limit": LIMIT, "rows": found}


def check_hard(record: bool = False, tell: Progress | None = None) -> tuple[hard_check.Row, ...]:
    """Hold generated and printed forms to the hard cases' references.

    These are the committed ones; or found anew where they follow from something else now, which
    takes minutes, and recorded. A run that was stopped goes on where it was.

    Raises
    ------
    FileNotFoundError
        If no references were recorded.
    ValueError
        If a case has none.
    """
    if record:
        expect_recordable(MEASURED_HARD)
    cases, known = hard_check.cases(), hard_check.kernels()
    if not record:
        if not MEASURED_HARD.is_file():
            raise FileNotFoundError(f"no references in {MEASURED_HARD}: run `{hard_check.COMMAND}`")
        truth = hard_check.committed(json.loads(MEASURED_HARD.read_text()), cases)
        return hard_check.check(cases, truth, known)
    folder_for(None, REPORTS)
    part = MEASURED_HARD.with_suffix(".part.json")
    truth = find_references(cases, known, MEASURED_HARD, part, tell)
    rows = hard_check.check(cases, truth, known)
    write_file(MEASURED_HARD, hard_check.to_json(rows))
    part.unlink()
    return rows


def check_speed(record: bool = False, tell: Progress | None = None) -> list[speed.Timing]:
    """Measure the speed of contact law, impact and cold starts on this machine."""
    if record:
        expect_recordable(MEASURED_SPEED)
    examples = sorted(EXAMPLE.parent.glob("*.toml"))
    solved = [path for path in examples if "pressure" in gated(load(path))[1].law.effects]
    timings = speed.measure(examples, solved, tell)
    if record:
        text = json.dumps(speed.as_data(timings), indent=1, sort_keys=True) + "\n"
        write_file(MEASURED_SPEED, text)
    return timings


def check_bounds(
    count: int, record: bool = False, tell: Progress | None = None
) -> tuple[bounds.Row, ...]:
    """Hold the bounds that `simulate` states to the first `count` random scenes.

    Truths that are committed are taken as they are; others are sought, about a second each,
    and if asked kept every few, so that a run that was stopped goes on where it was.
    """
    if record:
        expect_recordable(MEASURED_BOUNDS)
    known = committed_truths()
    found: list[bounds.Truth] = []
    for true in bounds.truths(count, known, tell=tell):
        found.append(true)
        if record and len(found) > len(known) and len(found) % KEPT_EVERY == 0:
            write_file(MEASURED_BOUNDS, bounds.to_json(found, ()))
    rows = bounds.judge(found, _chosen)
    if record:
        write_file(MEASURED_BOUNDS, bounds.to_json(found + known[count:], rows))
    return rows


def committed_truths() -> list[bounds.Truth]:
    """The random scenes' truths that are committed."""
    return bounds.from_json(MEASURED_BOUNDS.read_text()) if MEASURED_BOUNDS.is_file() else []


def _chosen(point: bounds.Point, rtol: float) -> tuple[Sequence[float], str, float]:
    """An impact as `simulate` computes it: results, method and bound."""
    R, m, v0, h, b, lam, mu = point
    values, accuracy = solve(Model(R, m, v0, h, b, lam, mu), rtol)
    return values[:4], accuracy.method, accuracy.bound


def accuracy(
    methods: Sequence[str] = (),
    quick: bool = False,
    scene: Path | None = None,
    out: Path | None = None,
    tell: Progress | None = None,
) -> tuple[dict[str, Any], Path]:
    """Measure what accuracy costs in time, and write it to a file, whole or not at all.

    Raises
    ------
    ValueError
        If a method is unknown, or the scene cannot be used.
    OSError
        If the file cannot be written.
    """
    regime = None
    if scene is not None:
        case = model_of(load(scene))
        regime = accuracy_run.scene_regime(**dict(zip(NUMBERS, case.numbers, strict=True)))
    path = folder_for(None, REPORTS) / "data" / MEASURED_ACCURACY.name if out is None else out
    expect_writable(path)
    data = accuracy_run.measure(methods, quick, regime, tell)
    write_file(path, json.dumps(data, indent=1, sort_keys=True, allow_nan=False) + "\n")
    return data, path


def rewriting(record: bool = False, tell: Progress | None = None) -> tuple[Account, ...]:
    """What the rules did to each formula, measured without and with every one of them."""
    if record:
        expect_recordable(REWRITTEN)
    found = accounts(formulas(), tell)
    if record:
        data = {"rows": plain([asdict(account) for account in found])}
        write_file(REWRITTEN, json.dumps(data, indent=1, sort_keys=True) + "\n")
    return found


def rewritten(text: str, variable: str = "x") -> tuple[Stable, str]:
    """A formula of one's own: its stable form, and that as a NumPy module.

    Raises
    ------
    ValueError
        If the formula cannot be read, or is out of the rules' reach.
    """
    if not variable.isidentifier():
        raise ValueError(f"--variable: expected a name like x, got {variable!r}")
    symbol = sp.Symbol(variable, positive=True)
    stable = stabilise(parse(text, {variable: symbol}), symbol)
    return stable, standalone(stable)


def search_worse(
    duration: str,
    seed: int = 1,
    kernels: Sequence[str] = (),
    out: Path | None = None,
    tell: Tell | None = None,
) -> tuple[Search, Book]:
    """Look for larger errors for some time, and write each new worst case to a file.

    Raises
    ------
    ValueError
        If the duration or a kernel is none, or the file is of another kind.
    """
    seconds, chosen = seconds_of(duration), targets(kernels)
    path = folder_for(None, REPORTS) / "search.toml" if out is None else out
    expect_writable(path)
    book = Book(path, chosen, MEASURED, MEASURED_CONTACT)
    found = search(chosen, seed, seconds, tell=tell, keep=book.keep)
    book.keep(found)
    return found, book


def in_doubles(path: Path) -> Result:
    """The impact of a scene file in doubles by the law that the oracles know.

    That is the whole plate's at rest on the paper's edge, under a rigid paraboloid and Hertz's
    pressure; a warning names what the scene calls for beyond it.

    Raises
    ------
    derivation.scene.scene.SceneError
        If the scene cannot be read or leaves the contact law's range.
    """
    scene = load(path)
    known = {name: name in WHOLE_PLATE for name in BY_NAME if name != "hertz"}
    found = simulate(read(scene.to_json() | {"effects": known}))
    if not model_of(scene).density:  # then whether the plate moves cannot be judged
        at_rest = scene.effects.model_dump() | {"inertia": False}
        scene = read(scene.to_json() | {"effects": at_rest})
    called = sorted(gated(scene)[1].law.effects - WHOLE_PLATE - {"hertz"})
    if not called:
        return found
    text = f"the reference leaves out {', '.join(called)}, which the scene calls for; see `explain`"
    return replace(found, warnings=(*found.warnings, text))


def time_of_reference(known: Result, digits: int) -> str:
    """How long `reference` is going to take, about."""
    seconds = many_costs.expected_seconds(_motion(known), known.max_contact_radius, digits)
    long = f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"
    return f"about {long} on an idle machine"


def reference(known: Result, digits: int, tell: Progress) -> many_digits.Reference:
    """Contact law and impact of a scene to many digits by both oracles.

    Raises
    ------
    ValueError
        If the oracles do not reach so many digits.
    """
    try:
        return many_digits.reference(_motion(known), digits, tell)
    except ArithmeticError as error:  # a ball too wide, a zero not certified, a route astray
        raise ValueError(
            f"an oracle does not reach {digits} digits of this scene ({error}); ask for fewer"
        ) from None


def _motion(known: Result) -> many_costs.Motion:
    m = known.model
    return m.R, m.m, m.v0, m.h, m.b, m.lam, m.mu


def verdict(rows: tuple[Row, ...]) -> list[str]:
    """What a fresh measurement says, and whether it repeats the committed one."""
    failed = [row.kernel for row in rows if row.passed is False]
    lines = [f"beyond their budget: {', '.join(failed)}"] if failed else ["all budgets kept"]
    if MEASURED.is_file():
        kept = {(r["kernel"], r["module"]): r for r in json.loads(MEASURED.read_text())["rows"]}
        fresh = {(r["kernel"], r["module"]): r for r in json.loads(to_json(rows, 50))["rows"]}
        moved = sorted({n for n, m in fresh if fresh[n, m] != kept.get((n, m))})
        if moved:
            lines.append(f"not as committed in {MEASURED.name}: {', '.join(moved)}")
    return lines
