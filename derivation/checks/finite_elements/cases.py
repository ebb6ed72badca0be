"""Impacts and plates that are computed, in the order of computation."""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from derivation.checks.finite_elements.impact import Sphere
from derivation.checks.finite_elements.plate import EDGES, Plate

GLASS = (70e9, 0.2, 2500.0)
ALUMINIUM = (70e9, 0.3, 2700.0)
CONCRETE = (33e9, 0.2, 2400.0)
STEEL_DENSITY = 7850.0
PARABOLOID_RADIUS = 10.0
"""Radius of the paraboloid over the contact radius, for the grid of cases."""
THICKNESS = 0.01
"""Thickness of the plates in the grid [m]."""
GRID = (
    (0.2, 0.3, 0.05, 5.0),
    (0.1, 0.2, 0.1, 10.0),
    (0.3, 0.45, 0.05, 3.0),
    (0.1, 0.3, 0.1, 30.0),
    (0.05, 0.3, 0.1, 20.0),
    (0.2, 0.0, 0.1, 20.0),
    (0.3, 0.3, 0.02, 1.3),
    (0.2, 0.2, 0.35, 10.0),
    (0.05, 0.0, 0.2, 10.0),
    (0.1, 0.45, 0.2, 10.0),
    (0.3, 0.2, 0.1, 50.0),
    (0.02, 0.2, 0.05, 20.0),
    (0.05, 0.45, 0.35, 50.0),
    (0.02, 0.3, 0.2, 50.0),
)
"""Plate thickness over radius, Poisson's ratio, contact radius over plate thickness, and contact
time over the time of a through-thickness reflection; contact radius and time are those of the same
impact on a half-space."""
THICK = (
    *((H, nu, *rest) for H, nu, rest in itertools.product(
        (0.5, 0.8), (-0.3, 0.0, 0.3), ((0.15, 6.0), (0.15, 4.0), (0.05, 2.0))
    )),
    *((H, 0.45, 0.15, 6.0) for H in (0.5, 0.65, 0.8)),
)  # fmt: skip
"""The same quantities for thick plates, on which the edge has a larger effect."""
AUXETIC = tuple(
    (H, nu, *rest)
    for H, nu, rest in itertools.product(
        (0.05, 0.1, 0.2, 0.3), (-0.6, -0.3), ((0.1, 10.0), (0.2, 6.0))
    )
    if nu == -0.3 or H in (0.1, 0.3)
)
"""The same quantities for plates with a negative Poisson's ratio."""
RATIOS = (0.02, 0.05, 0.1, 0.2, 0.3)
"""Thickness over radius of the plates whose natural frequencies are computed."""
POISSON = (0.0, 0.2, 0.3, 0.45)


@dataclass(frozen=True)
class ElementCase:
    """An impact.

    Parameters
    ----------
    name, group
        Name of the case, and name shared with the cases that differ only in the edge.
    plate, sphere
        Plate and sphere.
    """

    name: str
    group: str
    plate: Plate
    sphere: Sphere

    @property
    def radius(self) -> float:
        """Contact radius on a half-space [m]."""
        return math.sqrt(self.sphere.radius * self._depth)

    @property
    def time(self) -> float:
        """Contact time on a half-space [s]."""
        return HERTZ * self._depth / self.sphere.speed

    @property
    def _depth(self) -> float:
        """Hertz's indentation of a half-space [m]."""
        R, m, v = self.sphere.radius, self.sphere.mass, self.sphere.speed
        return float((15.0 * m * v**2 / (16.0 * self.plate.modulus * math.sqrt(R))) ** 0.4)

    @property
    def echo(self) -> float:
        """Time of a pressure wave to the back face and back [s]."""
        return 2.0 * self.plate.thickness / self.plate.pressure_wave_speed

    @property
    def edge_echo(self) -> float:
        """Earliest time at which the edge can affect the motion of the axis [s]."""
        return 2.0 * self.plate.radius / self.plate.pressure_wave_speed


HERTZ = 2.0 * math.sqrt(math.pi) * math.gamma(0.4) / (5.0 * math.gamma(0.9)) * 2.0
"""Contact time on a half-space times impact speed, over the indentation: 2.943."""


def impacts() -> tuple[ElementCase, ...]:
    """Return every impact that is computed."""
    panes, examples = [*_panes()], [*_examples()]
    return (*panes[:3], *_grid(GRID[:4]), *examples[:4], *_grid(GRID[4:-1]), *panes[3:],
            *examples[4:], *_grid((*GRID[-1:], *THICK, *AUXETIC)))  # fmt: skip


def plates() -> tuple[Plate, ...]:
    """Return every plate whose natural frequencies are computed; radius, E and density are 1."""
    return tuple(
        Plate(1.0, ratio, 1.0, nu, 1.0, edge)
        for edge, ratio, nu in itertools.product(EDGES, RATIOS, POISSON)
    )


def _ball(radius: float, speed: float, density: float = STEEL_DENSITY) -> Sphere:
    return Sphere(radius, 4.0 / 3.0 * math.pi * radius**3 * density, speed)


def _panes() -> Iterator[ElementCase]:
    """Yield the pane of the example `glass_pane`, and wider and thicker panes."""
    pane = Plate(0.3, 0.008, *GLASS)
    for radius, thickness in ((0.3, 0.008), (0.3, 0.02), (0.6, 0.008), (0.6, 0.02)):
        first = (radius, thickness) == (0.3, 0.008)
        group = "glass_pane" if first else f"glass_pane {radius:g} m {1e3 * thickness:g} mm"
        yield from _edges(group, replace(pane, radius=radius, thickness=thickness), _ball(0.01, 2))


def _examples() -> Iterator[ElementCase]:
    """Yield cases close to the example scenes."""
    block = ElementCase(
        "impact_echo paper", "impact_echo", Plate(1.0, 0.2, *CONCRETE), _ball(0.004, 2)
    )
    yield block
    yield from _edges("ball_drop", Plate(0.2, 0.02, *ALUMINIUM), _ball(0.025, 1.98))
    yield from _edges("membrane", Plate(0.05, 0.0005, *ALUMINIUM), Sphere(0.01, 0.0002, 2.2))


def _grid(rows: tuple[tuple[float, float, float, float], ...]) -> Iterator[ElementCase]:
    """Yield plates and spheres with given rows of `GRID`."""
    for ratio, nu, width, echoes in rows:
        plate = Plate(THICKNESS / ratio, THICKNESS, GLASS[0], nu, GLASS[2])
        a = width * THICKNESS
        R = PARABOLOID_RADIUS * a
        depth, time = a * a / R, echoes * 2.0 * THICKNESS / plate.pressure_wave_speed
        speed = HERTZ * depth / time
        mass = 16.0 / 15.0 * plate.modulus * math.sqrt(R) * depth**2.5 / speed**2
        group = f"H/b {ratio:g}, nu {nu:g}, a/H {width:g}, {echoes:g} echoes"
        yield from _edges(group, plate, Sphere(R, mass, speed))


def _edges(group: str, plate: Plate, sphere: Sphere) -> Iterator[ElementCase]:
    for edge in EDGES:
        yield ElementCase(f"{group} {edge}", group, replace(plate, edge=edge), sphere)
