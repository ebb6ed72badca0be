"""Force and indentation of a viscoelastic contact.

The indentation lags the force. The area of the loop is the energy that the contact takes.
"""

import platecontact as pc
from matplotlib.figure import Figure

figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for time in (None, 3e-4, 1e-3, 3e-3):
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.02, material="steel"),
        plate=pc.Plate(
            radius=1.0, thickness=1.0, youngs_modulus=4e6, poissons_ratio=0.45, density=1150.0,
            retardation_time=time,
        ),
        impact=pc.Impact(speed=1.0),
        effects=pc.Effects(inertia=False),
        accuracy=pc.Accuracy(rtol=1e-2),
    )  # fmt: skip
    history = pc.simulate(scene).history(201)
    label = "elastic" if time is None else f"{1e3 * time:g} ms"
    axes.plot(1e3 * history.indentation, history.force, label=label)
axes.set(
    xlabel="indentation [mm]", ylabel="contact force [N]", title="Steel sphere on a rubber block"
)
axes.legend(title="retardation time")
