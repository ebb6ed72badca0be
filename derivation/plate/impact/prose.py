"""Text of the report about impacts, by derivation step."""

ABOUT = {
    "impact": "Energy conservation gives the largest contact radius; the contact time is the "
    "integral of an analytic function. The linearised motion of the paper is derived for "
    "comparison.",
    "sensitivity": "An impact depends on seven parameters. By dimensional analysis each result is "
    "a product of powers of them times a function of two dimensionless groups, the energy "
    "number and $h/b$. The energy integral gives the derivatives with respect to these two; the "
    "other sensitivities are constant exponents.",
    "substitution": "If the ratio of two laws' slopes lies within known factors, so do an "
    "impact's results. The slope lies between $S_1 = 1 + 3 c_1 A/2$ and "
    "$S_1 - K_3 A^3$ for every $a < b$, which gives error bounds for Hertz's law and for its "
    "first correction.",
}
