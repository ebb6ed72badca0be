"""mpmath reference of plate waves: the equations as a system of first order.

With h = mu = 1, phi = x and rho omega^2 = kap the state y = (U, W, S_rz, S_zz) of u = U J1(phi r),
w = W J0(phi r) obeys y' = A y,

    U' = x W + S_rz,                         W' = (S_zz - lam x U)/(lam + 2),
    S_rz' = x (lam W' + (lam + 2) x U) - kap U,    S_zz' = -x S_rz - kap W.

The eigenvectors of A, computed numerically, and the 4x4 system of the face tractions give the
deflection of the contact face. Its poles are located, and approached for their residues.
"""

from collections.abc import Callable

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError

_BITS = 200
"""Largest number of bisections between a frequency too low and one too high."""


def influence(x: float, kap: float, nu: float, digits: int = 30) -> tuple[mpf, mpf]:
    """Return w(+h) mu/(h A) for A/2 on both faces, with equal and with opposite directions.

    Parameters
    ----------
    x, kap, nu
        phi h, (omega h/c_T)^2 > 0 and Poisson's ratio, exact numbers.
    digits
        Number of decimal digits requested.
    """
    with mp.workdps(_working(x, kap, digits)):
        bending, stretching = _answers(mpf(x), mpf(kap), mpf(nu))
        return +bending, +stretching


def zero(x: float, nu: float, digits: int = 30) -> mpf:
    """Return kap of A0, the only pole of the deflection in bending below x^2."""
    with mp.workdps(_working(x, x**4 if x < 1 else x * x, digits)):
        return +_zero(mpf(x), mpf(nu), digits)


def residue(x: float, nu: float, digits: int = 30) -> mpf:
    """Return rho h r: (kap_0 - kap) times the deflection near the pole, from both sides."""
    with mp.workdps(_working(x, x**4 if x < 1 else x * x, 3 * digits)):
        wave, ratio = mpf(x), mpf(nu)
        kap = _zero(wave, ratio, 3 * digits)
        step = kap * mpf(10) ** -(digits // 2 + 3)
        sides = [-shift * _answers(wave, kap + shift, ratio)[0] for shift in (step, -step)]
        return +((sides[0] + sides[1]) / 2)


def wave_stress(x: float, kap: mpf, nu: float, bends: bool, digits: int = 30) -> mpf:
    """Return h/mu times the stress on the back face over the deflection of the contact face.

    Both are on the axis, and tension is positive. The load has a frequency next to that of a free
    wave, which dominates the response.

    Parameters
    ----------
    kap
        (omega h/c_T)^2 of a free wave, to more than the requested digits.
    bends
        Whether the wave is antisymmetric.
    """
    with mp.workdps(_working(x, kap, 3 * digits)):
        wave, ratio = mpf(x), mpf(nu)
        near = kap * (1 + mpf(10) ** -(digits + 3))
        deflection, radial = _moved(wave, near, ratio)[0 if bends else 1]
        # On a free face the stress is 2 (1 + nu)/(1 - nu) times the radial strain, u'(0) = x U/2;
        # the load of `_moved` is a traction away from the plate.
        return +(-(1 + ratio) / (1 - ratio) * wave * radial / deflection)


def fraction(x: float, nu: float, digits: int = 30) -> mpf:
    """Return the fraction of A0 in the static deflection, at a negligibly low frequency."""
    with mp.workdps(3 * digits):
        kap, answer = zero(x, nu, digits), residue(x, nu, digits)
        return answer / kap / sum(influence(x, float(kap) * 10.0 ** -(digits + 2), nu, digits))


def _working(x: float, kap: float, digits: int) -> int:
    """Return working digits: exponents differ by kap/x only, so that tractions cancel, too."""
    size = abs(mp.log10(mpf(x))) + abs(mp.log10(mpf(kap)))
    return int(2 * digits + 20 + 3 * size)


def _answers(x: mpf, kap: mpf, nu: mpf) -> tuple[mpf, mpf]:
    """Return the deflection of the upper face for equal and for opposite loads."""
    (bending, _), (stretching, _) = _moved(x, kap, nu)
    return bending, stretching


def _moved(x: mpf, kap: mpf, nu: mpf) -> tuple[tuple[mpf, mpf], tuple[mpf, mpf]]:
    """Return W on the upper face and U on the lower one, for equal and for opposite loads."""
    lam = 2 * nu / (1 - 2 * nu)
    stiff = lam + 2
    rows = mp.matrix(
        [
            [0, x, 1, 0],
            [-lam * x / stiff, 0, 0, 1 / stiff],
            [(stiff - lam**2 / stiff) * x**2 - kap, 0, 0, lam * x / stiff],
            [0, -kap, -x, 0],
        ]
    )
    exponents, vectors = mp.eig(rows)
    # Each exponential is 1 on the face towards which it grows.
    feet = [1 if mp.re(s) >= 0 else -1 for s in exponents]
    above, below = (
        [mp.exp(s * (face - foot)) for s, foot in zip(exponents, feet, strict=True)]
        for face in (1, -1)
    )
    tractions = mp.matrix(
        [
            [vectors[row, k] * growth[k] for k in range(4)]
            for growth in (above, below)
            for row in (2, 3)
        ]
    )
    values = []
    for sign in (-1, 1):
        half = mpf(1) / 2
        weights = mp.lu_solve(tractions, mp.matrix([0, half, 0, sign * half]))
        deflection = mp.fsum(weights[k] * vectors[1, k] * above[k] for k in range(4)).real
        radial = mp.fsum(weights[k] * vectors[0, k] * below[k] for k in range(4)).real
        values.append((deflection, radial))
    return values[0], values[1]


def _zero(x: mpf, nu: mpf, digits: int) -> mpf:
    """Return the zero of the stiffness by bisection, then the secant method."""

    def stiffness(kap: mpf) -> mpf:
        return 1 / _answers(x, kap, nu)[0]

    high = x * x * (1 - mpf(10) ** -6)
    low = min(x * x, x**4) / 1000
    if not (stiffness(low) > 0 > stiffness(high)):
        raise RouteError(f"no zero between {mp.nstr(low)} and {mp.nstr(high)}")
    for _ in range(12):
        middle = mp.sqrt(low * high)
        low, high = (middle, high) if stiffness(middle) > 0 else (low, middle)
    return _secant(stiffness, low, high, digits)


def _secant(function: Callable[[mpf], mpf], first: mpf, second: mpf, digits: int) -> mpf:
    before, here = function(first), function(second)
    for _ in range(_BITS):
        new = second - here * (second - first) / (here - before)
        if abs(new - second) < abs(new) * mpf(10) ** -(digits + 5):
            return new
        first, second, before, here = second, new, here, function(new)
    raise RouteError("the secant method does not converge")
