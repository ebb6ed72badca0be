"""Compares a result with the paper's own motion, (14) to (18): only where a scene asks for it."""

import math
from dataclasses import asdict, dataclass
from html import escape
from typing import Any

from derivation.engine.text import aligned, paragraph
from derivation.scene.html import html_table
from derivation.scene.model import Model
from generated.perturbation import PrintedMotion, printed_motion

HEADS = (
    "motion", "#time [s]", "#difference", "#indentation [m]", "#difference",
    "#valid until [s]", "#t/t_c",
)  # fmt: skip
"""Heads of the table."""
QUANTITIES = (
    "contact time [s]", "its difference", "max indentation [m]", "its difference",
    "valid until [s]", "valid until t/t_c",
)  # fmt: skip
MOTIONS = "quantity", "#linear term (15)", "#as published", "#corrected"
"""Lines and heads of the table on a screen."""
MODES = 100
"""Number of modes in the paper's sums: they diverge, and the paper gives no truncation."""


@dataclass(frozen=True)
class PaperMotion:
    """One of the paper's motions.

    Attributes
    ----------
    name
        Which one.
    contact_time
        Contact time [s]; None of a correction that breaks before it has a turning point.
    max_indentation
        Largest indentation [m]; of a correction up to where it breaks.
    contact_time_difference, max_indentation_difference
        The same over the result's, less 1 [1].
    breaks_at
        Time at which the radicand of (17), (18) vanishes [s]; None if none does.
    share
        The same over t_c, the time at which the linear motion turns [1].

    What is no number is None.
    """

    name: str
    contact_time: float | None
    max_indentation: float | None
    contact_time_difference: float | None
    max_indentation_difference: float | None
    breaks_at: float | None
    share: float | None

    def cells(self) -> tuple[str, ...]:
        """The motion as it is shown."""
        return (
            self.name,
            _shown(self.contact_time, ".4g"),
            _shown(self.contact_time_difference, "+.2%"),
            _shown(self.max_indentation, ".4g"),
            _shown(self.max_indentation_difference, "+.2%"),
            _shown(self.breaks_at, ".4g"),
            _shown(self.share, ".3g"),
        )


@dataclass(frozen=True)
class Comparison:
    """The paper's motions beside a result.

    Attributes
    ----------
    modes
        Where their sums, which diverge, are cut off.
    motions
        The linear term, and its correction as printed and as corrected.
    """

    modes: int
    motions: tuple[PaperMotion, ...]

    @property
    def title(self) -> str:
        """What the table shows."""
        return f"The paper's own motion, (15) to (18), its sums truncated after {self.modes} modes"

    @property
    def note(self) -> str:
        """How to read it."""
        return (
            "For comparison only: the sums diverge. A correction is valid only up to t/t_c of the "
            "linear motion's time to its turning point. The indentation still grows there, so the "
            "correction has no contact time; its largest indentation is the last valid one."
        )

    def lines(self) -> list[tuple[str, ...]]:
        """A line for each motion, to be read by people."""
        return [motion.cells() for motion in self.motions]

    def to_text(self) -> str:
        """The motions side by side for a screen, a line for each quantity."""
        _, *columns = zip(*self.lines(), strict=True)
        rows = [[name, *cells] for name, cells in zip(QUANTITIES, columns, strict=True)]
        table = aligned(MOTIONS, rows)
        return f"{paragraph(self.title, 0)}\n\n{table}\n\n{paragraph(self.note, 0)}"

    def to_json(self) -> dict[str, Any]:
        """The comparison under fixed keys."""
        return {"modes": self.modes, "motions": [asdict(motion) for motion in self.motions]}

    def to_html(self) -> str:
        """The table for a notebook."""
        table = html_table(HEADS, self.lines())
        return f"<p>{escape(self.title)}</p>{table}<p>{escape(self.note)}</p>"

    _repr_html_ = to_html


def compare(model: Model, contact_time: float, max_indentation: float) -> Comparison:
    """The paper's motions beside a contact time [s] and a largest indentation [m]."""

    def motion_of(name: str, time: float, depth: float, at: float, share: float) -> PaperMotion:
        off = time / contact_time - 1.0, depth / max_indentation - 1.0
        return PaperMotion(name, *map(_number, (time, depth, *off, at, share)))

    printed, derived = (printed_motion(*model.numbers, MODES, corrected=c) for c in (False, True))
    linear = motion_of(
        "linear term (15)", printed.contact_time, printed.max_indentation, math.nan, math.nan
    )

    def broken(name: str, motion: PrintedMotion) -> PaperMotion:
        end = motion.breaks_at
        return motion_of(name, math.nan, float(motion.corrected(end)), end, motion.share)

    rows = broken("as published, (16)-(18)", printed), broken("corrected, (16)-(18)", derived)
    return Comparison(MODES, (linear, *rows))


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _shown(value: float | None, how: str) -> str:
    return "n/a" if value is None else format(value, how)
