"""Text of the report about damping, by derivation step."""

ABOUT = {
    "damping": r"A plate with the loss factor $\eta_l = 2 \zeta$ dissipates energy in each mode. "
    "Viscous damping at the mode's own frequency gives the same loss at resonance and is causal: "
    r"$q'' + 2 \zeta \omega q' + \omega^2 q = \omega^2 c P$. The response to a force is "
    "Duhamel's integral over $g$.",
}
