"""Notation of one mode's fields, and the steps that their stable forms share.

Notation: x = phi h, T = 2x, t = phi z, u = phi (h + z), v = phi (h - z), so that u + v = T.
With D = sinh^2 T - T^2, every field is a multiple of

    deflection  [sinh T (ratio cosh u + v sinh u) + T (ratio cosh v + u sinh v)]/D
    S_zz        [sinh T (v (cosh u - 1) + sinh u - u) + T (sinh v (cosh u - 1)
                + cosh v (sinh u - u))]/D
    S_rz        [sinh T v sinh u + T u sinh v]/D
    in plane    [sinh T (c sinh u - d v cosh u) - T (c sinh v - d u cosh v)]/D

For thick plates decaying exponentials are used, e^(-v) as a factor and e^(-2u) for the
contribution of the back face; for thin plates truncated Taylor series. `times` multiplies factors
that may be very large or small, `times_closely` where rounding uses most of the budget.
"""

import sympy as sp

from derivation.engine.rewrite.form import ONCE, TAIL, Step, Switch
from derivation.plate.vocabulary import T, h, lam, mu, phi, z

x, u, v = sp.symbols("x u v", real=True)
far_u, far_v, decay = sp.symbols("far_u far_v decay", real=True)
ratio = sp.Symbol("ratio", positive=True)
rounding, exponential, deficit = sp.symbols("rounding exponential deficit", real=True)

Steps = tuple[Step, ...]
Shape = tuple[Steps, sp.Expr | Switch]
ONE = sp.Integer(1)

THIN = sp.Rational(9, 4)
"""T below which deflection and stresses are computed by truncated Taylor series. S_rr and S_tt
have the same switch point, because their sum is small where Poisson's ratio is almost -1, and
their rounding errors must cancel there."""

RATIO = Step(ratio, 1 + 1 / (1 + lam / mu), "2 (1 - nu)")
WHOLE_T = (Step(x, phi * h), Step(T, 2 * x))
DEPTHS = (
    Step(u, phi * (h + z), "from the back face"),
    Step(v, phi * (h - z), "from the contact face"),
)
FADE = Step(exponential, sp.exp(-sp.Min(v, ONCE)), "decay from the contact face")
FADED = (exponential, 1, TAIL(v), 1)
FAR_U = Step(far_u, sp.exp(-2 * u), "decay to the back face and back")
FAR_V = Step(far_v, sp.exp(-2 * v))
DECAY = Step(decay, sp.exp(-2 * T))
LACK = Step(deficit, decay * (4 * T**2 + 2 - decay), "1 - 4 e^(-2T) D")
