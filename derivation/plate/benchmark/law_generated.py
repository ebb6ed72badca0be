"""The contact law by the generated code, by Hertz's formula alone, and by the oracle."""

import numpy as np

from derivation.plate.benchmark.arithmetic import Array, BallArithmetic
from derivation.plate.benchmark.interface import Call, Method, Regime
from derivation.plate.benchmark.law_sums import EXACT, wrapped
from derivation.plate.contact.oracle import balls as contact_balls
from generated import contact_law, contact_series


def hertz() -> Method:
    """delta = a^2/R."""

    def prepare(regime: Regime) -> Call:
        return lambda a: a * a / regime.R

    def same(regime: Regime) -> Call:
        return wrapped(EXACT, lambda a: a * a / EXACT.array(regime.R))

    return Method("law", "Hertz", "", prepare, same=same)


def called(dtype: type[np.float32 | np.float64] = np.float64) -> Method:
    """`indentation` as anyone calls it: domain and plate are looked into every time."""

    def prepare(regime: Regime) -> Call:
        R, h, b = (dtype(x) for x in (regime.R, regime.h, regime.b))
        return lambda a: contact_law.indentation(a.astype(dtype), R, h, b)

    name = np.dtype(dtype).name
    return Method("law", "production", "as called", prepare, name, exact=True)


def prepared() -> Method:
    """The same polynomials, the plate prepared once, the arguments trusted."""

    def prepare(regime: Regime) -> Call:
        plates = contact_series.plates_of(np.array([regime.eta]))
        law = contact_series.sphere_on_plate(plates, np.array([regime.h]), np.array(regime.R))
        if law is None:
            raise ValueError(f"expected ordinary lengths, got {regime}")

        def call(a: Array) -> Array:
            found = np.empty(a.size)
            for part in contact_series.blocks_of(a.size):
                contact_series.indent(a[part], a[part].max(), law, found[part])
            return found

        return call

    return Method("law", "production", "prepared", prepare, exact=True)


def oracle(digits: int, quick: bool = True) -> Method:
    """The contour integrals in balls, a certified value each; their nodes are set-up."""

    def prepare(regime: Regime) -> Call:
        def one(a: float) -> object:
            return contact_balls.indentation(a, regime.R, regime.h, regime.b, digits)

        one(regime.high * regime.h)
        return lambda a: [one(float(x)) for x in np.atleast_1d(a)]

    return Method(
        "law", "contour integrals", f"{digits} digits", prepare, BallArithmetic(digits).name,
        one_by_one=True, certified=True, quick=quick,
    )  # fmt: skip
