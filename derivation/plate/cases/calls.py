"""Functions that hard cases call in a special form, or that state their own errors."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from derivation.engine.measure.kernels import Kernel, Stating
from derivation.plate.budgets import read_budgets, read_stated_limits
from generated import edge_mode_kernels as kernels
from generated import edge_modes, non_hertzian_pressure, sensitivity, simple_impact
from generated.bessel import bessel_j0
from generated.perturbation import PrintedMotion
from generated.plate_waves import branches

_ULP = 2.0**52
"""Smallest number of ULP that corresponds to a relative error of 1."""

_INTEGRALS = 1e-14
"""Stated error of the integrals in `PrintedMotion.corrected`, over the largest indentation."""

_FREQUENCY, _RESIDUE = 8.0, 1e-12 * _ULP
"""Stated errors of `plate_waves`: of a frequency, and of a residue over the largest one [ULP]."""

_SCENE = ("R", "m", "v0", "h", "b", "lam", "mu")


def special_calls() -> tuple[Kernel, ...]:
    """Return functions for non-Hertzian contacts, simple impacts, the paper's motion and waves."""
    error = read_stated_limits("pressure")["error"] * _ULP
    contact = ("a", "R", "h", "b", "modulus")
    motion = ("t", "m", "v0", "xi_2", "xi_3")
    kernels = [
        Kernel("contact", "non_hertzian_pressure", contact, _for_arrays(_contact), error),
        Kernel("pressure", "non_hertzian_pressure", ("r", *contact), _for_arrays(_pressure), error),
        Kernel("corrected", "perturbation", motion, _for_arrays(_corrected), _INTEGRALS * _ULP),
        Kernel(
            "impact_sensitivities", "sensitivity", _SCENE, _sensitivities,
            read_budgets()["impact_sensitivities"].ulp,
        ),
        Stating(
            "plate_of", "simple_impact", ("eta",), _for_arrays(_bend), 0.0,
            stated=_for_arrays(_bend_error)
        ),
    ]  # fmt: skip
    kernels += (*_of_waves(), *_edge_modes())
    for name in ("hertz", "leading"):
        results, errors = _estimates(getattr(simple_impact, name))
        kernels.append(
            Stating(
                name, "simple_impact", _SCENE, _for_arrays(results), 0.0, stated=_for_arrays(errors)
            )
        )
    return tuple(kernels)


def _for_arrays(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of plain numbers as a function of arrays."""

    def call(*arguments: Any) -> Any:
        shape = np.broadcast_shapes(*(np.shape(x) for x in arguments))
        columns = [np.broadcast_to(x, shape).ravel().tolist() for x in arguments]
        rows = np.array([function(*point) for point in zip(*columns, strict=True)])
        results = rows.T.reshape((*rows.shape[1:], *shape))
        return tuple(results) if rows.ndim > 1 else results

    return call


def _contact(a: float, R: float, h: float, b: float, modulus: float) -> tuple[float, ...]:
    contact = non_hertzian_pressure.contact(non_hertzian_pressure.plate(h, b), a, R, modulus)
    numbers = (
        contact.force, contact.indentation, contact.stiffness, contact.slope,
        contact.centre_pressure, contact.mean_pressure,
    )  # fmt: skip
    return tuple(float(x) for x in numbers)


def _pressure(r: float, a: float, R: float, h: float, b: float, modulus: float) -> float:
    return float(
        non_hertzian_pressure.pressure(r, non_hertzian_pressure.plate(h, b), a, R, modulus)
    )


def _corrected(t: float, m: float, v0: float, xi_2: float, xi_3: float) -> float:
    return float(PrintedMotion(m, v0, xi_2, xi_3).corrected(t))


def _sensitivities(*scene: Any) -> Any:
    sensitivities = sensitivity.impact_sensitivities(*scene)
    return sensitivities.reshape(-1, *sensitivities.shape[2:])


def _bend(eta: float) -> float:
    return simple_impact.plate_of(eta).bend


def _bend_error(eta: float) -> float:
    return simple_impact.plate_of(eta).bend_error


def _of_waves() -> list[Kernel]:
    """Return functions of a single wave branch by its index, counted from 0."""
    kernels = []
    for parity in ("antisymmetric", "symmetric"):
        for part, (name, allowed) in enumerate((("frequency", _FREQUENCY), ("residue", _RESIDUE))):
            call = partial(_branch, parity, part)
            arguments = ("x", "nu", "index")
            kernels.append(Kernel(f"{parity}_{name}", "plate_waves", arguments, call, allowed))
    return kernels


def _edge_modes() -> list[Kernel]:
    """Return functions of a single mode of a clamped or supported plate, and of its face."""
    stated_limits = read_stated_limits("edge_modes")
    face = stated_limits.pop("face")
    kernels = [
        Kernel(name, "edge_modes", ("count", "eta", "nu"), _for_arrays(partial(_mode, name)),
               max(stated_limits.values()))
        for name in ("clamped_waves", "supported_waves")
    ]  # fmt: skip
    for name, at in (("wave_shape", "r"), ("wave_mean", "a")):
        call = _for_arrays(partial(_face, name))
        kernels.append(Kernel(name, "edge_modes", ("k", "k2", "t", at), call, face))
    return kernels


def _mode(name: str, count: float, eta: float, nu: float) -> tuple[float, ...]:
    wave_values = getattr(edge_modes, name)(int(count), eta, nu)
    return tuple(float(x[int(count) - 1]) for x in wave_values)


def _face(name: str, k: float, k2: float, t: float, at: float) -> float:
    numbers, none = np.array([[k], [k2], [t]]), np.zeros(1)
    part = kernels.first_part(bessel_j0(numbers[0]), kernels.faded(numbers[1]), numbers[1])
    waves = edge_modes.Waves(
        k=numbers[0], k2=numbers[1], t=numbers[2], c=part, root=none, weight=none, residue=none
    )
    if name == "wave_shape":
        return float(edge_modes.shape(waves, at)[0, 0])
    return float(edge_modes.modal_weights_less_one(waves, at)[0, 0])


def _branch(parity: str, part: int, x: Any, nu: Any, index: Any) -> Any:
    return _table_entries(branches(x, nu, int(np.max(index)) + 1, parity)[part], index)


def _table_entries(table: Any, place: Any) -> Any:
    """Return entries of a table's last axis by index, broadcast with all other axes."""
    index = np.asarray(place, dtype=int)[..., None]
    shape = np.broadcast_shapes(table.shape[:-1], index.shape[:-1])
    wide = np.broadcast_to(table, (*shape, table.shape[-1]))
    return np.take_along_axis(wide, np.broadcast_to(index, (*shape, 1)), axis=-1)[..., 0]


class _Estimates(NamedTuple):
    """The functions for the four results of a simple law and for their stated errors."""

    results: Callable[..., tuple[float, ...]]
    errors: Callable[..., tuple[float, ...]]


def _estimates(law: Callable[..., simple_impact.Estimate | None]) -> _Estimates:
    """Return the results of a simple law and its stated errors; NaN where no bound is proved."""

    def results(*scene: float) -> tuple[float, ...]:
        estimate = law(*scene)
        return (np.nan,) * 4 if estimate is None else estimate[:4]

    def errors(*scene: float) -> tuple[float, ...]:
        estimate = law(*scene)
        if estimate is None:
            return (np.nan,) * 4
        # The stated error is relative to the exact value, which is at least x/(1 + relative).
        relative = sum(estimate[4:])
        return tuple(x * relative / (1 + relative) for x in estimate[:4])

    return _Estimates(results, errors)
