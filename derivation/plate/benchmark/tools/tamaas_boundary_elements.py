"""tamaas's boundary elements: a rigid sphere on a periodic half-space, as JSON."""

import json
import math
import time

import numpy as np
import tamaas as tm

R, A = 1.0, 0.1


def peak_pressure(n: int) -> tuple[float, float]:
    """Relative error of the largest pressure at a force, and seconds."""
    tm.set_log_level(tm.LogLevel.error)
    begin = time.perf_counter()
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 1.0, 0.0
    x = np.linspace(0, 1, n, endpoint=False) - 0.5
    surface = -(x[:, None] ** 2 + x**2) / (2 * R)
    kind = tm.PolonskyKeerRey.pressure
    solver = tm.PolonskyKeerRey(model, surface, 1e-12, kind, kind)
    solver.max_iter = 3000
    solver.solve(4 / 3 * A**3 / R)
    seconds = time.perf_counter() - begin
    return abs(model.traction.max() / (2 * A / (math.pi * R)) - 1), seconds


def main() -> None:
    """Print one line of JSON."""
    rows = []
    for n in (64, 128, 256):
        error, seconds = peak_pressure(n)
        rows.append({
            "problem": "peak pressure at a force", "setting": f"{n} x {n}, a = 0.1 of the period",
            "error": error, "seconds": seconds,
        })  # fmt: skip
    cannot = "an edge, a free far face, one contact alone: it is periodic; motion"
    print(json.dumps({
        "name": "tamaas", "version": tm.__version__, "cannot": cannot, "rows": rows,
    }))  # fmt: skip


if __name__ == "__main__":
    main()
