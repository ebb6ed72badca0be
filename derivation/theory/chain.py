"""The chain: its links in order, and every formula by name.

 1 equilibrium      Hooke's law, force balance -> ODEs for f_j, g_j
 2 mode shapes      ODEs -> general solution (2)
 3 stresses         Hooke's law of the mode
 4 face conditions  tractions (3) -> Omega_1 ... Omega_4 (5)
 5 loaded mode      f_j, g_j and stresses with the constants of (5)
 6 influence        w on both faces, half-space limit
 7 plate factor     the same as G(T), G_m(T), T = 2 phi h
 8 Hertz            pressure and its radius (7), Sonine's integral, A_j (4), (8)
 9 contact law      K_j, delta (6)
10 interior         u, w and stresses at any (r, z)
"""

from collections.abc import Callable, Iterator

from derivation.formula.record import Formula
from derivation.theory.contact_law import contact_law
from derivation.theory.equilibrium import equilibrium
from derivation.theory.face_conditions import omegas, scaled_omegas
from derivation.theory.hertz import contact_radius, pressure, pressure_coefficient, sonine
from derivation.theory.influence import influence_coefficients
from derivation.theory.interior import interior_fields
from derivation.theory.loaded_mode import loaded_mode
from derivation.theory.mode_shapes import mode_shapes
from derivation.theory.plate_factor import plate_factors
from derivation.theory.stresses import modal_stresses

LINKS: tuple[tuple[str, Callable[[], tuple[Formula, ...]]], ...] = (
    ("equilibrium", equilibrium),
    ("mode shapes", mode_shapes),
    ("stresses", modal_stresses),
    ("face conditions", lambda: (*omegas(), *scaled_omegas())),
    ("loaded mode", loaded_mode),
    ("influence", influence_coefficients),
    ("plate factor", plate_factors),
    ("Hertz", lambda: (pressure(), sonine(), contact_radius(), pressure_coefficient())),
    ("contact law", contact_law),
    ("interior", interior_fields),
)


def links() -> Iterator[tuple[str, tuple[Formula, ...]]]:
    """Each link's name and formulas, proved as they are asked for."""
    for name, derive_link in LINKS:
        yield name, derive_link()


def derive() -> dict[str, Formula]:
    """Every formula of the chain by name, each proved.

    Raises
    ------
    ProofError
        Naming the step that does not hold.
    """
    return {formula.name: formula for _, formulas in links() for formula in formulas}
