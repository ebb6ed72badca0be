"""What the report says of the pressure from the integral equation, by link."""

ABOUT = {
    "true pressure": "Not assumed but solved for: the pressure is Abel's transform of "
    r"$\chi(t)$, and "
    r"$\chi(t) + \int N(t, s) \chi(s) ds = (E^*/\pi) (\delta - f(t))$ on "
    "$(0, a)$, where $f$ belongs to the sphere's profile and "
    "$N(t, s) = [k((t + s)/b) + k((t - s)/b)]/(2b)$. The kernel $k$ is the "
    r"slope by $a/b$ of $S = (R/2a) d \delta/da$ of Hertz's pressure; "
    r"$\chi(a) = 0$ fixes $\delta$. Last, a bound of what assuming Hertz's "
    "pressure changes at given force, $a$ being Hertz's radius of it.",
}
