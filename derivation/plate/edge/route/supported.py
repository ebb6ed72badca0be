"""Oracle 2 of the edge's part of the law: residues in mpmath, no sum over modes.

1/J0 turns link 19's sums into residues: at 0 a polynomial, its coefficients found here from
samples of the integrand on a circle, and at z = T_n/(2 eta), sinh T_n = (-1)^n T_n, a sum that
converges like e^(-(1 - a/b) n pi b/(2 h)).
"""

from collections.abc import Callable

from mpmath import mp, mpc, mpf

from derivation.engine.oracle.agreement import RouteError

MOST = 20000
"""Roots at most."""
_SAMPLES = 48


def _indentation(y: mpc) -> mpc:
    return 3 * (mp.sin(y) - y * mp.cos(y)) / y**3


def _slope(y: mpc) -> mpc:
    return 3 * mp.sin(y) / (2 * y)


KERNELS: dict[str, Callable[[mpc], mpc]] = {"indentation": _indentation, "slope": _slope}


def edge_part(kind: str, a: float, h: float, b: float, nu: float, digits: int = 30) -> mpf:
    """What a clamp takes from delta R/a^2, or of (R/2a) d delta/da for kind `slope`.

    Parameters
    ----------
    kind
        `indentation` or `slope`.
    a, h, b, nu
        Numbers, exact as they are; 0 < a < b.
    digits
        Decimal digits asked for.
    """
    with mp.workdps(digits + 15):
        alpha, eta = mpf(a) / mpf(b), mpf(h) / mpf(b)
        n = mpf(nu) / (1 - mpf(nu))
        kernel = KERNELS[kind]

        def bent(z: mpc) -> mpc:
            T = 2 * eta * z
            Q = T * (mp.cosh(T) - 1) / (mp.sinh(T) - T)
            return kernel(alpha * z) * (1 + 3 * n - n * Q) / mp.besselj(0, z)

        def stretched(z: mpc) -> mpc:
            T = 2 * eta * z
            return kernel(alpha * z) * (mp.cosh(T) - 1) / (mp.sinh(T) + T) / mp.besselj(0, z)

        # Neither 1/J0 nor the roots have a pole within this circle.
        radius = min(mpf(1), 1 / eta)
        # Samples near 0 cancel by four powers of T and three of alpha z.
        lost = -4 * mp.log10(2 * eta * radius) - 3 * mp.log10(alpha * radius)
        with mp.workdps(mp.dps + 10 + max(0, int(lost))):
            first = _coefficient(bent, 2, radius, digits + 10) / 2
            second = _coefficient(stretched, 1, radius, digits + 10) / 2

        def wave(T: mpc) -> mpc:
            z = T / (2 * eta)
            return kernel(alpha * z) / (z**2 * mp.besselj(0, z))

        even = _roots(0, lambda T: -n * wave(T), eta)
        odd = _roots(1, lambda T: _odd(T) * wave(T), eta)
        first, second = first + even, second + odd / (2 * eta)
        total = (1 - 2 * n * eta**2) / eta**3 * first + mpf(8) / 3 * n**2 * second
        return +(alpha / mp.pi * total)


def _odd(T: mpc) -> mpc:
    """Residue (cosh T - 1)/(cosh T + 1) of H at sinh T = -T."""
    return (mp.cosh(T) - 1) / (mp.cosh(T) + 1)


def _coefficient(function: Callable[[mpc], mpc], power: int, radius: mpf, digits: int) -> mpf:
    """Coefficient of a power of z: the mean of samples on a circle, converging geometrically."""
    count, former = _SAMPLES, None
    while count <= 64 * _SAMPLES:
        points = (radius * mp.expjpi(mpf(2 * i) / count) for i in range(count))
        found = mp.fsum(function(z) / z**power for z in points).real / count
        if former is not None and abs(found - former) < mpf(10) ** -digits * abs(found):
            return found
        former, count = found, 2 * count
    raise RouteError("no coefficient from samples on a circle")


def root(n: int) -> mpc:
    """T_n of sinh T = (-1)^n T, first quadrant: Newton's iteration on T - asinh T = i pi n."""
    x = mpc(mp.log(2 * mp.pi * n), mp.pi * n + 1)
    for _ in range(mp.prec.bit_length() + 6):
        slope = 1 - 1 / mp.sqrt(1 + x * x)
        x -= (x - mp.asinh(x) - mpc(0, mp.pi * n)) / slope
    if not abs(mp.sinh(x) - (-1) ** n * x) < mpf(10) ** (-mp.dps + 6) * abs(x) ** 2:
        raise RouteError(f"no root of sinh T = +-T for n = {n}")
    return x


def _roots(parity: int, residue: Callable[[mpc], mpc], eta: mpf) -> mpf:
    """2 Re of the residues at every second root, until they no longer count beside eta^3."""
    total, floor = mpf(0), mp.eps * min(mpf(1), eta**4)
    for n in range(2 - parity, MOST, 2):
        T = root(n)
        share = residue(T)
        total += 2 * share.real
        if abs(share) < floor:
            return total
    raise RouteError(f"{MOST} roots are too few at h/b = {mp.nstr(eta)}")
