"""A steel ball on a glass plate, with and without plate inertia.

A quasi-static plate deflects as far as under a static load, so that it is softer and returns all
the energy. With inertia it has no time to deflect that far, and its vibration keeps energy.
"""

import platecontact as pc
from matplotlib.figure import Figure

figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for label, effects in (("with inertia", pc.Effects()), ("quasi-static", pc.Effects(inertia=False))):
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.01, material="steel"),
        plate=pc.Plate(radius=0.3, thickness=0.02, material="glass", edge="simply-supported"),
        impact=pc.Impact(speed=1.0),
        effects=effects,
    )
    history = pc.simulate(scene).history(151)
    axes.plot(1e6 * history.time, 1e-3 * history.force, label=label)
axes.set(xlabel="time [µs]", ylabel="contact force [kN]", title="Contact force over time")
axes.legend()
