"""Messages for scene files that are not valid TOML: the line and how to write it."""

import re
import tomllib

ORDINARY = "write each line as `key = value`, such as `radius = 0.13`"
REPEATED = ("Cannot overwrite", "Cannot declare")
"""Beginnings of messages about a key or a table that the file has twice."""
REMEDIES = {
    r"^\[[^]]*$|^[^[=]*\]$": "write the name of a table as `[sphere]`",
    r'=\s*"[^"]*$': 'end text with a quote, such as `material = "steel"`',
    r"=\s*[-+]?\d+,\d": "write numbers with a decimal point",
    r"=\s*[A-Za-z_]": 'put text in quotes, such as `material = "steel"`',
    r"=\s*[-+]?[\d.]+(e[-+]?\d+)?\s*[A-Za-z]+": "write numbers in SI units without the unit",
}
"""What to write instead, by regular expressions of common mistakes in a line."""


def in_words(error: tomllib.TOMLDecodeError, text: str) -> str:
    """Return the problem, the line and what to write, for a text that is not TOML."""
    place = re.search(r"\(at line (\d+)", str(error))
    lines = text.splitlines()
    if place is None or int(place[1]) > len(lines):
        return f"{error}; {ORDINARY}"
    line = lines[int(place[1]) - 1].split("#")[0].strip()[:80]
    remedies = (remedy for mistake, remedy in REMEDIES.items() if re.search(mistake, line))
    repeated = str(error).startswith(REPEATED)
    remedy = "give each key and table once" if repeated else next(remedies, ORDINARY)
    return f"{error}, in `{line}`; {remedy}"
