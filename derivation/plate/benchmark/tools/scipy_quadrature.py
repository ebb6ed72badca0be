"""SciPy's quadrature of the Hankel integral of a half-space's indentation, as JSON."""

import json
import math
import time
import warnings

import scipy
from scipy.integrate import quad

R, A = 1.0, 0.1


def shape(y: float) -> float:
    """sin y - y cos y."""
    return y**3 / 3 * (1 - y * y / 10) if y < 1e-2 else math.sin(y) - y * math.cos(y)


def whole(end: float, limit: int) -> float:
    """(4/(pi R)) int_0^end s(a k)/k^3 dk by quad alone."""
    value = quad(lambda k: shape(A * k) / k**3, 0, end, limit=limit, epsabs=0, epsrel=1e-12)[0]
    return 4 / (math.pi * R) * float(value)


def in_parts() -> float:
    """The same from 0 to 1/a, and beyond with the oscillation as a weight (QAWF)."""
    near = quad(lambda k: shape(A * k) / k**3, 0, 1 / A, epsabs=0, epsrel=1e-13)[0]
    sine = quad(lambda k: k**-3, 1 / A, math.inf, weight="sin", wvar=A, epsabs=1e-16)[0]
    cosine = quad(lambda k: A * k**-2, 1 / A, math.inf, weight="cos", wvar=A, epsabs=1e-16)[0]
    return 4 / (math.pi * R) * float(near + sine - cosine)


def main() -> None:
    """Print one line of JSON."""
    settings = {
        "quad to infinity": lambda: whole(math.inf, 50),
        "quad to k = 1e3/R": lambda: whole(1e3, 2000),
        "quad to k = 1e5/R": lambda: whole(1e5, 20000),
        "quad in parts, oscillation as weight": in_parts,
    }
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for setting, call in settings.items():
            call()
            begin = time.perf_counter()
            value = call()
            seconds = time.perf_counter() - begin
            rows.append({
                "problem": "indentation of a half-space", "setting": setting,
                "error": abs(value * R / A**2 - 1), "seconds": seconds,
            })  # fmt: skip
    cannot = "a plate: without an edge the integral diverges, with one it is a sum over modes"
    said = {"name": "SciPy quad", "version": scipy.__version__, "cannot": cannot, "rows": rows}
    print(json.dumps(said))


if __name__ == "__main__":
    main()
