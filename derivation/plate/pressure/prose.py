"""Text of the report about the non-Hertzian pressure, by derivation step."""

ABOUT = {
    "contact pressure": "The pressure is computed instead of assumed: it is Abel's transform of "
    r"$\chi(t)$, and "
    r"$\chi(t) + \int N(t, s) \chi(s) ds = (E^*/\pi) (\delta - f(t))$ on "
    "$(0, a)$, where $f$ belongs to the sphere's profile and "
    "$N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2b)$. The kernel $k$ is the "
    r"slope by $a/b$ of $S = (R/2a) d \delta/da$ of Hertz pressure; "
    r"$\chi(a) = 0$ determines $\delta$. Finally, a bound of the error of Hertz "
    "pressure at given force, $a$ being the Hertz radius of this force.",
}
