"""mpmath reference for the stress on the back face: an integral and residues, no modal sum.

F(T) = T g(A T/2) B(T) is integrated without its pole 6/T. The term 3 (gamma_E - log 4 eta) and the
residues at sinh T = +-T, computed here by Newton's method, give the finite plate. The edge term
follows from the indentation at three Poisson's ratios (`edge.route.supported`).
"""

from mpmath import mp, mpc, mpf

from derivation.engine.oracle.agreement import RouteError
from derivation.plate.edge.route import supported as edge_routes


def back_face_sum(a: float, h: float, b: float, digits: int = 30) -> mpf:
    """Return S for 0 < a < b, to the requested digits where h/b is not much above 1.

    The run time is proportional to a/h.
    """
    with mp.workdps(digits + 15):
        eta, A = mpf(h) / mpf(b), mpf(a) / mpf(h)
        total = _finite_part(A) / 2 + 3 * (mp.euler - mp.log(4 * eta))
        return +(total + _roots(eta, A))


def _weight(T: mpf, A: mpf) -> mpf:
    y = A * T / 2
    g = 3 * (mp.sin(y) - y * mp.cos(y)) / y**3
    return 2 * T**2 * g * mp.sinh(T) / (mp.sinh(T) ** 2 - T**2)


def _finite_part(A: mpf) -> mpf:
    """Return FP int_0^oo F dT; e^(-T) T^2 is negligible beyond the end."""
    end = mpf(int(2.4 * mp.dps) + 12)
    step = min(mpf(4), 8 / A)
    points = [1 + step * i for i in range(int((end - 1) / step) + 2)]
    with mp.workdps(2 * mp.dps + 10):  # F - 6/T cancels near 0, as F itself does

        def near(T: mpf) -> mpf:
            return _weight(T, A) - 6 / T if mpf(10) ** (-mp.dps // 6) < T else mpf(0)

        start = mp.quad(near, [mpf(0), min(mpf(1), step / 2), mpf(1)])
    return start + mp.quad(lambda T: _weight(T, A), points)


def _roots(eta: mpf, A: mpf) -> mpf:
    """Return pi Im sum (-1)^n g(A T/2) (1 + sqrt(1 + T^2)) H/J0 at T/(2 eta)."""
    total = mpf(0)
    for n in range(1, edge_routes.MOST):
        T = edge_routes.root(n, mp.prec)
        y, z = A * T / 2, T / (2 * eta)
        g = 3 * (mp.sin(y) - y * mp.cos(y)) / y**3
        # H/J0 at z = i u is (2/(pi i)) K0/I0 at u, without overflow and cancellation.
        turned = mpc(z.imag, -z.real)
        wave = mp.besselk(0, turned) / mp.besseli(0, turned) * mpc(0, -2) / mp.pi
        term = (-1) ** n * g * (1 + mp.sqrt(1 + T * T)) * wave
        total += term.imag
        if abs(term) < mp.eps:
            return mp.pi * total
    raise RouteError(f"too few roots at h/b = {mp.nstr(eta)}")


def back_face_edge(a: float, h: float, b: float, nu: float, digits: int = 30) -> mpf:
    """Return the edge term of S.

    pi/alpha times the edge term of the indentation is (1 - 2 n eta^2) (B + n C)/eta^3 +
    (8/3) n^2 D: its values at n = 0, 1/2, -1/4 give B, C and D.
    """
    with mp.workdps(digits + 15):
        eta, alpha, n = mpf(h) / mpf(b), mpf(a) / mpf(b), mpf(nu) / (1 - mpf(nu))
        points = [mpf(0), mpf(1) / 2, -mpf(1) / 4]
        values = [
            mp.pi / alpha * edge_routes.edge_part("indentation", a, h, b, x / (1 + x), mp.dps)
            for x in points
        ]
        rows = mp.matrix([[x**power for power in range(3)] for x in points])
        first, second, third = mp.lu_solve(rows, mp.matrix(values))
        B = first * eta**3
        C = (second + 2 * B / eta) * eta**3
        D = (third + 2 * C / eta) * 3 / 8
        return +(12 * (B + n * C) + 8 * n * eta * D)
