"""The paper's symbols as SymPy symbols, each with its unit, its meaning and its domain."""

from fractions import Fraction

import sympy as sp

from derivation.engine.formula.dimension import thirds
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary

r = sp.Symbol("r", nonnegative=True)
z = sp.Symbol("z", real=True)
phi, h, b, R, a, mu, P, T = sp.symbols("phi h b R a mu P T", positive=True)
lam, A_j = sp.symbols("lam A_j", real=True)
J1 = sp.Symbol("J1", real=True, nonzero=True)
C1, C2, C3, C4 = sp.symbols("C1:5", real=True)
eta, alpha, a_ratio, j_n, eps, m, v0, t, delta, delta_0, N, k, u_t, rho = sp.symbols(
    "eta alpha a_ratio j_n eps m v0 t delta delta_0 N k u_t rho", positive=True
)
viscous_time, x_v = sp.symbols("viscous_time x_v", positive=True)
yield_stress, xi_y = sp.symbols("yield_stress xi_y", positive=True)
omega, x_h, kap, gam, xi_R = sp.symbols("omega x_h kap gam xi_R", positive=True)
q_j, q_rate, nu = sp.symbols("q_j q_rate nu", real=True)
k_n = sp.Symbol("k_n", positive=True)
zeta = sp.Symbol("zeta", nonnegative=True)
E = sp.Symbol("E", positive=True)
kappa = {n: sp.Symbol(f"kappa_{n}", positive=True) for n in range(0, 10, 2)}
"""kappa_n, the integral of y^n K0(y)/I0(y) over y > 0, by n."""
M = {k: sp.Symbol(f"M_{k}", real=True) for k in range(2, 7)}
"""M_k, the finite part of the integral of T^(2k-4) (G - 1) over T > 0, by k."""
c_A = {n: sp.Symbol(f"c_{n}", real=True) for n in range(1, 10, 2)}
"""c_n, coefficient of (a/h)^n in delta R/a^2, by n."""
D = {n: sp.Symbol(f"D_{n}", real=True) for n in range(3, 12, 2)}
"""D_n = c_(n-2) (a_m/h)^(n-2), a_m the largest contact radius, by n."""
D_eta = {n: sp.Symbol(f"D_{n}_eta", real=True) for n in range(3, 12, 2)}
"""Derivative of D_n with respect to log(h/b) at fixed a_m/h, by n."""
gamma_k = {k: sp.Symbol(f"gamma_{k}", positive=k == 2, real=True) for k in range(2, 7)}
"""gamma_k, coefficient of P^((2k-1)/3) in the indentation, by k."""
xi_k = {k: sp.Symbol(f"xi_{k}", positive=k == 2, real=True) for k in range(2, 7)}
"""xi_k, coefficient of delta^((2k-1)/3) in the contact force, by k."""


class PlateRoot(sp.Function):
    """T_n, the n-th root of sinh T = +-T in the first quadrant, by imaginary part."""

    nargs = 1
    is_complex = True

    def _latex(self, printer: sp.printing.printer.Printer, exp: str | None = None) -> str:
        power = "" if exp is None else f"^{{{exp}}}"
        return f"T_{{{printer.doprint(self.args[0])}}}{power}"


f = sp.Function("f_j", real=True)(z)
g = sp.Function("g_j", real=True)(z)
UNKNOWNS = {f: "m", g: "m^2"}
"""Units of the functions the equilibrium equations determine."""

