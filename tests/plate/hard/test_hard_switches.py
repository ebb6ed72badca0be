"""Test that hard cases are close to both sides of each comparison in generated code."""

import importlib
import pkgutil
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from switches import Watch, watched

import generated
from derivation.engine.measure.case import HardCase, call_arguments
from derivation.engine.measure.kernels import Kernel
from derivation.engine.measure.suite import Suite

CLOSE = 1e-12
"""Largest relative difference of two compared numbers that counts as close to a switch."""

GUARD = "a test for input outside the domain, or for a state that no input causes"
LOOP = "keeps an iteration within its bracket"
LAST = "ends an iteration, whose last step is always far below the limit"
ELSEWHERE = "other tests have cases on both sides, the hard cases do not"
SIZES = "sizes of arrays; `test_prepared_plate` and `test_impact_batches` have both sides"
ARRAY = "beyond this limit, the code for arrays computes a single number"
INTEGER = "tests whether an index is an integer"
MAY_LACK_CASES: Mapping[str, tuple[int, str]] = {
    "back_face._evaluated": (1, GUARD),
    "contact_domain._repeats": (2, SIZES),
    "contact_domain.elastic": (1, GUARD),
    "contact_domain.plates_of_lengths": (2, GUARD),
    "contact_points.pieces": (3, SIZES),
    "contact_series._beyond": (1, GUARD),
    "contact_series.correction": (1, "only the code for a single sphere has cases on both sides"),
    "edge_modes._below_cutoff": (3, LOOP),
    "edge_modes._solved": (3, LOOP),
    "edge_modes._within": (2, GUARD),
    "edge_modes.supported_waves": (1, "no modes are requested"),
    "edge_sums.blocks_of_modes": (1, "compares integers"),
    **dict.fromkeys(("impact._deepest", "impact._far_deepest", "impact._state"), (1, LAST)),
    "impact._solve": (4, GUARD),
    "non_hertzian_pressure._contact": (1, ELSEWHERE),
    "non_hertzian_pressure.contact": (6, GUARD),
    "non_hertzian_pressure.plate": (4, GUARD),
    "non_hertzian_pressure.pressure": (1, GUARD),
    "perturbation._eta": (1, ELSEWHERE),
    "perturbation.last": (1, GUARD),
    "perturbation.printed_motion": (4, GUARD),
    "plate_arrays._at": (1, SIZES),
    "plate_arrays._contact": (1, GUARD),
    "plate_arrays._indentations": (2, GUARD),
    "plate_arrays._plate_by_plate": (2, SIZES),
    "plate_points._contact": (3, ARRAY),
    "plate_points._modulus": (4, ARRAY),
    "plate_points._ordinary": (4, ARRAY),
    "plate_points.indentation": (1, ARRAY),
    "plate_points.stiffness": (1, ARRAY),
    "plate_waves._between": (3, LOOP),
    "reversed_series._reversed": (1, "ends a search, whose result is the best circle before"),
    "series_constants._representable": (1, "overflow: no constant is close to the largest number"),
    "series_constants.finite_part_ratio": (1, INTEGER),
    "series_constants.kappa_ratio": (1, INTEGER),
    "simple_impact._estimate": (2, GUARD),
    "simple_impact._relative": (1, GUARD),
    "simple_impact._scene": (4, GUARD),
    "simple_impact._radius_ratio": (1, LOOP),
    "simple_impact.law_errors": (4, GUARD),
    "simple_impact.leading": (1, GUARD),
    "viscosity.viscous_logarithms": (4, ELSEWHERE),
    "wave_stress.wave_stress": (1, "tests whether a name is known"),
}
"""Largest number of comparisons by function without close cases on both sides, and why."""


def modules() -> list[ModuleType]:
    """Return the modules of the generated package except its manifest."""
    names = (module.name for module in pkgutil.iter_modules(generated.__path__))
    return [importlib.import_module(f"generated.{x}") for x in names if x != "manifest"]


@pytest.fixture(scope="module")
def seen(suite: Suite) -> Watch:
    """Return the record of all comparisons that the hard cases evaluate."""
    with watched({m: Path(str(m.__file__)).read_text() for m in modules()}) as watch:
        for case in suite.cases:
            kernel = suite.kernels[case.kernel]
            modes = {} if case.modes is None else {"modes": case.modes}
            with np.errstate(all="ignore"):
                if kernel.by_count:
                    kernel.call(int(case.numbers["count"][0]))
                else:
                    for arguments in layouts(case, kernel):
                        kernel.call(*arguments, **modes)
    return watch


def layouts(case: HardCase, kernel: Kernel) -> Iterator[list[Any]]:
    """Yield the arguments of a case; for the contact law also as arrays and as numbers."""
    arguments = call_arguments(case, kernel.arguments)
    yield arguments
    if kernel.module == "contact_law":
        columns = [np.ravel(x) for x in np.broadcast_arrays(*arguments)]
        yield columns
        yield from ([float(x) for x in point] for point in zip(*columns, strict=True))


def test_every_comparison_has_cases_close_to_both_sides(seen: Watch) -> None:
    """A new switch point in the code needs hard cases; see docs/development."""
    far = seen.beyond(CLOSE)
    count = Counter(place.home for place in far)
    most = {home: limit for home, (limit, _) in MAY_LACK_CASES.items()}
    assert {p: x for p, x in far.items() if count[p.home] > most.get(p.home, 0)} == {}


CODE = """
import numpy as np
def kinked(x):
    return np.where(x < 2.0, x, 2.0) + steep(x)
def steep(x):
    return x if x < 3.0 else 0.0
"""


@pytest.mark.parametrize(
    ("points", "far"),
    [
        ([1.0, 4.0], ["kinked", "steep"]),
        ([2.0, np.nextafter(2.0, 1.0), 1.0], ["steep"]),
        ([2.0, np.nextafter(2.0, 3.0), 3.0, np.nextafter(3.0, 0.0)], ["kinked"]),
        ([2.0, np.nextafter(2.0, 1.0), 3.0, np.nextafter(3.0, 0.0)], []),
        ([np.nan, 2.0, 3.0, np.nextafter(3.0, 0.0)], ["kinked"]),
    ],
)
def test_comparison_without_cases_on_both_sides_is_found(
    points: list[float], far: list[str]
) -> None:
    module = ModuleType("kinks")
    module.__file__ = "kinks.py"
    exec(compile(CODE, "kinks.py", "exec"), vars(module))
    plain = [module.kinked(x) for x in points]
    with watched({module: CODE}) as watch:
        assert np.array_equal([module.kinked(x) for x in points], plain, equal_nan=True)
    assert [place.home for place in watch.beyond(CLOSE)] == [f"kinks.{name}" for name in far]
