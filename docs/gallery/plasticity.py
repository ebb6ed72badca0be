"""Restitution of a yielding contact.

Below the yield speed the contact is elastic. Far above it Thornton's restitution falls with the
power -1/4 of the speed. The simulated impacts are on a thick block.
"""

import numpy as np
import platecontact as pc
from matplotlib.figure import Figure

from generated.plasticity import plastic_restitution

shape = np.geomspace(1.0, 10.0, 100)  # Hertz's contact radius over the radius at yield
ratio = np.sqrt((5 * shape**6 + 1) / 6)  # impact speed over yield speed
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
axes.semilogx(ratio, plastic_restitution(shape), label="Thornton (1997)")
far = plastic_restitution(10.0) * (ratio / ratio[-1]) ** -0.25
axes.semilogx(ratio, far, "k:", label="power -1/4")
scene = {
    "sphere": {"radius": 0.005, "density": 7850.0},
    "plate": {
        "radius": 1.0, "thickness": 1.0, "youngs_modulus": 70e9, "poissons_ratio": 0.33,
        "yield_stress": 240e6,
    },
    "impact": {"speed": 1.0},
    "effects": {"inertia": False},
}  # fmt: skip
pressure, mass = 1.6 * 240e6, 7850.0 * 4 / 3 * np.pi * 0.005**3
modulus = 70e9 / (1 - 0.33**2)
onset = (np.pi * pressure / (2 * modulus)) ** 2
onset *= np.sqrt(8 * np.pi * pressure * 0.005**3 / (15 * mass))
speeds, restitution = [2.0, 10.0, 50.0, 250.0], []
for each in speeds:
    scene["impact"]["speed"] = each * onset
    restitution.append(pc.simulate(pc.read(scene)).restitution)
axes.semilogx(speeds, restitution, "o", label="simulated impact")
axes.set(
    xlabel="impact speed / yield speed [1]", ylabel="coefficient of restitution [1]",
    title="Yielding contact",
)  # fmt: skip
axes.legend()
