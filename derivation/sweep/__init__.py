"""Studies of many points: a grid or a sample of scenes, simulated in batches that are saved.

The modules in reading order:

1. `plan`: the points, each computed from its index: a `GridPlan`, a `SamplePlan` of
   `distributions`, or a `SaltelliPlan` for sensitivities.
2. `study`: scene, points and tolerance, and the hash that identifies them.
3. `store`: the finished batches, as files in a folder next to the output.
4. `run`: computes the missing batches in processes or on a Dask cluster.
5. `dataset` and `write`: the results as an xarray Dataset, and as a file, block by block.
6. `sensitivity`, `forecast`, `plots`: variance-based indices, estimated run time, plots.
7. `api`: the public function `sweep`.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from derivation.sweep.api import sweep

__all__ = ["sweep"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from derivation.sweep import api

    return getattr(api, name)
