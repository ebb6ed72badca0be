"""The command `platecontact sweep`: a parameter study, its file, table and figure."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from derivation.commands.options import TOLERANCE, VALUES
from derivation.commands.scenes import SceneFile, check_outputs, title
from derivation.engine.console import NOTES, OUT, Json, progress_bar, warn, write_json_output
from derivation.engine.files import write_file
from derivation.engine.text import paragraph

if TYPE_CHECKING:
    import xarray as xr

    from derivation.sweep.sensitivity import Sensitivities
    from derivation.sweep.store import Store
    from derivation.sweep.study import Study


def sweep(
    scene: SceneFile,
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="TABLE.KEY=VALUES", help=f"Grid of the values {VALUES}; repeatable."),
    ] = None,
    distributions: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.toml",
            help="Sample from the distributions in this file (default: [vary] of the scene).",
        ),
    ] = None,
    sample: Annotated[
        int | None, typer.Option(metavar="N", help="Number of points of the sample.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(metavar="N", help="Random seed of the sample (default: 1).")
    ] = None,
    method: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Sampling: random (default), latin-hypercube or sobol."),
    ] = None,
    sensitivity: Annotated[
        bool,
        typer.Option(
            "--sensitivity", help="Compute sensitivity indices from N (keys + 2) simulations."
        ),
    ] = False,
    rtol: Annotated[
        float | None,
        typer.Option(metavar="X", help=f"Relative tolerance of the results, {TOLERANCE}."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write results: .nc, .zarr, .parquet or .csv."),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw results: .png, .svg or .pdf.")
    ] = None,
    result: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Draw only this result; repeatable."),
    ] = None,
    explain: Annotated[
        bool,
        typer.Option(
            "--explain", help="Show points, effects and estimated time; simulate nothing."
        ),
    ] = False,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="tcp://HOST:PORT", help="Compute on this Dask cluster."),
    ] = None,
    retry: Annotated[
        bool, typer.Option("--retry", help="Repeat points that have no result.")
    ] = False,
    json: Json = None,
) -> None:
    """Simulate a scene at every point of a grid or a sample.

    Example: platecontact sweep scene.toml --vary impact.speed=1:3:9 --out a.csv

    To continue an interrupted study, run the same command again: finished batches are kept in the
    folder FILE.parts next to the file of --out.
    """
    from derivation.scene import SceneError
    from derivation.scene.scene import load_with_distributions
    from derivation.sweep import api, plots
    from derivation.sweep.dataset import check_memory
    from derivation.sweep.study import Study

    folder = out is not None and out.suffix == ".zarr"
    check_outputs(scene, json, plot, out=None if folder else out, distributions=distributions)
    sampling = (distributions, sample, seed, method, sensitivity or None)
    whole, table = load_with_distributions(scene)
    given = vary or _distributions(scene, table, distributions, sample)
    if vary and any(x is not None for x in sampling):
        raise SceneError(
            "--vary defines a grid and cannot be combined with --distributions, --sample, --seed, "
            "--method or --sensitivity; remove --vary, or the other options"
        )
    seed, method = 1 if seed is None else seed, method or "random"
    study = Study(whole, api.make_plan(given, sample, seed, method, sensitivity), rtol)
    api.check(study, out)
    if explain:
        _explain(study, scheduler, json)
        return
    results = plots.check_results(result or [])
    if plot is not None:
        plots.check_plot(len(study.plan.keys), sensitivity)
        check_memory(study, "--plot")
    if sensitivity:
        check_memory(study, "--sensitivity")
    if result and plot is None:
        raise SceneError("--result selects the panels of --plot; add --plot, or remove --result")
    _run(study, out, plot, results, scheduler, retry, sensitivity, json, title(scene))


def _distributions(
    scene: Path, table: Mapping[str, Any], distributions: Path | None, sample: int | None
) -> Any:
    """Return the distributions of a sample: of their file, or else of the scene."""
    from derivation.scene import SceneError
    from derivation.sweep.distributions import distributions_of, load_distributions

    if not (distributions or table) or sample is None:
        raise SceneError(
            "sweep: expected --vary KEY=VALUES for a grid, or --sample N and distributions for a "
            "sample, in a table [vary] of the scene or in a --distributions FILE; add one of the "
            "two"
        )
    if distributions:
        return load_distributions(distributions)
    return distributions_of(table, title(scene))


def _explain(study: "Study", scheduler: str | None, json: str | None) -> None:
    """Show the size of a study and its estimated run time."""
    from derivation.sweep.forecast import forecast

    estimate = forecast(study, 1 if scheduler else os.cpu_count() or 1)
    if write_json_output(estimate.to_json, json):
        OUT.say(estimate.to_text())
    warn([f"some points are rejected: {text}" for text in estimate.rejected])


def _run(
    study: "Study",
    out: Path | None,
    plot: Path | None,
    results: tuple[str, ...],
    scheduler: str | None,
    retry: bool,
    sensitivity: bool,
    json: str | None,
    name: str,
) -> None:
    """Compute a study, write its files, and show a summary."""
    from derivation.sweep import api
    from derivation.sweep.run import compute
    from derivation.sweep.store import open_store
    from derivation.sweep.summary import summary

    with open_store(study, out) as store:
        try:
            with progress_bar("sweep", alike=True) as progress:
                computed = compute(store, os.cpu_count() or 1, scheduler, retry, progress)
                indices = api.write_results(store, out, sensitivity, progress)
        except KeyboardInterrupt:
            _say_how_to_resume(store, out)
            raise
        if plot is not None:
            write_file(plot, _drawing(store, indices, results, plot.suffix))
        answer = summary(store, computed, indices)
    if write_json_output(answer.to_json, json):
        OUT.say(f"Study of {name}\n\n{answer.to_text()}")
    warn(answer.warnings)
    if answer.warned > len(answer.warnings):
        NOTES.say(
            paragraph(
                f"{answer.warned:,} of {answer.points:,} points have warnings or no result; the "
                "column `reason` of --out FILE lists them."
            )
        )


def _drawing(
    store: "Store", indices: "Sensitivities | None", results: tuple[str, ...], suffix: str
) -> bytes:
    """Return the figure of a study as the content of a file."""
    from derivation.sweep import plots
    from derivation.sweep.dataset import data_set

    data: xr.Dataset = data_set(store)
    if indices is not None:
        data = indices.add_to(data)
    return plots.render(data, store.study.plan.keys, results, suffix)


def _say_how_to_resume(store: "Store", out: Path | None) -> None:
    """Print how to continue an interrupted study."""
    if out is None:
        NOTES.say("Nothing was saved; with --out FILE an interrupted study can be continued.")
    else:
        NOTES.say(
            f"{store.done:,} of {store.study.plan.size:,} points are saved in {store.folder}; to "
            "compute the others, run the same command again."
        )
