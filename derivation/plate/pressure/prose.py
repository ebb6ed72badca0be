"""Text of the report about the non-Hertzian pressure, by derivation step."""

ABOUT = {
    "contact pressure": r"The pressure is computed, not assumed: it is Abel's transform of "
    r"$\chi(t)$, and $\chi(t) + \int N(t, s) \chi(s) ds = (E^*/\pi) (\delta - f(t))$ on $(0, "
    r"a)$. Here $f$ follows from the profile of the sphere, and $N(t, s) = [k((t + s)/b) + "
    r"k((t - s)/b)]/(2b)$. The kernel $k$ is the derivative with respect to $a/b$ of $S = (R/2a) d "
    r"\delta/da$ of Hertz pressure. The condition $\chi(a) = 0$ determines $\delta$. The last "
    r"formulas bound the error of Hertz pressure at given force; there $a$ is the Hertz radius "
    r"of this force.",
}
