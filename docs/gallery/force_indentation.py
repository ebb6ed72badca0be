"""Static force and indentation, from a half-space to a thin plate.

On a thick plate the force follows Hertz's law with the exponent 3/2. On a thin plate the
deflection is most of the indentation, and the law becomes linear.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.contact_law import force

sphere_radius, b, lam, mu = 0.13, 1.0, 0.36e9, 0.43e9
depth = np.geomspace(1e-6, 3e-3, 200)
modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)  # E/(1 - nu^2)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for h in (1.0, 0.1, 0.05):
    axes.loglog(
        1e3 * depth, force(depth, sphere_radius, h, b, lam, mu), label=f"thickness {2 * h:g} m"
    )
hertz = 4 / 3 * modulus * np.sqrt(sphere_radius) * depth**1.5
axes.loglog(1e3 * depth, hertz, "k--", label="Hertz (half-space)")
axes.set(xlabel="indentation [mm]", ylabel="force [N]", title="Static contact law")
axes.legend()
