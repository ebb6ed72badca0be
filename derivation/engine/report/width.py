"""How wide a formula is once typeset: a rough measure, in characters."""

import re

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[{}^_]|\S")
SCRIPT, LEAST = 0.7, 0.5
"""Size of scripts, and of what stands in fractions within fractions, by what is around it."""
NAMED = re.compile(r"\\(?:sin|cos|tan|log|lim|max)h?$|\\coth$")
WIDE = {r"\sum": 2.7, r"\int": 1.9, r"\sqrt": 1.6, r"\quad": 1.9, "(": 0.9, ")": 0.9, ",": 0.6}
NOTHING = re.compile(
    r"&$|\\(?:left|right|mathrm|operatorname|displaystyle|limits|dot|ddot|tilde|bar)$"
)
OPERATORS = frozenset("+-=")
SPACED = 2.6
"""An operator between two numbers, with the space around it."""


def typeset_width(latex: str) -> float:
    """Width of a displayed formula in characters of the line."""
    return _Measure(latex).group(1.0, 0)


class _Measure:
    """A reader of LaTeX that goes through it once."""

    def __init__(self, latex: str) -> None:
        self.tokens = TOKEN.findall(latex)
        self.at = 0

    def group(self, size: float, depth: int) -> float:
        """Width up to the end, or to the brace that closes."""
        total, before = 0.0, "="
        while self.at < len(self.tokens):
            token = self.tokens[self.at]
            if token == "}":
                self.at += 1
                break
            total += self.one(size, depth, before)
            before = token
        return total

    def one(self, size: float, depth: int, before: str) -> float:
        """Width of the next thing: a token, a group, a script or a fraction."""
        token = self.tokens[self.at]
        self.at += 1
        if token == "{":
            return self.group(size, depth)
        if token in ("^", "_"):
            return self.script(max(LEAST, SCRIPT * size), depth)
        if token == r"\frac":
            inner = size if depth == 0 else max(LEAST, SCRIPT * size)
            return max(self.one(inner, depth + 1, "="), self.one(inner, depth + 1, "=")) + 0.5
        if token in OPERATORS:
            alone = before in OPERATORS or before == "("
            return size * (1.0 if alone else SPACED)
        if NOTHING.match(token):
            return 0.0
        return size * (len(token) - 0.6 if NAMED.match(token) else WIDE.get(token, 1.0))

    def script(self, size: float, depth: int) -> float:
        """Width of a sub- or superscript; the second of two stands above the first."""
        first = self.one(size, depth + 1, "=")
        if self.at < len(self.tokens) and self.tokens[self.at] in ("^", "_"):
            self.at += 1
            return max(first, self.one(size, depth + 1, "="))
        return first
