"""Restitution against plate thickness.

A thick plate returns nearly all the energy; a thin one keeps it as vibration. Below some
thickness the sphere strikes the plate again while it still vibrates.
"""

import numpy as np
import platecontact as pc
from matplotlib.figure import Figure

thickness = np.geomspace(0.004, 0.04, 11)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for radius in (0.005, 0.01):
    restitution = [
        pc.simulate(
            pc.Scene(
                sphere=pc.Sphere(radius=radius, material="steel"),
                plate=pc.Plate(radius=0.3, thickness=each, material="glass", edge="clamped"),
                impact=pc.Impact(speed=1.0),
                accuracy=pc.Accuracy(rtol=3e-2),
            )
        ).restitution
        for each in thickness
    ]
    axes.plot(
        1e3 * thickness, restitution, ".-", label=f"steel sphere, diameter {2e3 * radius:g} mm"
    )
axes.set(
    xlabel="plate thickness [mm]", ylabel="coefficient of restitution [1]",
    title="Restitution on a glass plate",
)  # fmt: skip
axes.legend()
