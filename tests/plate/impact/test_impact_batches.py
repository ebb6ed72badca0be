"""Test that arrays of impacts of any size and shape give the results of single impacts."""

import tracemalloc

import numpy as np

from derivation.plate.benchmark.speed import scenes
from generated.impact import _BATCH, impact


def test_batch_equals_single_impacts() -> None:
    """Results agree at both sides of a batch boundary, also for contacts wider than 3 h."""
    given = scenes(0.01, 5.9, _BATCH + 600)
    actual = np.stack(impact(**given))
    for index in (0, 511, 512, _BATCH - 1, _BATCH, _BATCH + 1, _BATCH + 599):
        alone = np.stack(impact(**{name: float(x[index]) for name, x in given.items()}))
        np.testing.assert_allclose(actual[:, index], alone, rtol=2e-15)


def test_batch_broadcasts_its_arguments() -> None:
    """Speeds along one axis broadcast with plates along the other, for more than one batch."""
    v0, h = np.linspace(0.1, 1.0, _BATCH // 4)[:, None], np.array([0.1, 0.12, 0.2, 0.1, 0.5])
    actual = np.stack(impact(0.13, 72.2, v0, h, 1.0, 0.36e9, 0.43e9))
    assert actual.shape == (4, v0.size, h.size)
    for column, half in enumerate(h):
        alone = np.stack(impact(0.13, 72.2, v0[::997, 0], half, 1.0, 0.36e9, 0.43e9))
        np.testing.assert_allclose(actual[:, ::997, column], alone, rtol=2e-15)


def test_memory_grows_by_little_more_than_the_results() -> None:
    """The peak memory grows by less than 100 bytes per impact; the results take 32 bytes."""

    def peak(count: int) -> int:
        given = {name: x[:count] for name, x in every.items()}
        tracemalloc.start()
        impact(**given)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return most

    every = scenes(0.01, 2.9, 4 * _BATCH)
    assert peak(4 * _BATCH) - peak(_BATCH) < 100 * 3 * _BATCH
