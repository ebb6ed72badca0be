"""Pressure under a wide contact.

Hertz's pressure is largest at the centre. Under a contact as wide as the plate is thick, the
pressure at the centre falls until the contact would open there.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.non_hertzian_pressure import contact, plate

half_thickness = 0.01
a = np.linspace(0.05, 5.0, 60) * half_thickness
contacts = contact(plate(half_thickness, 0.5), a, 0.13, 1e9)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
axes.plot(a / half_thickness, contacts.centre_pressure / contacts.mean_pressure, label="thin plate")
axes.axhline(1.5, color="black", linestyle="--", label="Hertz")
axes.set(
    xlabel="contact radius / half-thickness [1]", ylabel="centre / mean pressure [1]",
    title="Pressure at the centre of the contact",
)  # fmt: skip
axes.legend()
