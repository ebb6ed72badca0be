"""Held plates with a thickness: printed functions as text, and what they promise."""

import textwrap
from collections.abc import Mapping

from derivation.engine.emit.kernels import lines
from derivation.engine.emit.printer import to_numpy
from derivation.plate.edge_modes.kernels.wave_forms import WaveBlock
from derivation.plate.edge_modes.kernels.wave_tables import held_wave_context


def held_waves_context(promised: Mapping[str, float]) -> dict[str, object]:
    """What the template needs, as text."""
    found = held_wave_context()
    blocks, cutoff = found.pop("blocks"), found.pop("cutoff")
    assert isinstance(blocks, tuple)
    return found | {
        "functions": [_text(block) for block in blocks],
        "cutoff": to_numpy(cutoff),
        "promises": _promises(promised),
    }


def _text(block: WaveBlock) -> dict[str, object]:
    return {
        "name": block.name,
        "arguments": ", ".join(f"{argument}: Double" for argument in block.arguments),
        "summary": block.summary,
        "steps": lines(block.steps),
        "results": ", ".join(to_numpy(value) for value in block.results),
        "comma": "," if len(block.results) == 1 else "",
    }


def _promises(promised: Mapping[str, float]) -> list[str]:
    """Tested limits as lines of a docstring."""
    numbers = ", ".join(f"{name} {ulp:g}" for name, ulp in promised.items() if name != "face")
    text = (
        f"Tested error limits in units in the last place (ULP): {numbers}; of c in those of "
        "c (1 + k), of k2 in those of k^2/k2, of t in those of max(1, |t|). Half the sum of the "
        "condition numbers of eta and nu is allowed on top. A mode whose x = k eta is within a "
        "few ULP of the cut-off may be missing or there."
    )
    return textwrap.wrap(text, 84)
