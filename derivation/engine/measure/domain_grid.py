"""References and test points of a paper whose functions have closed formulas."""

from collections.abc import Callable, Mapping, Sequence

from derivation.engine.formula.chain import Chain
from derivation.engine.formula.grid import domain_grid, inside
from derivation.engine.measure.check import Judge
from derivation.engine.measure.point import Point
from derivation.engine.oracle.agreement import Route, Routes
from derivation.engine.oracle.oracle import Balls
from derivation.engine.rewrite.blocks import Definition, build_blocks
from derivation.engine.rewrite.form import switch_points


def domain_judge(
    chain: Chain,
    routes: Mapping[str, Route],
    package: str,
    blocks: tuple[Definition, ...],
    easy: Callable[[Point], bool],
) -> Judge:
    """Return references and test points of closed formulas, with points from their domains.

    Parameters
    ----------
    chain
        The formulas with their vocabulary.
    routes
        For each formula, an independent method for its value in mpmath; a formula without one is
        evaluated as derived.
    package
        Import name of the generated package.
    blocks
        Building blocks of the forms; points next to their switch points are tested.
    easy
        Function that returns whether such a method is fast at a point.

    Returns
    -------
    Judge
        The references and test points, without hard cases.
    """
    vocabulary = chain.vocabulary

    def grid(name: str, arguments: Sequence[str], _: bool) -> tuple[Point, ...]:
        switches = switch_points(block.value for block in build_blocks(blocks).values())
        return tuple(map(Point, domain_grid(name, arguments, vocabulary, switches)))

    references = Routes(Balls(vocabulary, chain.formulas), routes)
    return Judge(references, grid, package, easy, lambda point: inside(vocabulary, point.values))
