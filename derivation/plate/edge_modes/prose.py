"""What the report says of the modes of plates with a held edge, by link."""

ABOUT = {
    "held modes": "A thin plate's modes $J_0(k r/b) - c I_0(k r/b)$ whose edge has no slope, or "
    "no moment. Green's identity makes them orthogonal, and makes "
    "$(J_1/J_0 + I_1/I_0)/k$ grow from one zero of $J_0$ to the next, so that "
    "there is one mode between neighbouring ones. $W_n$ says how a force on the "
    "axis moves it: the sum of $W_n/k_n^4$ is the static deflection.",
    "held waves": "A plate with a thickness keeps the frequency and residue of A0 at its wave "
    "number; its edge is Mindlin's, whose shear coefficient makes his lower "
    "branch follow A0 to one more order. A mode is $J_0(k r/b) - c I_0(k_2 r/b)$, "
    r"$\psi$ is its rotation, $t$ is by how much more the part $I_0$ moves the "
    "loaded face. Below the cut-off $k_2 = 0$ one mode lies between neighbouring "
    "zeros of $J_0$ (proved for Mindlin's frequencies, tested with those of A0). "
    r"The clamp's compliance $0.09 (\nu/(1 - \nu))^2 h/b$ is measured on finite "
    "elements, not derived.",
}
