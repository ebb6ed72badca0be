"""What the report says of damping, by link."""

ABOUT = {
    "damping": r"A plate of loss factor $\eta_l = 2 \zeta$ takes energy from each mode. Viscous "
    "damping at the mode's own frequency takes as much at resonance, and no effect comes before "
    r"its cause: $q'' + 2 \zeta \omega q' + \omega^2 q = \omega^2 c P$. A force drives the mode "
    "by Duhamel's integral over $g$.",
}
