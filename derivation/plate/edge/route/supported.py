"""mpmath reference for a simple support: residues, no sum over modes.

Division by J0 turns the sums of step 19 into residues. At 0 it is a polynomial whose coefficients
are computed here from samples of the integrand on a circle. At z = T_n/(2 eta),
sinh T_n = (-1)^n T_n, the residues form a sum that converges like e^(-(1 - a/b) n pi b/(2 h)).
"""

from collections.abc import Callable, Iterable
from functools import cache

from mpmath import mp, mpc, mpf

from derivation.engine.oracle.agreement import RouteError

MOST = 20000
"""Largest number of roots."""
_SAMPLES = 48


def _indentation(y: mpc) -> mpc:
    return 3 * (mp.sin(y) - y * mp.cos(y)) / y**3


def _slope(y: mpc) -> mpc:
    return 3 * mp.sin(y) / (2 * y)


KERNELS: dict[str, Callable[[mpc], mpc]] = {"indentation": _indentation, "slope": _slope}


def edge_part(kind: str, a: float, h: float, b: float, nu: float, digits: int = 30) -> mpf:
    """Return X, the change of delta R/a^2, or of (R/2a) d delta/da for kind `slope`.

    Parameters
    ----------
    kind
        `indentation` or `slope`.
    a, h, b, nu
        Exact numbers; 0 < a < b.
    digits
        Number of decimal digits requested.
    """
    with mp.workdps(digits + 15):
        alpha, eta = mpf(a) / mpf(b), mpf(h) / mpf(b)
        n = mpf(nu) / (1 - mpf(nu))
        kernel = KERNELS[kind]

        def stretched(z: mpc) -> mpc:
            T = 2 * eta * z
            return kernel(alpha * z) * (mp.cosh(T) - 1) / (mp.sinh(T) + T) / mp.besselj(0, z)

        # Neither 1/J0 nor the roots have poles within this circle.
        radius = min(mpf(1), 1 / eta)
        # Near 0, four powers of T and three of alpha z cancel in the samples.
        lost = -4 * mp.log10(2 * eta * radius) - 3 * mp.log10(alpha * radius)
        with mp.workdps(mp.dps + 10 + max(0, int(lost))):
            first = _bending(lambda z: kernel(alpha * z), eta, n, digits)
            second = _coefficient(stretched, 1, radius, digits + 10) / 2

        def wave(T: mpc) -> mpc:
            z = T / (2 * eta)
            return kernel(alpha * z) / (z**2 * mp.besselj(0, z))

        second += _roots(1, lambda T: _odd(T) * wave(T), eta) / (2 * eta)
        total = (1 - 2 * n * eta**2) / eta**3 * first + mpf(8) / 3 * n**2 * second
        return +(alpha / mp.pi * total)


def curvature(h: float, b: float, nu: float, digits: int = 30) -> mpf:
    """Return the coefficient of (t^2 + s^2)/h^3 in the kernel of the integral equation."""
    with mp.workdps(digits + 25):
        eta, n = mpf(h) / mpf(b), mpf(nu) / (1 - mpf(nu))
        ratio = (1 - mpf(nu)) / (1 + mpf(nu))
        return +(-3 / mp.pi * ratio * _bending(lambda _: mpf(1), eta, n, digits))


def _bending(kernel: Callable[[mpc], mpc], eta: mpf, n: mpf, digits: int) -> mpf:
    """Return the sum of bending over the modes, for a weight function of z = j."""

    def bent(z: mpc) -> mpc:
        T = 2 * eta * z
        Q = T * (mp.cosh(T) - 1) / (mp.sinh(T) - T)
        return kernel(z) * (1 + 3 * n - n * Q) / mp.besselj(0, z)

    def residue(T: mpc) -> mpc:
        z = T / (2 * eta)
        return -n * kernel(z) / (z**2 * mp.besselj(0, z))

    radius = min(mpf(1), 1 / eta)  # as in `edge_part`
    return _coefficient(bent, 2, radius, digits + 10) / 2 + _roots(0, residue, eta)


def _odd(T: mpc) -> mpc:
    """Return the residue (cosh T - 1)/(cosh T + 1) of H at sinh T = -T."""
    return (mp.cosh(T) - 1) / (mp.cosh(T) + 1)


def _coefficient(function: Callable[[mpc], mpc], power: int, radius: mpf, digits: int) -> mpf:
    """Return a coefficient of a power series: the mean of samples on a circle converges fast.

    The coefficients are real, so samples on the lower half are conjugates of those on the upper.
    """

    def sample(turn: mpf) -> mpf:
        z = radius * mp.expjpi(turn)
        return (function(z) / z**power).real

    def samples(numerators: Iterable[int], count: int) -> mpf:
        return 2 * mp.fsum(sample(mpf(i) / count) for i in numerators)

    half = _SAMPLES // 2
    total = sample(mpf(0)) + sample(mpf(1)) + samples(range(1, half), half)
    former = total / (2 * half)
    while half < 32 * _SAMPLES:
        total += samples(range(1, 2 * half, 2), 2 * half)
        half *= 2
        coefficient = total / (2 * half)
        if abs(coefficient - former) < mpf(10) ** -digits * abs(coefficient):
            return coefficient
        former = coefficient
    raise RouteError("samples on a circle did not give a coefficient")


@cache
def root(n: int, bits: int) -> mpc:
    """Return T_n of sinh T = (-1)^n T, first quadrant: Newton's method on T - asinh T = i pi n."""
    with mp.workprec(bits):
        x = mpc(mp.log(2 * mp.pi * n), mp.pi * n + 1)
        for _ in range(bits.bit_length() + 6):
            slope = 1 - 1 / mp.sqrt(1 + x * x)
            step = (x - mp.asinh(x) - mpc(0, mp.pi * n)) / slope
            x -= step
            if abs(step) < mp.ldexp(1, -2 * bits // 3):
                break  # the next step is of the order of its square
        if not abs(mp.sinh(x) - (-1) ** n * x) < mpf(10) ** (-mp.dps + 6) * abs(x) ** 2:
            raise RouteError(f"no root of sinh T = +-T for n = {n}")
        return x


def _roots(parity: int, residue: Callable[[mpc], mpc], eta: mpf) -> mpf:
    """Return 2 Re of the residues at every second root, until they are negligible against eta^3."""
    total, floor = mpf(0), mp.eps * min(mpf(1), eta**4)
    for n in range(2 - parity, MOST, 2):
        T = root(n, mp.prec)
        term = residue(T)
        total += 2 * term.real
        if abs(term) < floor:
            return total
    raise RouteError(f"{MOST} roots are not enough at h/b = {mp.nstr(eta)}")
