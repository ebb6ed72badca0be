"""Manifest rows of viscous contacts and of the plate's own motion.

Name, module, arguments, unit, symbol, equation, meaning.
"""

Row = tuple[str, str, tuple[str, ...], str, str, str, str]

VISCOSITY_FUNCTIONS: tuple[Row, ...] = (
    (
        "viscous_number",
        "viscosity",
        ("R", "m", "v0", "lam", "mu", "viscous_time"),
        "1",
        "x",
        "",
        "what a viscous contact takes of the speed",
    ),
    (
        "restitution_weak",
        "viscosity",
        ("x_v",),
        "1",
        "e",
        "",
        "restitution of a weakly viscous contact",
    ),
)

INERTIA_FUNCTIONS: tuple[Row, ...] = (
    (
        "bending_frequency",
        "inertia",
        ("x", "nu"),
        "1",
        r"\omega_0 h/c_T",
        "",
        "frequency of the lowest bending branch",
    ),
    (
        "bending_residue",
        "inertia",
        ("x", "nu"),
        "1",
        r"\rho h\,r_0",
        "",
        "how the lowest bending branch answers a load",
    ),
    (
        "bending_share",
        "inertia",
        ("x", "nu"),
        "1",
        "s_0",
        "",
        "share of the lowest bending branch in the deflection at rest",
    ),
    (
        "dynamic_influence",
        "inertia",
        ("x", "kap", "nu"),
        "1",
        "1/B_a, 1/B_s",
        "",
        "deflection of the loaded face per pressure coefficient, over h/mu: bending, stretching",
    ),
)
