"""The command `platecontact`: each command unpacks its arguments and makes one call.

Exit status: 0 fine, 1 a check failed or formulas differ, 2 bad input.
"""

import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.exceptions import TyperException
from typer.main import get_command

from derivation.scene import commands as scene_commands
from derivation.screen import NOTES, OUT, clocked, counted, listing, put_json, stage, table

app = typer.Typer(
    no_args_is_help=True,
    add_completion=True,
    rich_markup_mode=None,
    help="Derive, generate, check and report the contact law of a sphere on an elastic plate.",
)

Json = Annotated[
    str | None, typer.Option("--json", metavar="FILE|-", help="Write the result as JSON.")
]
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Write here instead of the checkout.")
]


@app.command()
def derive(json: Json = None) -> None:
    """Derive every formula from the equilibrium equations and show how it was proved.

    Example: platecontact derive --json formulas.json
    """
    from derivation import derived

    with stage("derive"):
        found = derived.formulas()
    if json != "-":
        rows = [(f.name, f.unit, f.equation, f.proof.step, f.proof.method) for f in found.values()]
        table("Derived formulas", ("formula", "unit", "equation", "proof", "decided"), rows)
    if json:
        put_json([formula.to_json() for formula in found.values()], json)


@app.command()
def generate(
    check: Annotated[
        bool, typer.Option("--check", help="Compare only: show what differs, write nothing.")
    ] = False,
    out: Out = None,
) -> None:
    """Write the NumPy package `generated`, or check that it is fresh.

    Example: platecontact generate --out mypackage/plate
    """
    from derivation import produce

    if check:
        with stage("compare"):
            freshness = produce.check_generated(out)
        OUT.print(str(freshness), markup=False, highlight=False, soft_wrap=True)
        raise typer.Exit(0 if freshness.fresh else 1)
    with stage("derive and generate"):
        written = produce.generate(out)
    NOTES.print(f"{len(written)} files in {written[0].parent}")


@app.command()
def misprints(json: Json = None) -> None:
    """Compare the paper's printed formulas with the derived ones and diagnose what differs.

    Example: platecontact misprints --json -
    """
    from derivation import derived

    with stage("compare printed with derived"):
        findings = derived.misprints()
    if json != "-":
        rows = [(f.printed.equation, f.printed.name, f.diagnosis.kind, f.repair) for f in findings]
        table("Printed against derived", ("equation", "formula", "finding", "repair"), rows)
    if json:
        put_json([finding.to_json() for finding in findings], json)


