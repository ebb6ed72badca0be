"""Studies of many points: a grid or a sample of scenes, solved in batches that outlive the run.

Read in this order:

1. `plan`: the points, each made from its index: a `GridPlan`, a `SamplePlan` of `distributions`,
   or a `SaltelliPlan` for sensitivities.
2. `study`: what is computed, and the hash by which its points are known.
3. `store`: the batches that are finished, as files beside the output.
4. `run`: computes the batches that are missing, here or on a Dask cluster.
5. `dataset` and `write`: the result as an xarray Dataset, and as a file, block by block.
6. `sensitivity`, `forecast`, `plots`: variance-based indices, cost beforehand, pictures.
7. `api`: `sweep`, which does it all.
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
