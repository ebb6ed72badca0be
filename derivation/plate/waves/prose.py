"""Text of the report about waves of the plate, by derivation step."""

ABOUT = {
    "plate motion": "The law is static. These parameters show when plate inertia matters.",
    "dynamic modes": "The first six steps are repeated with plate inertia. An oscillating load "
    "has independent bending and extensional responses, with stiffnesses $B_a$ "
    r"$\gamma = \mu/(\lambda + 2 \mu)$, $p^2 = x^2 - \gamma \kappa$, "
    r"$q^2 = x^2 - \kappa$. Both decrease with the frequency where they are finite, "
    "because of the kinetic energy, so that between two poles of either there "
    "is one branch of free waves; these are orthogonal.",
    "bending branch": "Below the speed of shear waves $B_a$ has one zero: the lowest branch A0. "
    "For thin plates it is Kirchhoff's bending and carries the whole "
    "load, for short waves it is Rayleigh's wave. Its part $y$ of the face's "
    r"deflection obeys $y'' + \omega_0^2 y = r_0 A_j$. Here $\xi = \kappa/x^2$ "
    r"and $w = 1 - \xi$.",
    "coupling": "A plate with inertia is a set of modes $q_j$ of static compliance $c_j$. "
    r"The modal force is the part $P_j$ of the force. With $z = D + \sum s_j q_j$, "
    r"$s_j = dP_j/dP$ and $D = \delta - \sum c_j P_j s_j$ energy is conserved "
    r"for any static law: $\int P dD + \sum q_j (P s_j - P_j)$ is that of the contact. "
    "With $s_j = 1$, the indentation at the axis, energy is lost spuriously. The same modal "
    "weight turns the static law into the variational one.",
}
