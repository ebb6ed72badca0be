"""Map of a sweep.

Largest force of a heavy sphere on quasi-static plates, over plate thickness and impact speed.
"""

import platecontact as pc
from matplotlib.figure import Figure

scene = pc.Scene(
    sphere=pc.Sphere(radius=0.13, density=7850.0),
    plate=pc.Plate(radius=1.0, thickness=0.2, youngs_modulus=1e9, poissons_ratio=0.23),
    impact=pc.Impact(speed=1.0),
    effects=pc.Effects(inertia=False),
    accuracy=pc.Accuracy(rtol=1e-2),
)
vary = {"plate.thickness": "0.1:0.4:13", "impact.speed": "0.2:1:9"}
data = 1e-3 * pc.sweep(scene, vary)["max_force"]
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
x, y = data["plate.thickness"], data["impact.speed"]
filled = axes.contourf(x, y, data.transpose(*y.dims, *x.dims), 12)
figure.colorbar(filled, label="largest force [kN]")
axes.set(xlabel="plate thickness [m]", ylabel="impact speed [m/s]", title="Largest force")
