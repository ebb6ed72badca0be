"""Map of a sweep.

Restitution of a steel sphere on a glass plate, over plate thickness and impact speed.
"""

import platecontact as pc
from matplotlib.figure import Figure

scene = pc.Scene(
    sphere=pc.Sphere(radius=0.01, material="steel"),
    plate=pc.Plate(radius=0.3, thickness=0.02, material="glass", edge="clamped"),
    impact=pc.Impact(speed=1.0),
    accuracy=pc.Accuracy(rtol=3e-2),
)
vary = {"plate.thickness": "0.01:0.03:6", "impact.speed": "0.5:2:3"}
data = pc.sweep(scene, vary)["restitution"]
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
x, y = 1e3 * data["plate.thickness"], data["impact.speed"]
filled = axes.contourf(x, y, data.transpose(*y.dims, *x.dims), 12)
figure.colorbar(filled, label="coefficient of restitution [1]")
axes.set(xlabel="plate thickness [mm]", ylabel="impact speed [m/s]", title="Restitution")
