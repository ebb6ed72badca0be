"""Search for larger errors of a paper's functions, with points from their domains."""

import importlib
from collections.abc import Sequence
from random import Random
from typing import Any

from derivation.engine.formula.chain import Chain
from derivation.engine.formula.grid import ATTEMPTS, joint_point
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.measure.check import Judge
from derivation.engine.measure.domain_grid import decades_of, stated_domain
from derivation.engine.measure.kernels import generated_kernels
from derivation.engine.measure.point import Point
from derivation.engine.measure.target import Domain, Target, closed_target, named_targets


def domain_targets(by: Judge, chain: Chain, names: Sequence[str] = ()) -> tuple[Target, ...]:
    """Return the generated functions of a paper: all, or those with the given names.

    Parameters
    ----------
    by
        The references of the paper, and the name of its package.
    chain
        The formulas with their vocabulary.
    names
        Names of the functions; all if empty.

    Raises
    ------
    ValueError
        If no function has one of the names.
    """
    rows = importlib.import_module(f"{by.package}.manifest").KERNELS
    pairs = zip(rows, generated_kernels(by.package), strict=True)
    return named_targets(
        [
            closed_target(
                by,
                stated_domain(row, decades_of(row)),
                kernel,
                _Draw(_words(chain, row), decades_of(row)),
            )
            for row, kernel in pairs
        ],
        names,
    )


def _words(chain: Chain, row: Any) -> Vocabulary:
    formula = chain.formulas().get(row["name"])
    return chain.vocabulary.with_conditions(formula.where if formula else ())


class _Draw:
    """Function that returns a random point, often with extreme or nearly equal arguments."""

    def __init__(self, words: Vocabulary, decades: int) -> None:
        self.words = words
        self.decades = float(decades)

    def __call__(self, domain: Domain, generator: Random) -> Point:
        for _ in range(ATTEMPTS):
            point = Point(joint_point(generator, domain.arguments, self.words, self.decades))
            if domain.holds(point):
                return point
        raise ValueError(
            f"found no point in the domain of {domain.name}: its conditions allow a narrow range "
            "only; correct the domains of its arguments"
        )
