"""What the report says of the contact law, by link."""

ABOUT = {
    "Hertz": "Hertz's pressure, its transform (Sonine's integral) and the contact radius, which "
    "follows from the half-space's influence coefficient.",
    "contact law": "The indentation is the deflection under the sphere's centre.",
    "divergence": r"For large $j$ the modes feel a half-space: $\phi^3 K_j$ tends to a constant, "
    r"and the sums in the paper's $\gamma_k$ diverge for every $k$.",
    "contact split": "A contour integral turns the sum for the indentation into Hertz's term, the "
    "side wall's integral and a sum that dies exponentially with the thickness.",
    "plate series": "For small contacts the two convergent parts are expanded in powers of the "
    "contact radius; the coefficients depend on $h/b$ alone.",
    "thin plate": "For thin plates the sums become integrals over $T$, with finite parts $M_k$ "
    "and a logarithm. What they leave out is a sum of residues at $T_n$, the "
    r"roots of $\sinh T = T$ and $\sinh T = -T$ in the first quadrant, by height. "
    "With it the law is exact for every $h/b$.",
    "reversion": "Lagrange's inversion, of the paper's series and of the right one.",
    "curvature": "A growing contact is a sequence of flat punches. Where it is not small beside "
    "the sphere the paraboloid gives way to the sphere's own profile.",
}
