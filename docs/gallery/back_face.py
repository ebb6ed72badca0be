"""Tensile stress on the back face.

The largest tensile stress under the contact, per force. It grows with the logarithm of the plate
radius, and falls as the contact spreads over more than the thickness.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.back_face import (
    back_face_stress,
    clamped_back_face_stress,
    supported_back_face_stress,
)

h, b, lam, mu = 0.004, 0.3, 2.2e10, 2.9e10
a = np.geomspace(0.01, 6.0, 80) * h
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
for label, stress in (
    ("simply supported", supported_back_face_stress),
    ("paper", back_face_stress),
    ("clamped", clamped_back_face_stress),
):
    axes.semilogx(a / h, 1e-3 * stress(1.0, a, h, b, lam, mu), label=label)
axes.set(
    xlabel="contact radius / half-thickness [1]", ylabel="stress per force [kPa/N]",
    title="Tensile stress on the back face of a glass plate",
)  # fmt: skip
axes.legend(title="edge")
