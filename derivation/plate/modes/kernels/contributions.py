"""One mode's contribution to the interior fields, from its shapes through the thickness."""

from collections.abc import Mapping

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let, Routine, Several, Statement, routine
from derivation.plate.modes.theory.face_conditions import loaded
from derivation.plate.modes.theory.interior import interior_fields
from derivation.plate.modes.theory.loaded_mode import loaded_mode
from derivation.plate.vocabulary import A_j, h, lam, mu, phi, r, z

CONTRIBUTIONS = ("u", "w", "sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
SMALLEST = sp.Rational(1, 2**30)
"""Closer to the axis, J1(y)/y rounds to 1/2."""
POWER_OF_TWO = sp.Function("power_of_two")
ARGUMENTS = (r, z, phi, h, lam, mu, A_j)
y, away, size, unit = sp.symbols("y away size unit", positive=True)
shape, radial, hoop, J, chord, twist = sp.symbols("shape radial hoop J chord twist", real=True)


def _shape(name: str, amplitude: sp.Expr) -> sp.Expr:
    """Return a loaded mode's shape for an amplitude."""
    shapes: Mapping[str, sp.Expr] = {f.name: f.expression for f in loaded_mode()}
    shape: sp.Expr = shapes[name].subs(A_j, amplitude)
    return shape


def _mode(symbol: sp.Symbol, name: str, amplitude: sp.Expr = A_j) -> Several:
    return Several((symbol,), name, (z, phi, h, lam, mu, amplitude), (_shape(name, amplitude),))


def _bessel(order: int, at: sp.Expr) -> Several:
    return Several((J,), f"bessel_j{order}", (at,), (sp.besselj(order, at),))


def _field(name: str) -> sp.Expr:
    """Return the contribution for A_j as derived."""
    fields = {f.name: f.expression for f in interior_fields()}
    return loaded(fields[name])


@named_routine
def chord_and_twist() -> Claims:
    """Return J1(y)/y, which is 1/2 on the axis, and dJ1/dy - J1(y)/y."""

    def without_guard(expression: sp.Expr) -> sp.Expr:
        return sp.simplify(expression.xreplace({sp.Max(y, SMALLEST): y}))

    return Claims(
        (y,),
        (
            Let(away, sp.Max(y, SMALLEST)),
            _bessel(1, away),
            Let(chord, J / away),
            Several((twist,), "bessel_j0", (y,), (sp.besselj(0, y),)),
        ),
        (chord, twist - 2 * chord),
        (
            sp.besselj(1, y) / y,
            sp.besselj(0, y) - 2 * sp.besselj(1, y) / y,
        ),
        {},
        without_guard,
    )


def _plain(name: str, mode: str, order: int, factor: sp.Expr) -> Routine:
    """Return a field that is one shape times J0 or J1; the factor belongs to the amplitude."""
    statements = (_mode(shape, mode, A_j * factor), _bessel(order, phi * r))
    return _routine(name, statements, shape * J)


def _in_plane(name: str, own: sp.Symbol) -> Routine:
    """Return an in-plane stress, the sum of two terms, with as few roundings as possible.

    It is small where Poisson's ratio is almost -1. Both terms contain a power of two as amplitude.
    """
    at = phi * r
    J0, J1 = sp.besselj(0, at), sp.besselj(1, at)
    statements = (
        Several((chord, twist), "chord_and_twist", (at,), (J1 / at, J0 - 2 * J1 / at)),
        Let(unit, POWER_OF_TWO(A_j), "exact scaling", opaque=True),
        _mode(radial, "mode_rr", unit),
        _mode(hoop, "mode_tt", unit),
        Let(size, A_j / unit),
    )
    return _routine(name, statements, ((radial + hoop) * chord + own * twist) * size)


def _routine(name: str, statements: tuple[Statement, ...], result: sp.Expr) -> Routine:
    meaning = {f.name: f.meaning for f in interior_fields()}[name]
    return routine(
        f"{name}_of_mode",
        ARGUMENTS,
        statements,
        (result,),
        (_field(name),),
        f"Return one mode's contribution to the {meaning}, under A_j.",
        {},
        sp.simplify,
    )


def contributions() -> Routines:
    """Return the module of these contributions."""
    routines = (
        chord_and_twist(),
        _plain("u", "mode_g", 1, phi),  # g phi may be a normal number where g is subnormal
        _plain("w", "mode_f", 0, sp.Integer(1)),
        _in_plane("sigma_rr", radial),
        _in_plane("sigma_tt", hoop),
        _plain("sigma_zz", "mode_zz", 0, sp.Integer(1)),
        _plain("sigma_rz", "mode_rz", 1, sp.Integer(1)),
    )
    imports = {
        "bessel": ("bessel_j0", "bessel_j1"),
        "mode_shapes": ("mode_f", "mode_g", "mode_rr", "mode_rz", "mode_tt", "mode_zz"),
        "mode_sums": ("power_of_two",),
    }
    title = "Contributions of one mode to the interior fields."
    return Routines("mode_contributions", title, routines, imports)
