"""Constants for the generated contact law: tables, ends of ranges, exponents."""

import numpy as np
import sympy as sp

from derivation.engine.emit.package import Numbers
from derivation.engine.emit.tables import Constant
from derivation.plate.contact.kernels import tables
from derivation.plate.contact.kernels.series import cubic_by_log
from derivation.plate.contact.kernels.tables import FAR_REACH, REACH, SHORT, WIDE_START
from derivation.plate.impact.theory.sensitivity import PARAMETERS, RESULTS, exponents

FAR_MIDDLE = sp.Rational(FAR_REACH**2 + REACH**2, 2)
FAR_HALF = sp.Rational(FAR_REACH**2 - REACH**2, 2)
_CELL = "ends in b/h, then rows by powers of b/h, scaled to [-1, 1]"


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
        Constant("REACH", float(REACH), "The first polynomial ends at A = REACH or alpha = 1."),
        Constant("FAR_REACH", float(FAR_REACH), "The second one at A = FAR_REACH or alpha = 1."),
        Constant("SHORT", sp.Rational(1, SHORT), "Up to this share of its reach a short one does."),
        Constant("WIDE_START", float(WIDE_START), "Where the second begins if b/h <= WIDE_END."),
        Constant("WIDE_END", float(wide_end), "Up to this b/h its range begins at WIDE_START."),
        Constant("FAR_MIDDLE", float(FAR_MIDDLE), "Middle of the range of A^2 of the second."),
        Constant("FAR_HALF", float(FAR_HALF), "Half of that range."),
    )


def _closed_form() -> tuple[Constant, ...]:
    linear, cubic = tables.thin_numbers()
    log = float(cubic_by_log())
    return (
        Constant("LINEAR", linear, "What of c1 of a thin plate does not depend on it."),
        Constant("CUBIC", cubic, "What of c3 does not."),
        Constant("NEAR_BY_LOG", REACH**2 * log, "How S_1 of a thin plate grows with log(b/h)."),
        Constant(
            "FAR_BY_LOG",
            (float(FAR_MIDDLE) * log, float(FAR_HALF) * log),
            "How c3 makes S_0 and S_1 of the second polynomial grow with it.",
        ),
    )


def _tables() -> tuple[Constant, ...]:
    found = tables.tables()

    def cells(name: str, ranges: tuple[tuple[int, int, int], ...]) -> tuple[object, ...]:
        return tuple(
            (float(first), float(last), np.array(found[f"{name}_{index}"]))
            for index, (first, last, _) in enumerate(ranges)
        )

    def row(name: str) -> np.ndarray:
        return np.array(found[name][0])

    return (
        Constant("THIN", row("thin"), "Phi/A of a thin plate in powers of (A/REACH)^2."),
        Constant("THIN_FAR", row("far_thin"), "The same in powers of (A^2 - FAR_MIDDLE)/FAR_HALF."),
        Constant("EDGE", row("edge"), "The edge's part W/alpha in powers of alpha^2."),
        Constant("MODES", np.array(found["modes"]), "(8/(3 pi)) g(alpha j_n), for every mode."),
        Constant("SHORTENED", np.array(found["short"]), "What powers left out add to S_0, ..."),
        Constant("CELLS", cells("cell", tables.CELLS), f"What thin plates lack of F/A: {_CELL}."),
        Constant("FAR_CELLS", cells("far", tables.FAR_CELLS), f"F/A from A = REACH on: {_CELL}."),
    )


def _exponents() -> tuple[Constant, ...]:
    table = {name: tuple(map(float, row)) for name, row in exponents().items()}
    laws = np.array([table[name] for name in RESULTS])
    return (
        Constant("RESULTS", tuple(RESULTS), "What the first axis of the sensitivities counts."),
        Constant("PARAMETERS", tuple(map(str, PARAMETERS)), "What their second axis counts."),
        Constant("POWERS", laws, "Powers of R, m, v0, h, b and E* in every result."),
        Constant("ENERGY", np.array(table["energy"]), "The same in the energy number."),
        Constant("ETA", np.array(table["eta"]), "The same in h/b."),
    )