@app.command()
def check(
    digits: Annotated[int, typer.Option(min=20, max=1000, help="Digits of the reference.")] = 50,
    record: Annotated[
        bool, typer.Option("--record", help="Keep the result as reports/data/check.json.")
    ] = False,
    contact: Annotated[
        bool, typer.Option("--contact", help="Measure contact law and impact instead: minutes.")
    ] = False,
    speed: Annotated[
        bool, typer.Option("--speed", help="Measure speed instead, on this machine.")
    ] = False,
    hard: Annotated[
        bool, typer.Option("--hard", help="Check the hard cases instead: seconds.")
    ] = False,
    bounds: Annotated[
        int | None,
        typer.Option("--bounds", metavar="N", min=1, help="Hold stated bounds to N scenes."),
    ] = None,
    propose: Annotated[
        bool, typer.Option("--propose", help="Print tighter error budgets; write nothing.")
    ] = False,
    search: Annotated[
        str | None,
        typer.Option("--search", metavar="60s|5m|1h", help="Look for worse, for so long."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the search, which repeats by it.")] = 1,
    kernel: Annotated[
        list[str] | None, typer.Option("--kernel", metavar="NAME", help="Search this one only.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write searched cases here.")
    ] = None,
    json: Json = None,
) -> None:
    """Measure every generated function against both oracles.

    Example: platecontact check --digits 100
    """
    from derivation import pipeline
    from derivation.measure.record import COLUMNS, as_data, cells, passed, worst

    if search is not None:
        if contact or speed or hard or bounds or record or propose:
            raise ValueError("--search stands alone: expected no other of check's options")
        raise typer.Exit(_check_search(search, seed, kernel or [], out, json))
    if contact + speed + hard + bool(bounds) > 1:
        raise ValueError(
            "expected one of --contact, --speed, --hard and --bounds: run them one after the other"
        )
    if kernel or out:
        raise ValueError("--kernel and --out belong to --search: add --search 60s")
    if contact:
        raise typer.Exit(_check_contact(record, json, propose))
    if speed:
        raise typer.Exit(_check_speed(record, json))
    if hard:
        raise typer.Exit(_check_hard(record, json))
    if bounds:
        raise typer.Exit(_check_bounds(bounds, record, json))
    with counted("check") as tell:
        rows = pipeline.check(digits, record, tell)
    if json != "-":
        table(f"Errors against {digits} digits", COLUMNS, [cells(row) for row in rows])
        listing("Worst arguments", [worst(row) for row in rows if row.passed is not None])
    if json:
        put_json(as_data(rows, digits), json)
    if propose:
        _propose(rows)
    raise typer.Exit(0 if passed(rows) else 1)


def _propose(rows: Sequence[Any]) -> None:
    """Print the tighter budgets that a check's rows allow."""
    from derivation.measure.propose import proposals

    lines = proposals(rows) or ["# no budget can be tighter"]
    OUT.print("\n".join(lines), markup=False, highlight=False, soft_wrap=True)


def _check_contact(record: bool, json: str | None, propose: bool) -> int:
    """Measure contact law and impact; returns the exit status."""
    from derivation import pipeline

    with counted("check") as tell:
        rows = pipeline.check_contact(record, tell)
    if json != "-":
        columns, cells = pipeline.contact_table(rows)
        table("Errors of the contact law", columns, cells)
        listing("Worst arguments", [f"{r.kernel}: {' '.join(r.worst)}" for r in rows])
    if json:
        put_json(pipeline.contact_data(rows), json)
    if propose:
        _propose(rows)
    return 0 if all(r.passed for r in rows) else 1


def _check_hard(record: bool, json: str | None) -> int:
    """Check the hard cases; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.hard_check import COLUMNS, as_data, cells

    with counted("check") as tell:
        rows = pipeline.check_hard(record, tell)
    failed = [row for row in rows if not row.kept]
    if json != "-":
        table("Hard cases, errors in ULP", COLUMNS, [cells(row) for row in rows])
        listing(
            f"{len(rows)} cases, {len(failed)} failed",
            [f"{row.case.key}: {row.problem}" for row in failed],
        )
    if json:
        put_json(as_data(rows), json)
    return 1 if failed else 0


def _check_bounds(count: int, record: bool, json: str | None) -> int:
    """Hold stated error bounds to random scenes; returns the exit status."""
    from derivation import pipeline

    with counted("check") as tell:
        rows = pipeline.check_bounds(count, record, tell)
    if json != "-":
        cells = [
            (r.method, r.runs, f"{r.ratio:.3f}", f"{r.error:.2g}", f"{r.bound:.2g}", r.quantity)
            for r in rows
        ]
        heads = ("method", "#runs", "#worst error/bound", "#error", "#bound", "of")
        table(f"Stated bounds in {count} scenes", heads, cells)
    if json:
        put_json([asdict(row) for row in rows], json)
    return 0 if all(row.kept for row in rows) else 1


def _check_speed(record: bool, json: str | None) -> int:
    """Measure times; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.speed import as_data

    with counted("check") as tell:
        timings = pipeline.check_speed(record, tell)
    if json != "-":
        cells = [(t.name, f"{t.value:.3g} {t.unit}", f"{t.limit:g}", t.kept) for t in timings]
        table("Speed", ("what", "#measured", "#promise", "kept"), cells)
    if json:
        put_json(as_data(timings), json)
    return 0 if all(t.kept for t in timings) else 1


def _check_search(
    duration: str, seed: int, kernels: list[str], out: Path | None, json: str | None
) -> int:
    """Look for larger errors; returns the exit status."""
    from derivation import pipeline
    from derivation.measure.search_cases import COLUMNS, arguments, as_data, cells, kept

    with clocked("search") as tell:
        found, book = pipeline.search_worse(duration, seed, kernels, out, tell)
    if json != "-":
        table(f"Search, seed {seed}", COLUMNS, [cells(k, found, book) for k in found.standings])
        listing("Worst arguments", [arguments(k, found) for k in found.standings])
    if json:
        put_json(as_data(found), json)
    if book.written:
        NOTES.print(f"new worst cases in {book.path}", markup=False, soft_wrap=True)
    return INTERRUPTED if found.interrupted else 0 if kept(found) else 1


@app.command()
def accuracy(
    quick: Annotated[bool, typer.Option("--quick", help="Fewer methods and rounds.")] = False,
    method: Annotated[
        list[str] | None,
        typer.Option("--method", metavar="NAME", help="Measure this family only; repeatable."),
    ] = None,
    scene: Annotated[
        Path | None,
        typer.Option("--scene", metavar="FILE", help="A scene instead of the paper's case."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="FILE", help="Write here instead of reports/data/accuracy.json."
        ),
    ] = None,
) -> None:
    """Measure what each digit costs in time with every method: minutes.

    Example: platecontact accuracy --quick --out accuracy.json
    """
    from derivation import pipeline
    from derivation.measure.accuracy.summary import COLUMNS, cells, headline

    with counted("accuracy") as tell:
        data, path = pipeline.accuracy(method or (), quick, scene, out, tell)
    table("Cheapest methods in arrays", COLUMNS, cells(data))
    OUT.print(headline(data), markup=False, highlight=False, soft_wrap=True)
    NOTES.print(f"written to {path}", markup=False, soft_wrap=True)


@app.command()
def rewrite(
    formula: Annotated[
        str, typer.Argument(help="A formula of one variable; none for the paper's own.")
    ] = "",
    variable: Annotated[str, typer.Option(help="Its variable, positive.")] = "x",
    record: Annotated[
        bool, typer.Option("--record", help="Keep the paper's as reports/data/rewrite.json.")
    ] = False,
    json: Json = None,
) -> None:
    """Find a stable form of a formula and print it as NumPy, or say what was done to the paper's.

    Example: platecontact rewrite "(x - sin(x))/x**3"
    """
    from derivation import pipeline
    from derivation.measure.record import plain

    if formula:
        with stage("rewrite"):
            stable, source = pipeline.rewritten(formula, variable)
        found = [("", applied) for applied in stable.applied]
        data: object = {"source": source, "applied": [asdict(a) for a in stable.applied]}
    else:
        with counted("rewrite") as tell:
            accounts = pipeline.rewriting(record, tell)
        found = [(account.name, applied) for account in accounts for applied in account.applied]
        data, source = {"rows": [asdict(account) for account in accounts]}, ""
    if json != "-":
        rows = [
            (name, a.rule, a.cause, *(f"{x:.3g}" for x in (*a.operations, *a.worst)))
            for name, a in found
        ]
        heads = ("formula", "rule", "against", "#operations", "#with it", "#worst ULP", "#with it")
        table("Without and with each rule", heads, rows)
        OUT.print(source, markup=False, highlight=False, soft_wrap=True)
    if json:
        put_json(plain(data), json)


@app.command()
def report(
    pdf: Annotated[bool, typer.Option("--pdf/--no-pdf", help="Compile the PDF too.")] = True,
    check: Annotated[
        bool, typer.Option("--check", help="Compare the committed .tex only, write nothing.")
    ] = False,
    out: Out = None,
) -> None:
    """Write the LaTeX report and compile it.

    Example: platecontact report --no-pdf
    """
    from derivation import pipeline

    if check:
        with stage("compare"):
            freshness = pipeline.check_report(out)
        OUT.print(str(freshness), markup=False, highlight=False, soft_wrap=True)
        raise typer.Exit(0 if freshness.fresh else 1)
    with stage("report"):
        written = pipeline.report(out, pdf)
    NOTES.print("\n".join(str(path) for path in written), markup=False)


@app.command()
def build(out: Out = None) -> None:
    """Run the main job: derive, generate, find misprints, check, report.

    Example: platecontact build
    """
    from derivation import derived, produce

    with stage("derive"):
        derived.chain()
    with stage("rewrite"):
        produce.forms()
    with stage("generate"):
        produce.generate(out / "generated" if out else None)
    with stage("misprints"):
        derived.misprints()
    # Only now, as these import what has just been generated.
    from derivation import pipeline
    from derivation.measure.record import passed
    from derivation.report.pdf import TexError

    with counted("check") as tell:
        rows = pipeline.check(tell=tell)
    with stage("report"):
        try:
            pipeline.report(out / "reports" if out else None)
        except TexError as error:
            NOTES.print(f"no PDF: {error}", markup=False, highlight=False)
    for line in pipeline.verdict(rows):
        NOTES.print(line, markup=False, highlight=False)
    raise typer.Exit(0 if passed(rows) else 1)


@app.command()
def diagnose(
    name: Annotated[str, typer.Argument(help="Quantity, for instance K_j.")],
    formula: Annotated[str, typer.Option(help="Your formula for it, in SymPy syntax.")],
    latex: Annotated[bool, typer.Option("--latex", help="The formula is LaTeX.")] = False,
    at: Annotated[
        str, typer.Option(metavar="phi=2.5,h=0.1,...", help="Point to evaluate both at.")
    ] = "",
    digits: Annotated[int, typer.Option(min=1, max=1000, help="Digits of the values.")] = 50,
    json: Json = None,
) -> None:
    """Compare a formula of your own with the derived one; exit status 1 if they differ.

    Example: platecontact diagnose G --formula "1 + 4*T*(1+T)*exp(-2*T)" --at T=3
    """
    from derivation import derived

    with stage("compare"):
        found = derived.diagnose(name, formula, latex, at, digits)
    if json != "-":
        rows = [(key, value) for key, value in found.to_json().items() if value is not None]
        table(f"{name}: {found.verdict}", ("what", "value"), rows)
    if json:
        put_json(found.to_json(), json)
    raise typer.Exit(0 if found.verdict == "equal" else 1)


@app.command()
def reference(
    scene: scene_commands.SceneFile,
    digits: Annotated[int, typer.Option(min=1, max=1000, help="Digits of every number.")] = 50,
    json: Json = None,
) -> None:
    """Give contact law and impact of a scene file to many digits, by both oracles.

    The scene's numbers are taken as the exact doubles they are read as. Exit status 1 if the
    oracles differ.

    Example: platecontact reference scene.toml --digits 100
    """
    from derivation import pipeline

    scene_commands.check_outputs(scene, json)
    known = pipeline.in_doubles(scene)
    scene_commands.warn(known.warnings)
    NOTES.print(pipeline.time_of_reference(known, digits), highlight=False)
    with counted("reference") as tell:
        found = pipeline.reference(known, digits, tell)
    if json != "-":
        listing(f"{scene.name} to {digits} digits, its numbers being exact doubles", found.lines())
    if json:
        put_json(found.to_json(), json)
    raise typer.Exit(0 if found.agrees else 1)


app.command()(scene_commands.simulate)
app.command()(scene_commands.indent)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; every error a user can cause is one message and status 2."""
    command = get_command(app)
    try:
        status = command(args=argv, prog_name="platecontact", standalone_mode=False)
    except TyperException as error:
        advice = "see `platecontact --help`"
        NOTES.print(f"platecontact: {error.format_message()} ({advice})", markup=False)
        return 2
    except (OSError, ValueError) as error:
        NOTES.print(f"platecontact: {error}", markup=False, highlight=False, soft_wrap=True)
        return 2
    if status == INTERRUPTED:
        NOTES.print("platecontact: interrupted; no file is half-written, so simply run it again")
        return 2
    return int(status or 0)


INTERRUPTED = 130
"""What typer returns after Ctrl-C."""

if __name__ == "__main__":
    sys.exit(main())
