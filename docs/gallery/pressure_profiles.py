"""Contact pressure over the radius.

A small contact has Hertz's pressure. If the contact is wider than the plate is thick, the plate
bends away from the sphere and the pressure moves to the edge of the contact.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.non_hertzian_pressure import contact, plate, pressure

h, sphere_radius, modulus = 0.01, 0.13, 1e9
thin = plate(h, 0.5)
r = np.linspace(0.0, 1.0, 101)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for ratio in (0.5, 2.0, 3.0, 4.0, 5.0):
    a = ratio * h
    mean = contact(thin, a, sphere_radius, modulus).mean_pressure
    axes.plot(r, pressure(r * a, thin, a, sphere_radius, modulus) / mean, label=f"{ratio:g}")
axes.plot(r, 1.5 * np.sqrt(1 - r**2), "k--", label="Hertz")
axes.set_ylim(bottom=0.0)
axes.set(
    xlabel="radius / contact radius [1]", ylabel="pressure / mean pressure [1]",
    title="Pressure under contacts of growing width",
)  # fmt: skip
figure.legend(loc="outside right center", title="contact radius\n/ half-thickness")
