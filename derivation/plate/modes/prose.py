"""What the report says of one mode of the plate, by link."""

ABOUT = {
    "equilibrium": r"One mode of the plate is $u = g(z) \phi J_1(\phi r)$, "
    r"$w = f(z) J_0(\phi r)$. Put into Hooke's law and the balance of forces it "
    "leaves two ordinary differential equations in $z$.",
    "mode shapes": r"On $\exp(s z)$ the two equations are a 2x2 matrix; the roots of its "
    "determinant and their multiplicities give the solution space.",
    "stresses": "Hooke's law of the mode. The normal stresses in the plane have a second part "
    r"that goes with $J_1(\phi r)/r$.",
    "face conditions": "No shear on either face, no pressure on the far face, $A_j$ on the "
    r"loaded one: four linear equations for $C_k = A_j \Omega_k$.",
    "loaded mode": "The same shapes with the constants just found.",
    "influence": "The deflection of each face per pressure coefficient, and what remains of it "
    "when the plate becomes a half-space.",
    "plate factor": (
        r"The influence coefficients over the half-space's depend on $T = 2 \phi h$ alone."
    ),
    "interior": "Sums over the modes give the fields at any point.",
}
