"""Named materials: their constants, and where these come from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """An isotropic elastic material.

    Attributes
    ----------
    lam, mu
        Lame constants [Pa].
    density
        Density [kg/m^3]; None if the source gives none.
    source
        Where the numbers stand.
    """

    lam: float
    mu: float
    density: float | None
    source: str


def lame_constants(E: float, nu: float) -> tuple[float, float]:
    """First and second Lame constant [Pa] from Young's modulus [Pa] and Poisson's ratio."""
    mu = E / (2 * (1 + nu))
    return 2 * mu * nu / (1 - 2 * nu), mu


def plane_strain_modulus(lam: float, mu: float) -> float:
    """E* = E/(1 - nu^2) = 4 mu (lam + mu)/(lam + 2 mu) [Pa]."""
    return 4.0 * mu * ((lam + mu) / (lam + 2.0 * mu))


MATERIALS = {
    "steel": Material(
        *lame_constants(210e9, 0.3), 7850.0, "EN 1993-1-1:2005, 3.2.6; EN 1991-1-1:2002, A.4"
    ),
    "glass": Material(
        *lame_constants(70e9, 0.2), 2500.0, "soda lime silicate glass, EN 572-1:2012, table 1"
    ),
    "aluminium": Material(*lame_constants(70e9, 0.3), 2700.0, "EN 1999-1-1:2007, 3.2.5"),
    "concrete": Material(
        *lame_constants(33e9, 0.2), 2400.0, "C30/37, EN 1992-1-1:2004, 3.1.3; EN 1991-1-1, A.1"
    ),
    "PMMA": Material(
        *lame_constants(3.3e9, 0.37), 1190.0, "cast sheet, data sheet of PLEXIGLAS GS (Roehm)"
    ),
    "paper": Material(0.36e9, 0.43e9, None, "the paper's plate, its section 4"),
}
"""By the name a scene gives."""
