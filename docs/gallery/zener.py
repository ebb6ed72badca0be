"""Restitution on an infinite plate, with Zener's curve.

In Zener's theory of thin infinite plates one parameter determines the restitution. Soft spheres
follow it. Steel spheres stay in contact for a short time only, and shear and waves across the
thickness take more energy.
"""

import numpy as np
import platecontact as pc
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

YOUNG, NU, DENSITY, THICKNESS = 7e10, 0.2, 2500.0, 0.004


def zener(parameter):
    """Restitution by s'' + (1 + lambda d/dt) s^(3/2) = 0."""

    def rates(_t, y):
        s = max(y[0], 0.0)
        return y[1], -(s**1.5) - 1.5 * parameter * s**0.5 * y[1]

    def separated(t, y):
        return y[0] if t > 0.5 else 1.0

    separated.terminal = True
    return -solve_ivp(rates, (0, 1000), (0, 1), events=separated, rtol=1e-8).y[1, -1]


def struck(radius, modulus, density):
    """Zener's parameter and the restitution of an impact at 1 m/s."""
    mass = density * 4 / 3 * np.pi * radius**3
    compliance = (1 - NU**2) / YOUNG + (1 - 0.3**2) / modulus
    time = (mass * compliance / (4 / 3 * radius**0.5)) ** 0.4
    stiffness = YOUNG * THICKNESS**3 / 12 / (1 - NU**2)
    scene = pc.Scene(
        sphere=pc.Sphere(
            radius=radius, youngs_modulus=modulus, poissons_ratio=0.3, density=density
        ),
        plate=pc.Plate(
            radius=1.0, thickness=THICKNESS, youngs_modulus=YOUNG, poissons_ratio=NU,
            density=DENSITY,
        ),
        impact=pc.Impact(speed=1.0),
        inertia=pc.Inertia(extent="infinite"),
        accuracy=pc.Accuracy(rtol=3e-2),
    )  # fmt: skip
    parameter = mass / (8 * time * (stiffness * DENSITY * THICKNESS) ** 0.5)
    return parameter, pc.simulate(scene).restitution


figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
curve = np.linspace(0.0, 1.5, 40)
axes.plot(curve, [zener(each) for each in curve], "k-", label="Zener (1941)")
soft = [struck(radius, 1e8, 1200.0) for radius in (0.01, 0.02, 0.03, 0.04)]
steel = [struck(radius, 2.1e11, 7850.0) for radius in (0.002, 0.003, 0.004, 0.006, 0.008)]
axes.plot(*np.transpose(soft), "o", label="soft sphere")
axes.plot(*np.transpose(steel), "s", label="steel sphere")
axes.set(
    xlabel="Zener inelasticity parameter [1]", ylabel="coefficient of restitution [1]",
    title="Energy radiated into an infinite plate",
)  # fmt: skip
axes.legend()
