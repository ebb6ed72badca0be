"""Damping acts on the echo.

On a small plate a wave returns from the edge during the contact and pushes the sphere. Damping of
the plate weakens this echo; before it returns, the force hardly changes.
"""

import platecontact as pc
from matplotlib.figure import Figure

figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for loss_factor in (0.0, 0.1, 0.5):
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.02, material="steel"),
        plate=pc.Plate(
            radius=0.08, thickness=0.006, material="glass", edge="clamped",
            loss_factor=loss_factor,
        ),
        impact=pc.Impact(speed=0.5),
        accuracy=pc.Accuracy(rtol=3e-2),
    )  # fmt: skip
    history = pc.simulate(scene).history(301)
    axes.plot(1e6 * history.time, history.force, label=f"loss factor {loss_factor:g}")
axes.set(xlabel="time [µs]", ylabel="contact force [N]", title="Contact force on a damped plate")
axes.legend()
