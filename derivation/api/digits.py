"""Contact law and impact of a scene to many digits."""

from numbers import Integral

from derivation.checks import many_digits
from derivation.checks.paper_law import in_doubles
from derivation.plate.impact.oracle.many_digits import ImpactReference
from derivation.scene.scene import Scene, check_scene


def reference(scene: Scene, digits: int = 50) -> ImpactReference:
    """Compute contact law and impact to many digits by two independent methods (Arb and mpmath).

    Both start from the same doubles R, m, v0, h, b, lambda and mu, taken as exact. Mass and Lame
    constants that follow from other keys are rounded to doubles first.

    Parameters
    ----------
    scene
        A quasi-static impact that the paper's contact law describes.
    digits
        Number of significant digits, from 1 to 1000.

    Returns
    -------
    derivation.plate.impact.oracle.many_digits.ImpactReference
        Certified values in SI units, and the number of digits on which both methods agree.

    Raises
    ------
    derivation.scene.SceneError
        If the scene requires an effect beyond that law, disables a part of that law, or exceeds its
        range.
    ValueError
        If `digits` is not between 1 and 1000, or the methods do not reach this number of digits.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.read({
    ...     "sphere": {"radius": 0.13, "mass": 0.1},
    ...     "plate": {"radius": 0.1, "thickness": 0.02, "lame_lambda": 0.36e9, "lame_mu": 0.43e9},
    ...     "impact": {"speed": 0.1},
    ...     "effects": {
    ...         "inertia": False, "spherical_profile": False, "non_hertzian_pressure": False,
    ...     },
    ... })
    >>> pc.reference(scene, digits=30).agrees
    True
    """
    check_scene(scene)
    if not (isinstance(digits, Integral) and 1 <= digits <= 1000):
        raise ValueError(
            f"digits: expected a whole number from 1 to 1000, got {digits!r:.60}; change it"
        )
    return many_digits.reference(in_doubles(scene), digits, lambda *_: None)
