"""Speed of bending waves.

The lowest wave branch of a plate for three values of Poisson's ratio. In thin-plate theory
(dashed) the phase speed grows with the wave number without limit; waves shorter than the
thickness become Rayleigh waves.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.inertia import bending_frequency

x = np.geomspace(0.05, 20.0, 200)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for nu in (0.0, 0.25, 0.45):
    (line,) = axes.semilogx(x, bending_frequency(x, nu) / x, label=f"Poisson's ratio {nu:g}")
    thin = x * np.sqrt(2 / (3 * (1 - nu)))
    axes.semilogx(x[thin < 1.0], thin[thin < 1.0], "--", color=line.get_color())
axes.set(
    xlabel="wave number times half-thickness [1]", ylabel="phase speed / shear-wave speed [1]",
    title="Lowest wave branch (A0)",
)  # fmt: skip
axes.plot([], [], "k--", label="thin-plate theory")
axes.legend(loc="lower right")
