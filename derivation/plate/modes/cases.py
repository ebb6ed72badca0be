"""Hard cases at the switch points of single functions: formulas, modal sums, one plate."""

from collections.abc import Iterator, Mapping
from itertools import chain

from derivation.engine.measure.case import HardCase
from derivation.engine.measure.neighbours import (
    OFFSETS,
    around,
    case_around,
    exact_inputs,
    neighbour,
)
from derivation.engine.rewrite.form import FAR, ONCE
from derivation.mathematics.bessel.oracle import j0_zero
from derivation.plate.blocks import blocks
from derivation.plate.cases.steel import LAM, MU
from derivation.plate.grids import switches
from derivation.plate.modes.kernels.forms import mode_forms
from derivation.plate.oracle import arguments
from generated.contact_series import _ORDINARY, _USUAL

CLOSED, SUMS, PLATES = (
    "switch points of the closed formulas",
    "switch points of the sums over modes",
    "switch points of the contact law",
)

Numbers = float | tuple[float, ...]
_LENGTHS: Mapping[str, Numbers] = {
    "h": 1.0,
    "b": 10.0,
    "R": 3.0,
    "J1": 0.25,
    "lam": LAM,
    "mu": MU,
    "A_j": -1e6,
}
_PLATE: Mapping[str, Numbers] = {**_LENGTHS, "b": 1.0, "a": 0.25, "r": 0.4, "z": 0.01, "h": 0.5}
_AXIS = 2.0**-30
"""phi r below which J1(y)/y is replaced by 1/2, in the modal sums only."""
_DIRECT = 3.9
"""Number of modes of the direct sum times h/b."""

_BY_T = ("G", "G_m", "G_minus_1", "G_slope", "C_top", "C_bottom", "K_j", "K_j_bottom",
         "Omega_1", "Omega_4", "Omega_1_scaled", "Omega_4_scaled")  # fmt: skip
"""Functions with the switch point of sinh^2 T - T^2."""

_BY_X = ("Omega_1", "Omega_2", "Omega_3", "Omega_4")
_SCALED = tuple(f"{name}_scaled" for name in _BY_X)
_FADING = {"G_m": 1.0, "C_bottom": 1.0, "K_j_bottom": 1.0, "G_minus_1": 2.0, "G_slope": 2.0,
           **dict.fromkeys(_BY_X, 0.5)}  # fmt: skip
"""Functions that decay like e^(-rate T), T = 2 phi h, and the rate."""

_DECAY = {0.5: "e^(-T/2)", 1.0: "e^(-T)", 2.0: "e^(-2 T)"}

