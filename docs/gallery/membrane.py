"""A light ball that strikes a thin plate several times.

The plate is heavier and softer than the ball. It swings back and strikes the ball again before
the ball has left.
"""

import platecontact as pc
from matplotlib.figure import Figure

scene = pc.Scene(
    sphere=pc.Sphere(radius=0.01, mass=0.0002),
    plate=pc.Plate(radius=0.05, thickness=0.0005, material="aluminium", edge="clamped"),
    impact=pc.Impact(speed=2.0),
    accuracy=pc.Accuracy(rtol=2e-2),
)
history = pc.simulate(scene).history(1601)
figure = Figure(figsize=(6.4, 5.0), layout="constrained")
above, below = figure.subplots(2, sharex=True)
above.plot(1e6 * history.time, 1e6 * history.indentation, label="sphere")
above.plot(1e6 * history.time, 1e6 * history.deflection, label="plate on the axis")
above.set(ylabel="displacement [µm]", title="Several contacts")
above.legend()
below.plot(1e6 * history.time, history.force, color="C2")
below.set(xlabel="time [µs]", ylabel="contact force [N]")
