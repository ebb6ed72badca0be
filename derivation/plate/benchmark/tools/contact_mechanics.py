"""ContactMechanics' free half-space by FFT: a rigid sphere at an indentation, as JSON."""

import json
import sys
import time
from importlib.metadata import version
from pathlib import Path

# A script's folder is searched first: this file is named like the package it is about.
sys.path = [entry for entry in sys.path if Path(entry or ".").resolve() != Path(__file__).parent]

from ContactMechanics import FreeFFTElasticHalfSpace  # noqa: E402
from ContactMechanics.Factory import make_system  # noqa: E402
from SurfaceTopography import make_sphere  # noqa: E402

R, A, SIDE = 1.0, 0.1, 0.3


def force(n: int) -> tuple[float, float]:
    """Relative error of the force at delta = a^2/R, and seconds."""
    begin = time.perf_counter()
    half_space = FreeFFTElasticHalfSpace((n, n), 1.0, (SIDE, SIDE))
    sphere = make_sphere(R, (n, n), (SIDE, SIDE), kind="paraboloid")
    system = make_system(substrate=half_space, surface=sphere)
    system.minimize_proxy(offset=A * A / R, pentol=1e-10, maxiter=2000)
    seconds = time.perf_counter() - begin
    return abs(float(system.compute_normal_force()) / (4 / 3 * A**3 / R) - 1), seconds


def main() -> None:
    """Print one line of JSON."""
    rows = []
    for n in (32, 64, 128, 256):
        error, seconds = force(n)
        rows.append({
            "problem": "force at an indentation", "setting": f"{n} x {n}", "error": error,
            "seconds": seconds,
        })  # fmt: skip
    print(json.dumps({
        "name": "ContactMechanics", "version": version("ContactMechanics"),
        "cannot": "a plate of finite thickness, an edge, motion", "rows": rows,
    }))  # fmt: skip


if __name__ == "__main__":
    main()
