"""What the report says of waves of the plate, by link."""

ABOUT = {
    "plate motion": "The law is static. These numbers say when the plate's own motion matters.",
    "dynamic modes": "The first six links again, with the plate's own inertia. A load that "
    "oscillates bends and stretches the plate apart, with stiffnesses $B_a$ "
    r"and $B_s$: $x = \phi h$, $\kappa = (\omega h/c_T)^2$, "
    r"$\gamma = \mu/(\lambda + 2 \mu)$, $p^2 = x^2 - \gamma \kappa$, "
    r"$q^2 = x^2 - \kappa$. Both fall with the frequency where they are finite, "
    "by the motion's kinetic energy, so that between two poles of either there "
    "is one branch of free waves; these are orthogonal.",
    "bending branch": "Below the speed of shear waves $B_a$ vanishes once: on A0, the lowest "
    "branch. For thin plates it is Kirchhoff's bending and carries the whole "
    "load, for short waves it is Rayleigh's wave. Its share $y$ of the face's "
    r"deflection obeys $y'' + \omega_0^2 y = r_0 A_j$. Here $\xi = \kappa/x^2$ "
    r"and $w = 1 - \xi$.",
    "closure": "A plate that moves is a set of oscillators $q_j$ of static compliance $c_j$, "
    r"and each feels only the part $P_j$ of the force. With $z = D + \sum s_j q_j$, "
    r"$s_j = dP_j/dP$ and $D = \delta - \sum c_j P_j s_j$ no energy is lost or made, "
    r"whatever the static law: $\int P dD + \sum q_j (P s_j - P_j)$ is the contact's. "
    "With $s_j = 1$, the indentation at the axis, some leaks. The same weight turns "
    "the static law into the variational one.",
}
