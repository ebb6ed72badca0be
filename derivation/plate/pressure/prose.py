"""Text of the report about the non-Hertzian pressure, by derivation step."""

ABOUT = {
    "contact pressure": r"The pressure is computed, not assumed: it is Abel's transform of "
    r"$\chi(t)$, and $\chi(t) + \int N(t, s) \chi(s) ds = (E^*/\pi) (\delta - f(t))$ on $(0, "
    r"a)$. Here $f$ follows from the profile of the sphere, and $N(t, s) = [k((t + s)/b) + "
    r"k((t - s)/b)]/(2b)$. The kernel $k$ is the derivative with respect to $a/b$ of $S = (R/2a) d "
    r"\delta/da$ of Hertz pressure. The condition $\chi(a) = 0$ determines $\delta$. Two formulas "
    r"bound the error of Hertz pressure at given force; there $a$ is the Hertz radius of this "
    "force. The last formulas are about a simply supported or clamped edge. The state of bending "
    "by which it differs from the paper's edge curves the plate under the contact, which adds "
    r"$N_s (t^2 + s^2 - 2 t^2 s^2/b^2)/h^3$ to the kernel. A wide contact bends the plate almost "
    "to the sphere's curvature; the code therefore solves for the curvature that remains between "
    "them.",
}
