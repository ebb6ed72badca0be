"""Hertz: local indentation of a half-space by a paraboloid."""

from derivation.scene.effects.effect import Effect
from derivation.scene.model import Model


class Hertz(Effect):
    """Hertz's law, delta = a^2/R and P = (4/3) E* a^3/R, to which all other effects are added."""

    name = "hertz"
    adds = "local indentation of a half-space"
    equation = "delta = a^2/R, P = (4/3) E* a^3/R"
    parameter = "a/R"
    source = "Hertz 1881; step 8"
    always_included = True
    hertzian = True

    def value(self, model: Model, a: float) -> float:
        """Return contact radius over sphere radius."""
        return a / model.R
