"""The mpmath reference: the film as a system of four differential equations.

It is independent of the derivation. With k = G = 1, the state y = (U, W, shear, normal stress)
satisfies y' = A y, so that y at the top is e^(A H) times y at the base.
"""

from mpmath import matrix, mp, mpf

from derivation.engine.oracle.agreement import Values

KNOWN = {"bonded": (0, 1), "slipping": (2, 1)}
"""Components of the state that are zero at the base: U and W, or shear and W."""


def over_half_space(s: mpf, T: mpf, held: str) -> mpf:
    """Return the deflection of the top divided by that of a half-space."""
    a, b = (1 - s) / (1 + s), s / (1 + s)
    system = matrix([[0, 1, 1, 0], [-a, 0, 0, b], [4 / (1 + s), 0, 0, a], [0, 0, -1, 0]])
    through = mp.expm(system * (T / 2))
    free = [index for index in range(4) if index not in KNOWN[held]]
    tractions = matrix([[through[row, index] for index in free] for row in (2, 3)])
    base = mp.lu_solve(tractions, matrix([0, -1]))
    top = sum(through[1, index] * base[i] for i, index in enumerate(free))
    return -2 * top / (1 + s)


def _slipping(v: Values) -> mpf:
    half_space = (1 + v["s"]) / (2 * v["G"] * v["k"])
    return half_space * over_half_space(v["s"], 2 * v["k"] * v["H"], "slipping")


ROUTES = {
    "F_bonded": lambda v: over_half_space(v["s"], v["T"], "bonded"),
    "F_slipping": lambda v: over_half_space(mpf(1), v["T"], "slipping"),
    "C_slipping": _slipping,
}
