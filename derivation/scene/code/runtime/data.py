"""Constants of a scene, here of steel on a thick glass plate; each scene has its own values."""

import numpy as np

R = 0.01
"""Sphere radius [m]."""
MODULUS = 7.5e10
"""E* of the contact [Pa]."""
BEND = 10.0
"""Bending deflection over Hertz's indentation, over the contact radius [1/m]."""
MASS = 0.03
"""Sphere mass [kg]."""
SPEED = 1.0
"""Impact speed [m/s]."""
GRAVITY = 9.81
"""Gravitational acceleration during contact [m/s^2]."""
RETARDATION_TIME = 1e-6
"""Retardation time A_v of the viscoelastic contact [s]."""
COMPLIANCE = 1e-9
"""Bending compliance of the plate [m/N]."""
LIMIT = 1e-3
"""Largest contact radius of the law [m]."""
MAX_INDENTATION = 1e-4
"""Indentation at LIMIT [m]."""
LARGEST_RADIUS = 3e-4
"""Largest contact radius of the impact at SPEED, for first guesses [m]."""
RISE = 1e-5
"""Largest indentation of the impact at SPEED, over SPEED [s]."""
HERTZ_TIME = 2.943275
"""Contact time of a Hertz impact over indentation/speed [1]."""
NODES = 32
"""Number of Gauss nodes."""
ENDS = np.array([0.0, 1e-3])
"""Contact radii [m] between which the polynomials below are valid, a row each."""
GROWTH = np.array([[10.0, 0.0]])
"""F, growth of the indentation over a^2/R [1/m]: coefficients of 1, s, ...; s from -1 to 1."""
FORCE = np.array([[1.0, 0.0]])
"""p, force over (4/3) E* a^3/R: coefficients of 1, s, ...; s from -1 to 1."""
