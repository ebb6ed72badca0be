"""Text of the report about the modes of clamped and supported plates, by derivation step."""

ABOUT = {
    "thin-plate modes": "The modes of a thin plate are $J_0(k r/b) - c I_0(k r/b)$; at the edge "
    "the slope or the moment vanishes. Green's identity shows that they are orthogonal, and that "
    "$(J_1/J_0 + I_1/I_0)/k$ increases from one zero of $J_0$ to the next, so that "
    "there is one mode between neighbouring zeros. $W_n$ is the modal weight of a force on the "
    "axis: the sum of $W_n/k_n^4$ is the static deflection.",
    "thick-plate modes": "For finite thickness, a mode has the frequency and residue of A0 at its "
    "wave number; the edge conditions are Mindlin's, with the shear coefficient for which his "
    "lower branch agrees with A0 to one more order. A mode is $J_0(k r/b) - c I_0(k_2 r/b)$, "
    r"$\psi$ is its rotation, and $t$ is the ratio of contact-face to mean deflection of the part "
    "$I_0$ relative to that of $J_0$. Below the cut-off $k_2 = 0$ one mode lies between "
    "neighbouring zeros of $J_0$ (proved for Mindlin's frequencies, tested for those of A0). "
    r"The compliance of a clamped edge, $0.09 (\nu/(1 - \nu))^2 h/b$, is computed by finite "
    "elements, not derived.",
}