_OF_SUMS = ("delta", "u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
_MODES = 3


def mode_families() -> Iterator[HardCase]:
    """Yield the hard cases of formulas, of modal sums and of the law of one plate."""
    return chain(_closed(), _mode_shapes(), _sums(), _one_plate())


def _case(
    group: str, kernel: str, why: str, given: Mapping[str, Numbers], modes: int | None = None
) -> HardCase:
    """Return a case with the arguments of its function."""
    own = exact_inputs(**{name: given[name] for name in arguments(kernel)})
    return case_around(group, kernel, why, own, modes)


def _by_depth(kernel: str, T: float, why: str) -> HardCase:
    """Return a case where T = 2 phi h is near a given number, with h = 1."""
    depth = tuple(x / 2 for x in around(T))
    return _case(CLOSED, kernel, why, {**_LENGTHS, "T": around(T), "phi": depth})


def _closed() -> Iterator[HardCase]:
    pair = float(blocks()["sinh_pair"].value.at)
    for kernel in _BY_T:
        why = f"T = {pair:g}, the end of the power series of sinh^2 T - T^2"
        yield _by_depth(kernel, pair, why)
    for kernel, rate in _FADING.items():
        point = int(ONCE) / rate
        why = f"T = {point:g}, above which {_DECAY[rate]} is applied as two factors"
        yield _by_depth(kernel, point, why)
    for kernel in (*_BY_T[:8], *_BY_X, *_SCALED):
        point = float(FAR) * (1 if "T" in arguments(kernel) else 2)
        yield _by_depth(kernel, point, f"T = {point:g}, beyond which the result is constant")


def _mode_shapes() -> Iterator[HardCase]:
    for kernel, (_, form) in mode_forms().items():
        point = float(form.at)
        phi = tuple(x / 2 for x in around(point))
        why = f"T = {point:g}, where power series are replaced by exponentials"
        yield _case(CLOSED, kernel, why, {**_LENGTHS, "z": 0.375, "phi": phi})
        phi = tuple(2 * x for x in around(float(ONCE)))
        why = f"phi (h - z) = {ONCE}, above which e^(-phi (h - z)) is applied as two factors"
        yield _case(CLOSED, kernel, why, {**_LENGTHS, "z": 0.5, "phi": phi})
    why = "lam = mu, where 1 - 2 nu becomes closer to 1 than to 0"
    yield _case(CLOSED, "mode_g", why, {**_LENGTHS, "z": -0.25, "phi": 4.0, "lam": around(MU)})
    point = float(blocks()["sinh_minus"].value.at)
    why = f"phi (h + z) = {point:g}, the end of the power series of sinh u - u"
    phi = tuple(2 * x for x in around(point))
    yield _case(CLOSED, "mode_zz", why, {**_LENGTHS, "z": -0.5, "phi": phi})


def _sums() -> Iterator[HardCase]:
    zero = float(j0_zero(1, 80))
    for kernel in _OF_SUMS:
        for point in switches()["T"]:
            why = f"T = {point:g} of the first mode, where it changes branches"
            h = around(point / (2 * zero))
            yield _case(SUMS, kernel, why, {**_PLATE, "h": h}, _MODES)
        for point in switches()["y"]:
            why = f"y = a phi = {point:g} of the first mode, where the load changes branches"
            yield _case(SUMS, kernel, why, {**_PLATE, "a": around(point / zero)}, _MODES)
    for kernel in ("sigma_rr", "sigma_tt"):
        why = "phi r = 2^-30 of the first mode, below which r = 0 is assumed"
        yield _case(SUMS, kernel, why, {**_PLATE, "r": around(_AXIS / zero)}, _MODES)


def _one_plate() -> Iterator[HardCase]:
    """Yield cases at the limits of the single-point law in plain numbers, and of the direct sum."""
    for points, moved, what in (
        (_ORDINARY, "R", "sphere radius"), (_ORDINARY, "h", "half-thickness"),
    ):  # fmt: skip
        for point in points:
            for offset in OFFSETS:
                x = neighbour(point, offset)
                size = {"R": x, "h": 1.0, "b": 2.0} if moved == "R" else {"R": 1.0, "h": x, "b": x}
                a = 1e-3 * min(size.values())
                given = exact_inputs(a=a, **size)
                cause = f"{offset:+d} ULP from a {what} of {point:g}, beyond which"
                yield HardCase(PLATES, "indentation", f"{cause} factors are scaled.", given)
    for point in _USUAL:
        for offset in OFFSETS:
            h = neighbour(point, offset)
            given = exact_inputs(a=1e-3 * min(h, 1.0), R=50.0, h=h, b=1.0)
            cause = f"{offset:+d} ULP from h/b = {point:g}, beyond which factors are scaled"
            yield HardCase(PLATES, "indentation", f"{cause}.", given)
    count = 30
    for offset in OFFSETS:
        b = neighbour(count / _DIRECT, offset)
        cause = (
            f"{offset:+d} ULP from b = {count / _DIRECT:.4g} h, where the direct sum gets one more "
            "mode"
        )
        given = exact_inputs(a=6.5, R=50.0, h=1.0, b=b)
        yield HardCase(PLATES, "indentation", f"{cause} more.", given)


CASES = mode_families
