"""The double nearest to a root, compared with `math.sqrt`, which rounds correctly."""

import math

import flint
import pytest

from derivation.engine.formula.ball import to_ball
from derivation.engine.measure.neighbours import nearest_root


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("square", [*range(2, 16), 15.999999999999998])
def test_nearest_root_is_the_rounded_square_root(square: float, sign: int) -> None:
    with flint.ctx.workprec(200):
        root = nearest_root(lambda x: sign * (to_ball(x) ** 2 - square), 1.0, 4.0)
        bent = nearest_root(lambda x: sign * (1 - square / to_ball(x) ** 2), 1.0, 4.0)
    assert root == bent == math.sqrt(square)


def test_a_function_of_one_sign_is_rejected() -> None:
    with pytest.raises(ValueError, match=r"the same sign at 1.0 and 4.0"):
        nearest_root(lambda x: to_ball(x) ** 2 + 1, 1.0, 4.0)
