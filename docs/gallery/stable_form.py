"""Correct digits of the published and of the stable form.

The published K_j contains sinh(2 h phi) - 2 h phi, which cancels for long waves, and hyperbolic
functions that overflow for short ones. The generated function keeps all digits.
"""

import mpmath
import numpy as np
from matplotlib.figure import Figure

from generated import K_j, as_printed, bessel_j1_at_j0_zeros


def exact(x):
    """K_j with 40 digits, for b = R = 1 and J_1 as below."""
    x = mpmath.mpf(x)
    sinh, twice = mpmath.sinh, 2 * x
    numerator = 4 * (4 * x + sinh(4 * x))
    bracket = (sinh(twice) - twice) * (twice + sinh(twice))
    return numerator / (mpmath.pi * mpmath.mpf(J1) ** 2 * x**4 * bracket)


[J1] = bessel_j1_at_j0_zeros(1)
x = np.geomspace(1e-6, 1e3, 400)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
mpmath.mp.dps = 40
reference = [exact(each) for each in x]
with np.errstate(all="ignore"):
    for label, form in (("published form", as_printed.K_j), ("generated function", K_j)):
        values = form(x, 1.0, 1.0, 1.0, J1)
        errors = [
            float(abs(v / t - 1)) if np.isfinite(v) else 1.0
            for v, t in zip(values, reference, strict=True)
        ]
        axes.semilogx(x, -np.log10(np.clip(errors, 1e-17, 1.0)), label=label)
axes.set(
    xlabel="wave number times half-thickness h phi [1]", ylabel="correct digits [1]",
    title="Digits of K_j in double precision",
)  # fmt: skip
axes.legend(loc="lower center")
