"""Compares a result with the paper's approximate motion, equations (14) to (18), on request."""

import math
from dataclasses import asdict, dataclass
from html import escape
from typing import Any

from derivation.engine.text import aligned, paragraph
from derivation.scene.model import Model
from derivation.scene.output.html import html_table
from generated.perturbation import PrintedMotion, printed_motion

HEADS = (
    "motion", "#time [s]", "#difference", "#indentation [m]", "#difference",
    "#valid until [s]", "#t/t_c",
)  # fmt: skip
"""Column heads of the table."""
QUANTITIES = (
    "contact time [s]", "its difference", "max indentation [m]", "its difference",
    "valid until [s]", "valid until t/t_c",
)  # fmt: skip
MOTIONS = "quantity", "#linear term (15)", "#as published", "#corrected"
"""Column heads of the table as text."""
OLD_NAMES = {"breaks_at": "valid_until", "share": "valid_fraction"}
"""Old name of an attribute -> new name."""
MODES = 100
"""Number of modes in the paper's sums, which diverge; the paper does not state the truncation."""


@dataclass(frozen=True)
class PaperMotion:
    """One of the paper's approximations of the motion.

    Attributes
    ----------
    name
        Its name.
    contact_time
        Contact time [s]; None if the motion becomes invalid before its turning point.
    max_indentation
        Largest indentation [m] while the motion is valid.
    contact_time_difference, max_indentation_difference
        Relative differences from the result of the simulation [1].
    valid_until
        Time [s] at which the radicand of (17) and (18) vanishes, and the motion becomes invalid;
        None if it stays valid.
    valid_fraction
        `valid_until` divided by t_c, the time of the turning point of the linear motion [1].

    Values that are not finite are None.
    """

    name: str
    contact_time: float | None
    max_indentation: float | None
    contact_time_difference: float | None
    max_indentation_difference: float | None
    valid_until: float | None
    valid_fraction: float | None

    def __getattr__(self, name: str) -> Any:
        """Raise an error that names the new name of an attribute."""
        hint = f"; it is now called {OLD_NAMES[name]}" if name in OLD_NAMES else ""
        raise AttributeError(f"PaperMotion has no attribute {name}{hint}")

    def cells(self) -> tuple[str, ...]:
        """Return the cells of the motion."""
        return (
            self.name,
            _shown(self.contact_time, ".4g"),
            _shown(self.contact_time_difference, "+.2%"),
            _shown(self.max_indentation, ".4g"),
            _shown(self.max_indentation_difference, "+.2%"),
            _shown(self.valid_until, ".4g"),
            _shown(self.valid_fraction, ".3g"),
        )


@dataclass(frozen=True)
class Comparison:
    """The paper's approximations of the motion, compared with a result.

    Attributes
    ----------
    modes
        Number of modes after which their sums, which diverge, are truncated.
    motions
        The linear term, and its correction as published and with the misprints fixed.
    """

    modes: int
    motions: tuple[PaperMotion, ...]

    @property
    def title(self) -> str:
        """The title of the table."""
        return f"Motion by the paper's equations (15) to (18), truncated after {self.modes} modes"

    @property
    def note(self) -> str:
        """A note on how to read the table."""
        return (
            "For comparison only: the sums diverge. The correction is valid only up to the stated "
            "fraction of t_c, the time of the turning point of the linear motion. The indentation "
            "is still growing at that time, so that the correction has no contact time; the "
            "largest indentation is that at the end of its validity."
        )

    def lines(self) -> list[tuple[str, ...]]:
        """Return the cells of all motions."""
        return [motion.cells() for motion in self.motions]

    def to_text(self) -> str:
        """Return the motions side by side as text, a row for each quantity."""
        _, *columns = zip(*self.lines(), strict=True)
        rows = [[name, *cells] for name, cells in zip(QUANTITIES, columns, strict=True)]
        table = aligned(MOTIONS, rows)
        return f"{paragraph(self.title, 0)}\n\n{table}\n\n{paragraph(self.note, 0)}"

    def to_json(self) -> dict[str, Any]:
        """Return the comparison under fixed keys."""
        return {"modes": self.modes, "motions": [asdict(motion) for motion in self.motions]}

    def to_html(self) -> str:
        """Return the table for a notebook."""
        table = html_table(HEADS, self.lines())
        return f"<p>{escape(self.title)}</p>{table}<p>{escape(self.note)}</p>"

    _repr_html_ = to_html


def compare(model: Model, contact_time: float, max_indentation: float) -> Comparison:
    """Compare the paper's motions with a contact time [s] and a largest indentation [m]."""

    def motion_of(name: str, time: float, depth: float, at: float, part: float) -> PaperMotion:
        off = time / contact_time - 1.0, depth / max_indentation - 1.0
        return PaperMotion(name, *map(_number, (time, depth, *off, at, part)))

    printed, derived = (printed_motion(*model.numbers, MODES, corrected=c) for c in (False, True))
    linear = motion_of(
        "linear term (15)", printed.contact_time, printed.max_indentation, math.nan, math.nan
    )

    def broken(name: str, motion: PrintedMotion) -> PaperMotion:
        end = motion.valid_until
        return motion_of(name, math.nan, float(motion.corrected(end)), end, motion.valid_fraction)

    rows = broken("as published, (16)-(18)", printed), broken("corrected, (16)-(18)", derived)
    return Comparison(MODES, (linear, *rows))


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _shown(value: float | None, how: str) -> str:
    return "n/a" if value is None else format(value, how)