_INSIDE_PLATE = ("alpha > 0", "alpha < 1")
ARGUMENTS = (
    Argument(r, "m", "r", "distance from the axis", ("r >= 0", "r <= b")),
    Argument(z, "m", "z", "height above the middle plane", ("abs(z) <= h",)),
    Argument(phi, "1/m", r"\phi_j", "wave number j_n/b of the mode, J0(b phi) = 0", ("phi > 0",)),
    Argument(h, "m", "h", "half the plate's thickness", ("h > 0",)),
    Argument(T, "1", "T", "wave number times full thickness, T = 2 phi h", ("T > 0",)),
    Argument(b, "m", "b", "plate radius", ("b > 0",)),
    Argument(R, "m", "R", "sphere radius", ("R > 0",)),
    Argument(a, "m", "a", "contact radius", ("a > 0", "a < b", "a < R")),
    Argument(lam, "Pa", r"\lambda", "first Lame constant", ("3 * lam > -2 * mu",)),
    Argument(mu, "Pa", r"\mu", "second Lame constant (shear modulus)", ("mu > 0",)),
    Argument(P, "N", "P", "contact force", ("P > 0",)),
    Argument(A_j, "Pa", "A_j", "Fourier-Bessel coefficient of the pressure", ()),
    Argument(J1, "1", r"J_1(b\phi_j)", "Bessel function J1 at b phi", ("J1 != 0",)),
    Argument(C1, "m", r"C_1^{(j)}", "first integration constant", ()),
    Argument(C2, "m", r"C_2^{(j)}", "second integration constant", ()),
    Argument(C3, "1", r"C_3^{(j)}", "third integration constant", ()),
    Argument(C4, "1", r"C_4^{(j)}", "fourth integration constant", ()),
    Argument(eta, "1", r"\eta", "half-thickness over plate radius, h/b", ("eta > 0",)),
    Argument(alpha, "1", r"\alpha", "contact radius over plate radius, a/b", _INSIDE_PLATE),
    Argument(a_ratio, "1", "A", "contact radius over half-thickness, a/h", ("a_ratio > 0",)),
    Argument(j_n, "1", "j_n", "n-th positive zero of J0", ("j_n > 0",)),
    Argument(eps, "1", r"\varepsilon", "sqrt(R delta)/h", ("eps > 0",)),
    Argument(m, "kg", "m", "mass of the sphere", ("m > 0",)),
    Argument(v0, "m/s", "v_0", "impact speed of the sphere", ("v0 > 0",)),
    Argument(rho, "kg/m^3", r"\rho", "density of the plate", ("rho > 0",)),
    Argument(
        viscous_time,
        "s",
        "A_v",
        "retardation time of the viscoelastic contact",
        ("viscous_time > 0",),
    ),
    Argument(x_v, "1", "x_v", "viscous number", ("x_v >= 0",)),
    Argument(yield_stress, "Pa", "Y", "smaller yield stress of both bodies", ("yield_stress > 0",)),
    Argument(
        xi_y,
        "1",
        r"\xi",
        "Hertz contact radius of the peak force divided by the yield radius",
        ("xi_y >= 1",),
    ),
    Argument(omega, "1/s", r"\omega", "angular frequency", ("omega > 0",)),
    Argument(x_h, "1", "x", "wave number times half-thickness, phi h", ("x_h > 0",)),
    Argument(kap, "1", r"\kappa", "(omega h/c_T)^2, c_T^2 = mu/rho", ("kap >= 0",)),
    Argument(gam, "1", r"\gamma", "mu/(lam + 2 mu)", ("gam > 0", "4 * gam < 3")),
    Argument(xi_R, "1", r"\xi", "(c_R/c_T)^2 of Rayleigh's wave", ("xi_R > 0", "xi_R < 1")),
    Argument(q_j, "m", "q_j", "deflection of a mode on the axis", ()),
    Argument(q_rate, "m/s", r"\dot q_j", "velocity of a mode on the axis", ()),
    Argument(zeta, "1", r"\zeta", "damping ratio of a mode", ("zeta >= 0", "zeta < 1")),
    Argument(t, "s", "t", "time since first contact", ("t >= 0",)),
    Argument(k_n, "1", "k_n", "wave number of a plate mode times b", ("k_n > 0",)),
    Argument(nu, "1", r"\nu", "Poisson's ratio of the plate", ("nu > -1", "nu < 0.5")),
    Argument(delta, "m", r"\delta", "indentation", ("delta > 0",)),
    Argument(delta_0, "m", r"\delta_0", "indentation of the linear law", ("delta_0 > 0",)),
    Argument(N, "1", "N", "number of modes", ("N >= 1",)),
    Argument(k, "1", "k", "index of a term, at least 2", ("k >= 2",)),
    Argument(u_t, "1", "u", "time variable, 1 - u^2 = a/a_m", ("u_t >= 0", "u_t <= 1")),
    *(
        Argument(s, "1", rf"\kappa_{{{n}}}", f"integral of y^{n} K0/I0 over y > 0", ())
        for n, s in kappa.items()
    ),
    *(
        Argument(s, "1", f"M_{{{k}}}", f"finite part of the integral of T^{2 * k - 4} (G - 1)", ())
        for k, s in M.items()
    ),
    *(
        Argument(s, "1", f"c_{{{n}}}", f"coefficient of (a/h)^{n} in delta R/a^2", ())
        for n, s in c_A.items()
    ),
    *(
        Argument(s, "1", f"D_{{{n}}}", f"c_{n - 2} (a_m/h)^{n - 2}, a_m the largest a", ())
        for n, s in D.items()
    ),
    *(
        Argument(
            s,
            "1",
            rf"\dot D_{{{n}}}",
            f"derivative of D_{n} with respect to log(h/b) at fixed a_m/h",
            (),
        )
        for n, s in D_eta.items()
    ),
    *(
        Argument(
            s,
            f"m/{thirds('N', 2 * k - 1)}",
            rf"\gamma_{{{k}}}",
            f"coefficient of {thirds('P', 2 * k - 1)} in delta",
            (),
        )
        for k, s in gamma_k.items()
    ),
    *(
        Argument(
            s,
            f"N/{thirds('m', 2 * k - 1)}",
            rf"\xi_{{{k}}}",
            f"coefficient of {thirds('delta', 2 * k - 1)} in P",
            (),
        )
        for k, s in xi_k.items()
    ),
)
_VALUES = {
    "r": "0.002",
    "z": "0.004",
    "phi": "24.048",
    "h": "0.01",
    "T": "0.48096",
    "b": "0.1",
    "R": "0.13",
    "a": "0.004",
    "lam": "0.36e9",
    "mu": "0.43e9",
    "P": "1000",
    "A_j": "-1e6",
    "J1": "0.5191",
    "C1": "-1e-4",
    "C2": "-2e-5",
    "C3": "3e-4",
    "C4": "2e-3",
    "eta": "0.1",
    "alpha": "0.04",
    "a_ratio": "0.4",
    "j_n": "2.4048",
    "eps": "0.4",
    "m": "72",
    "rho": "2000",
    "v0": "1",
    "t": "1e-3",
    "viscous_time": "1e-4",
    "yield_stress": "1e7",
    "xi_y": "2",
    "omega": "1000",
    "kap": "0.01",
    "xi_R": "0.85",
    "q_j": "1e-5",
    "q_rate": "0.1",
    "zeta": "0.01",
    "nu": "0.25",
    "delta": "1e-4",
    "delta_0": "1e-4",
    "N": "100",
    "k": "2",
    **{f"kappa_{n}": "2" for n in range(0, 10, 2)},
    **{f"M_{k}": "1" for k in range(2, 7)},
    **{f"c_{n}": "0.1" for n in range(1, 10, 2)},
    **{f"D_{n}": "0.1" for n in range(3, 12, 2)},
    **{f"gamma_{k}": "1e-7" for k in range(2, 7)},
    **{f"xi_{k}": "1e7" for k in range(2, 7)},
}
"""The paper's plate and its first mode [SI]."""


PLATE = Vocabulary(
    ARGUMENTS,
    UNKNOWNS,
    aliases={f"C_{k}": c for k, c in enumerate((C1, C2, C3, C4), start=1)} | {"phi_j": phi},
    guests=(Argument(E, "Pa", "E", "Young's modulus of the plate", ("E > 0",)),),
    short={sp.besselj(1, b * phi): J1, sp.besselj(1, j_n): J1},
    per_term=frozenset({phi, T, J1, A_j, j_n, k_n, q_j, q_rate, C1, C2, C3, C4}),
    indices="jn",
    values=_VALUES,
    # Well inside the contact area, where roots of 1 - r^2/a^2 are real.
    within={r: Fraction(1, 16)},
)
BY_NAME = PLATE.by_name
arguments_of = PLATE.arguments_of


class Formula(Record):
    """A proved formula of the plate."""

    vocabulary = PLATE
