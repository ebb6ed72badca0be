"""Frequency of bending waves.

The lowest wave branch of a plate for three values of Poisson's ratio. Thin-plate theory gives a
straight line of slope 2; waves shorter than the thickness become Rayleigh waves.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.inertia import bending_frequency

x = np.geomspace(0.05, 20.0, 200)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for nu in (0.0, 0.25, 0.45):
    axes.loglog(x, bending_frequency(x, nu), label=f"Poisson's ratio {nu}")
axes.set(
    xlabel="wave number times half-thickness [1]", ylabel="normalised frequency [1]",
    title="Lowest wave branch (A0)",
)  # fmt: skip
axes.legend()
