"""Largest force against impact speed.

The same sphere on a thin and a thick plate. On the thick plate the force follows Hertz's power
6/5 of the speed; on the thin one bending makes the contact nearly linear.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.impact import impact

speed = np.geomspace(0.01, 1.0, 60)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for h in (0.05, 0.1, 1.0):
    result = impact(0.13, 72.2, speed, h, 1.0, 0.36e9, 0.43e9)
    axes.loglog(speed, 1e-3 * result.max_force, label=f"thickness {2 * h:g} m")
axes.set(xlabel="impact speed [m/s]", ylabel="largest force [kN]", title="Largest force")
axes.legend()
