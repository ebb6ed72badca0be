"""The sums of the paper's equation (10) by their definition, in mpmath."""

from mpmath import besseljzero, j1, mp, mpf, sinh
from mpmath import pi as mp_pi


def plate_factor(T: mpf) -> mpf:
    """Return the plate factor G(T)."""
    return (sinh(2 * T) / 2 + T) / (sinh(T) ** 2 - T**2)


def truncated_gamma(k: int, modes: int, case: tuple[float, ...]) -> mpf:
    """Return gamma_k of equation (10), with K_j from the plate factor G(T) and zeros of J0."""
    R, _, _, h, b, lam, mu = map(mpf, case)
    modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)

    def term(n: int) -> mpf:
        j = besseljzero(0, n)
        K = 8 * plate_factor(2 * h * j / b) / (mp_pi * R * b**2 * (j / b) ** 4 * j1(j) ** 2)
        return (j / b) ** (2 * k - 1) * K

    total = mp.fsum(term(n) for n in range(1, modes + 1))
    scale = mpf((-1) ** k * (2 * k - 2)) / mp.factorial(2 * k - 1)
    return scale * (3 * R / (4 * modulus)) ** (mpf(2 * k - 1) / 3) * total
