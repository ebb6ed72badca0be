"""Constants for the generated contact law: tables, ends of ranges, exponents."""

import numpy as np
import sympy as sp

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.plate.contact.kernels import tables
from derivation.plate.contact.kernels.series import cubic_by_log
from derivation.plate.contact.kernels.tables import FAR_REACH, REACH, SHORT, WIDE_START
from derivation.plate.impact.theory.sensitivity import PARAMETERS, RESULTS, exponents

FAR_MIDDLE = sp.Rational(FAR_REACH**2 + REACH**2, 2)
FAR_HALF = sp.Rational(FAR_REACH**2 - REACH**2, 2)
_CELL = "ends in b/h, rows by scaled power of b/h"


def numbers() -> Numbers:
    """Return the constants of a plate's polynomials, and of the sensitivities of an impact."""
    return Numbers(
        "contact_numbers",
        "Numbers of the contact law: ends of its polynomials, and their tables.",
        (*_ends(), *_closed_form(), *_tables(), *_exponents()),
    )


def _ends() -> tuple[Constant, ...]:
    wide_end = tables.FAR_CELLS[0][1]
    return (
        Constant("REACH", float(REACH), "End of the first polynomial: this A or alpha = 1."),
        Constant(
            "FAR_REACH", float(FAR_REACH), "End of the second polynomial: this A or alpha = 1."
        ),
        Constant("SHORT", sp.Rational(1, SHORT), "Fraction of the first range with the short one."),
        Constant("WIDE_START", float(WIDE_START), "Its start if b/h <= WIDE_END, else REACH."),
        Constant("WIDE_END", float(wide_end), "Largest b/h with the start WIDE_START."),
        Constant("FAR_MIDDLE", float(FAR_MIDDLE), "Middle of its range of A^2 if b/h > FAR_REACH."),
        Constant("FAR_HALF", float(FAR_HALF), "Half the width of that range."),
    )


def _closed_form() -> tuple[Constant, ...]:
    linear, cubic = tables.thin_numbers()
    log = float(cubic_by_log())
    return (
        Constant("LINEAR", linear, "Part of a thin plate's c1 that does not depend on b/h."),
        Constant("CUBIC", cubic, "Part of a thin plate's c3 that does not depend on b/h."),
        Constant(
            "NEAR_BY_LOG",
            REACH**2 * log,
            "Derivative of a thin plate's S_1 with respect to log(b/h).",
        ),
        Constant(
            "FAR_BY_LOG",
            (float(FAR_MIDDLE) * log, float(FAR_HALF) * log),
            "Derivatives with respect to log(b/h) of c3 in S_0 and S_1 of the second polynomial.",
        ),
    )


def _tables() -> tuple[Constant, ...]:
    values = tables.tables()

    def cells(name: str, ranges: tuple[tuple[int, int, int], ...]) -> tuple[object, ...]:
        return tuple(
            (float(first), float(last), np.array(values[f"{name}_{index}"]))
            for index, (first, last, _) in enumerate(ranges)
        )

    def row(name: str) -> np.ndarray:
        return np.array(values[name][0])

    return (
        Constant("THIN", row("thin"), "Phi/A of a thin plate in powers of (A/REACH)^2."),
        Constant("THIN_FAR", row("far_thin"), "Phi/A in powers of (A^2 - FAR_MIDDLE)/FAR_HALF."),
        Constant("EDGE", row("edge"), "W/alpha of the finite radius in powers of alpha^2."),
        Constant("MODES", np.array(values["modes"]), "(8/(3 pi)) g(alpha j_n), likewise, by n."),
        Constant(
            "SHORTENED", np.array(values["short"]), "Omitted powers in the short one's S_0, ..."
        ),
        Constant(
            "CELLS", cells("cell", tables.CELLS), f"Remainder of a thin plate's F/A: {_CELL}."
        ),
        Constant("FAR_CELLS", cells("far", tables.FAR_CELLS), f"F/A on the second range: {_CELL}."),
    )


def _exponents() -> tuple[Constant, ...]:
    table = {name: tuple(map(float, row)) for name, row in exponents().items()}
    laws = np.array([table[name] for name in RESULTS])
    return (
        Constant("RESULTS", tuple(RESULTS), "Results, the first axis of the sensitivities."),
        Constant("PARAMETERS", tuple(map(str, PARAMETERS)), "Parameters, their second axis."),
        Constant("POWERS", laws, "Exponents of R, m, v0, h, b and E* in each result."),
        Constant("ENERGY", np.array(table["energy"]), "The same for the energy number."),
        Constant("ETA", np.array(table["eta"]), "The same for h/b."),
    )
