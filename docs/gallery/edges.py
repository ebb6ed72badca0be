"""Three edges of the same plate.

Static indentation of a glass plate by a steel sphere. A clamped edge is stiffest. The edge of the
paper lies between a clamped and a simply supported one.
"""

import numpy as np
import platecontact as pc
from matplotlib.figure import Figure

forces = np.linspace(20.0, 1000.0, 25)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for edge in ("simply-supported", "paper", "clamped"):
    scene = pc.Scene(
        sphere=pc.Sphere(radius=0.01, material="steel"),
        plate=pc.Plate(radius=0.3, thickness=0.008, material="glass", edge=edge),
        impact=pc.Impact(speed=1.0),
    )
    contacts = pc.indent(scene, force=forces)
    axes.plot([1e3 * each.indentation for each in contacts], forces, label=edge)
axes.set(
    xlabel="indentation, deflection included [mm]", ylabel="force [N]",
    title="Influence of the edge",
)  # fmt: skip
axes.legend()
