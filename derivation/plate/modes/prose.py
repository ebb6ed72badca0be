"""Text of the report about one mode of the plate, by derivation step."""

ABOUT = {
    "equilibrium": r"One mode of the plate is $u = g(z) \phi J_1(\phi r)$, "
    r"$w = f(z) J_0(\phi r)$. Put into Hooke's law and the balance of forces it "
    "leaves two ordinary differential equations in $z$.",
    "mode shapes": r"On $\exp(s z)$ the two equations are a 2x2 matrix; the roots of its "
    "determinant and their multiplicities give the solution space.",
    "stresses": "Hooke's law of the mode. The in-plane normal stresses have a second term "
    r"proportional to $J_1(\phi r)/r$.",
    "face conditions": "No shear on either face, no pressure on the back face, and $A_j$ on the "
    r"contact face: four linear equations for $C_k = A_j \Omega_k$.",
    "loaded mode": "The same shapes with these constants.",
    "influence": "The deflection of each face per pressure coefficient, and its limit for "
    "a half-space.",
    "plate factor": (
        r"The influence coefficients divided by the half-space's depend on $T = 2 \phi h$ alone."
    ),
    "interior": "Sums over the modes give the fields at any point.",
}
