"""The numbers of a scene, here of steel on a thick plate of glass; code of a scene has its own."""

import numpy as np

R = 0.01
"""Sphere radius [m]."""
MODULUS = 7.5e10
"""E* of the contact [Pa]."""
BEND = 10.0
"""Bending's share of the indentation over Hertz's, over the contact radius [1/m]."""
MASS = 0.03
"""Sphere mass [kg]."""
SPEED = 1.0
"""Impact speed [m/s]."""
GRAVITY = 9.81
"""What presses the sphere on [m/s^2]."""
RETARDATION_TIME = 1e-6
"""Retardation time A_v of the viscoelastic contact [s]."""
COMPLIANCE = 1e-9
"""Compliance of the plate in bending, which is elastic [m/N]."""
LIMIT = 1e-3
"""Largest contact radius of the law [m]."""
MAX_INDENTATION = 1e-4
"""Indentation there [m]."""
LARGEST_RADIUS = 3e-4
"""Largest contact radius of this scene's impact, nearly [m]."""
RISE = 1e-5
"""Largest indentation of this scene's impact over its speed [s]."""
HERTZ_TIME = 2.943275
"""Contact time of a Hertz impact over indentation/speed [1]."""
NODES = 32
"""Nodes of Gauss's rule."""
ENDS = np.array([0.0, 1e-3])
"""Contact radii [m] between which the polynomials below hold, a row each."""
GROWTH = np.array([[10.0, 0.0]])
"""F, growth of the indentation over a^2/R [1/m]: coefficients of 1, s, ...; s from -1 to 1."""
FORCE = np.array([[1.0, 0.0]])
"""p, force over (4/3) E* a^3/R: coefficients of 1, s, ...; s from -1 to 1."""
