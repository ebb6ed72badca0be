"""Sensitivity of the contact time.

By how many percent the contact time changes if a parameter grows by one percent. On a thin plate
the thickness matters most; on a thick one it has no influence.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.sensitivity import impact_sensitivities

h = np.geomspace(0.04, 1.0, 60)
result = impact_sensitivities(0.13, 72.2, 1.0, h, 1.0, 0.36e9, 0.43e9)[0]
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
names = ("sphere radius", "sphere mass", "impact speed", "plate thickness", "plate radius")
styles = ("-", "-", "--", "-", "-")
for name, values, style in zip(names, result, styles, strict=False):
    axes.semilogx(2 * h, values, style, label=name)
axes.set(
    xlabel="plate thickness [m]", ylabel="change of contact time [% per %]",
    title="Logarithmic sensitivities of the contact time",
)  # fmt: skip
axes.legend()
