"""What the report says of one mode of the plate, by link."""

ABOUT = {
    "equilibrium": "One mode of the plate is u = g(z) phi J1(phi r), w = f(z) J0(phi r). Put into "
    "Hooke's law and the balance of forces it leaves two ordinary differential equations in z.",
    "mode shapes": "On exp(s z) the two equations are a 2x2 matrix; the roots of its determinant "
    "and their multiplicities give the solution space.",
    "stresses": "Hooke's law of the mode. The normal stresses in the plane have a second part "
    "that goes with J1(phi r)/r.",
    "face conditions": "No shear on either face, no pressure on the far face, A_j on the loaded "
    "one: four linear equations for C_k = A_j Omega_k.",
    "loaded mode": "The same shapes with the constants just found.",
    "influence": "The deflection of each face per pressure coefficient, and what remains of it "
    "when the plate becomes a half-space.",
    "plate factor": "The influence coefficients over the half-space's depend on T = 2 phi h alone.",
    "interior": "Sums over the modes give the fields at any point.",
}
