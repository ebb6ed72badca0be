"""A sum of the paper that diverges.

Equation (10) of the paper needs sums of phi_j^3 K_j over all modes. The terms do not decay: they
tend to 4/(R b), so that the sum grows in proportion to the number of modes.
"""

import numpy as np
from matplotlib.figure import Figure

from generated import K_j, bessel_j0_zeros, bessel_j1_at_j0_zeros

h, b, sphere_radius = 0.1, 1.0, 0.13
n = np.arange(1, 2001)
phi = bessel_j0_zeros(n.size) / b
terms = phi**3 * K_j(phi, h, b, sphere_radius, bessel_j1_at_j0_zeros(n.size))
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
axes.loglog(n, np.cumsum(terms), label="sum over the first n modes")
axes.loglog(n, 4 * n / (sphere_radius * b), "k--", label="$4 n/(R b)$")
axes.set(
    xlabel="number of modes n [1]", ylabel=r"sum of $\phi_j^3 K_j$ [1/m²]",
    title=r"The sum for $\gamma_2$ grows without limit",
)  # fmt: skip
axes.legend()
