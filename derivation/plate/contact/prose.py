"""Text of the report about the contact law, by derivation step."""

ABOUT = {
    "Hertz": "This step gives Hertz pressure, its transform (Sonine's integral), and the "
    "contact radius, which follows from the influence coefficient of the half-space.",
    "contact law": "The indentation is the deflection of the contact face at the centre.",
    "divergence": r"For large $j$ the plate acts like a half-space: $\phi^3 K_j$ is constant, "
    r"and the sums in the paper's $\gamma_k$ diverge for every $k$.",
    "contact split": "A contour integral turns the sum for the indentation into Hertz's term, an "
    "integral for the finite radius, and a sum that decays exponentially with the thickness.",
    "plate series": "For small contacts the two convergent parts are expanded in powers of the "
    "contact radius; the coefficients depend on $h/b$ alone.",
    "thin plate": "For thin plates the sums become integrals over $T$, with finite parts $M_k$ "
    "and a logarithm. The remainder is a sum of residues at $T_n$, the "
    r"roots of $\sinh T = T$ and $\sinh T = -T$ in the first quadrant, in the order of their "
    "imaginary parts. "
    "With it the law is exact for every $h/b$.",
    "reversion": "The series of the paper and the corrected one are inverted by Lagrange's "
    "formula: indentation against force becomes force against indentation.",
    "spherical profile": "A growing contact is a sequence of flat punches. If it is not small "
    "compared with the sphere, the sphere's exact profile replaces the paraboloid.",
}
