"""Text of the report about waves of the plate, by derivation step."""

ABOUT = {
    "plate motion": "The contact law is static. These parameters show when plate inertia matters.",
    "dynamic modes": r"The first six steps are repeated with plate inertia. The responses to an "
    r"oscillating load in bending and in extension are independent. Their stiffnesses are "
    r"$B_a$ and $B_s$, with $\kappa = (\omega h/c_T)^2$, $\gamma = \mu/(\lambda + 2 \mu)$, "
    r"$p^2 = x^2 - \gamma \kappa$ and $q^2 = x^2 - \kappa$. Both decrease with the frequency "
    r"wherever they are finite, because of the kinetic energy. Therefore one branch "
    r"of free waves lies between two poles of either; the branches are orthogonal.",
    "bending branch": "Below the speed of shear waves $B_a$ has one zero: the lowest branch A0. "
    "For thin plates it is Kirchhoff's bending and carries the whole "
    "load, for short waves it is Rayleigh's wave. Its part $y$ of the face's "
    r"deflection obeys $y'' + \omega_0^2 y = r_0 A_j$. Here $\xi = \kappa/x^2$ "
    r"and $w = 1 - \xi$.",
    "coupling": r"A plate with inertia is a set of modes $q_j$ with static compliances $c_j$. "
    r"The modal force $P_j$ is the part of the contact force that acts on mode $j$. With the "
    r"modal weights $s_j = dP_j/dP$, the displacement $z = D + \sum s_j q_j$ and $D = \delta - "
    r"\sum c_j P_j s_j$, energy is conserved for any static law; the contact stores $\int P dD "
    r"+ \sum q_j (P s_j - P_j)$. If the indentation is taken on the axis, $s_j = 1$, energy is "
    r"lost spuriously. The same modal weights turn the static law into the variational one.",
    "wave stress": "Under an impact the back face is not stressed as under a static load, because "
    "waves have not reached the edge yet. Each wave stresses it in proportion to its deflection. "
    r"With $x = \phi h$ and $\kappa = (\omega h/c_T)^2$ the ratio is $S_a$ in bending and $S_s$ in "
    "extension; for thin plates it is that of a bent plate. A mode of a clamped or supported plate "
    r"also has an evanescent part, $c I_0(k_2 r)$.",
}
