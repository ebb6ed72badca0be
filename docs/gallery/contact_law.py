"""Contact law: force over Hertz's force.

A thin plate deflects under the sphere, so that the same indentation takes a smaller force than on
a half-space. Each curve is a ratio of half-thickness h to plate radius b.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.contact_law import indentation

sphere_radius, plate_radius = 0.13, 1.0
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for ratio in (0.02, 0.05, 0.1, 0.2, 0.5):
    a = np.geomspace(1e-4, 0.05, 200)
    depth = indentation(a, sphere_radius, ratio * plate_radius, plate_radius)
    axes.semilogx(a / sphere_radius, (depth * sphere_radius / a**2) ** -1.5, label=f"{ratio}")
axes.set(
    xlabel="contact radius / sphere radius [1]", ylabel="force / Hertz's force [1]",
    title="Force at equal indentation",
)  # fmt: skip
figure.legend(loc="outside right center", title="half-thickness\n/ plate radius")
