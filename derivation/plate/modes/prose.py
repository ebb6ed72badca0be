"""Text of the report about one mode of the plate, by derivation step."""

ABOUT = {
    "equilibrium": r"One mode of the plate is $u = g(z) \phi J_1(\phi r)$, "
    r"$w = f(z) J_0(\phi r)$. With Hooke's law, the balance of forces gives two "
    "ordinary differential equations in $z$.",
    "mode shapes": r"For solutions proportional to $\exp(s z)$ the two equations become a 2x2 "
    r"matrix; the roots of its determinant and their multiplicities give the solution space.",
    "stresses": r"Hooke's law gives the stresses of the mode. The in-plane normal stresses have "
    r"a second term, which is proportional to $J_1(\phi r)/r$.",
    "face conditions": r"Both faces are free of shear, the back face is free of pressure, and "
    r"the pressure on the contact face has the coefficient $A_j$. These four conditions are "
    r"linear equations for $C_k = A_j \Omega_k$.",
    "loaded mode": "The constants are inserted into the shapes and stresses of the mode.",
    "influence": "The influence coefficient is the deflection of a face divided by the "
    "coefficient of the pressure. It is derived for both faces and for a half-space.",
    "plate factor": (
        r"The influence coefficients divided by the half-space's depend on $T = 2 \phi h$ alone."
    ),
    "interior": "Sums over the modes give the fields at any point.",
}
