"""Perturbation: the paper's own motion, beside the result and no part of it."""

from derivation.scene.effects.effect import Bound, Effect, Place, none_of
from derivation.scene.model import Model

MODES = 100
"""Where its sums are cut off: they diverge, and the paper does not say where it does."""


class Perturbation(Effect):
    """The linear motion (15) of the first term of a divergent series, and its correction (16)."""

    name = "perturbation"
    adds = "the paper's own motion, to compare"
    equation = "delta = delta_0 + eta, eta' + F eta + G = 0, (14) to (18)"
    number = "t/t_c where (17), (18) break"
    source = "the paper, with gamma_k cut off; links 11, 15 and 16"
    by_itself = False
    compared = True

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Time at which they break, xi_3 as printed, over that of the linear turning point."""
        from generated.perturbation import printed_motion  # costs nothing where it is not wanted

        return printed_motion(*model.numbers, MODES).share

    def bound(self, model: Model, place: Place) -> Bound:  # noqa: ARG002
        """It changes nothing."""
        none = none_of(place.radii)
        return Bound(none, none)
