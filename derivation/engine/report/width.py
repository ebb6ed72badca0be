"""Estimated width of a displayed formula, in points, typeset by TeX at ten points."""

import re

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[{}^_&]|\S")
SMALLER = {1.0: 0.8, 0.8: 0.68, 0.68: 0.68}
"""Relative size of scripts and of nested fractions, by the size around them."""
GLYPHS = {
    2.8: ". ! ' [ ] | \\cdot \\prime \\vert \\lvert \\rvert",
    3.9: "j i l t ( ) \\iota \\delta \\ell",
    4.7: "b c e g o q r s \\epsilon \\varepsilon \\xi \\theta \\tfrac",
    5.3: "a d p v y z k n I \\beta \\partial \\zeta \\eta \\nu \\rho \\tau \\tilde",
    6.1: "f h u x J \\alpha \\gamma \\kappa \\lambda \\mu \\pi \\sigma \\phi \\chi \\Gamma",
    7.2: "w L S T Z \\psi \\omega \\Omega \\Phi",
    8.2: "m A B C D E F G O P Q R U V Y \\Delta",
    9.5: "H K M N W X \\infty \\ldots \\mathcal",
}
"""Letters and signs by their width [pt]; any other one, such as a digit, has the width `OTHER`."""
WIDTH = {glyph: width for width, glyphs in GLYPHS.items() for glyph in glyphs.split()}
OTHER, ROMAN = 5.0, 4.7
BIG = {r"\sum": 14.5, r"\int": 10.0}
NAMED = re.compile(r"\\(?:sin|cos|tan|cot|log|lim|max|min|exp)h?$")
NOTHING = re.compile(r"[&{}]$|\\(?:mathrm|operatorname|displaystyle|limits|d?dot|bar|right|left)$")
SPACES = {r"\,": 1.7, r"\;": 2.8, r"\ ": 3.4, r"\quad": 10.0, r"\qquad": 20.0, ",": 4.5}
RELATIONS, OPERATORS = {"=": 13.4, "<": 13.4, r"\to": 15.6}, {"+": 12.3, "-": 12.3}
SIGN, THIN, SCRIPT_SPACE, AROUND_FRACTION = 7.8, 1.7, 0.5, 2.4
ROOT, TALL_ROOT, TALL_BRACKET = 8.4, 10.0, 6.6


def typeset_width(latex: str) -> float:
    """Return the estimated width of a displayed formula [pt]."""
    return _Measure(latex).group(1.0, 0)


class _Measure:
    """Sum of widths in one pass over the tokens of a formula."""

    def __init__(self, latex: str) -> None:
        self.tokens = TOKEN.findall(latex)
        self.at = 0

    def group(self, size: float, depth: int) -> float:
        """Return the width up to the end, or to the closing brace or bracket."""
        total, before = 0.0, "="
        while self.at < len(self.tokens):
            token = self.tokens[self.at]
            if token == "}":
                self.at += 1
                break
            if token == r"\right":
                break
            total += self.one(size, depth, before)
            before = token
        return total

    def one(self, size: float, depth: int, before: str) -> float:
        """Return the width of the next token, group, script, fraction or bracket."""
        token = self.tokens[self.at]
        self.at += 1
        if token == "{":
            return self.group(size, depth)
        if token in ("^", "_"):
            return self.script(SMALLER[size], depth)
        if token in (r"\frac", r"\tfrac"):
            inner = size if depth == 0 and token == r"\frac" else SMALLER[size]
            parts = [self.one(inner, depth + 1, "=") for _ in range(2)]
            return max(parts) + AROUND_FRACTION + THIN
        if token == r"\left":
            return self.bracket(size, depth)
        if token == r"\sqrt":
            start = self.at
            inside = self.one(size, depth, "=")
            return inside + size * (TALL_ROOT if self.tall(start) else ROOT)
        if token in BIG:
            return self.big(BIG[token], size, depth)
        return self.glyph(token, size, before)

    def glyph(self, token: str, size: float, before: str) -> float:
        """Return the width of a letter or a sign with the space around it."""
        if token in OPERATORS:
            alone = before in OPERATORS or before in RELATIONS or before in ("(", r"\left", ",")
            return size * (SIGN if alone or size < 1 else OPERATORS[token])
        if token in RELATIONS:
            return RELATIONS[token] if size == 1 else size * SIGN
        if NOTHING.match(token):
            return 0.0
        if NAMED.match(token):
            return size * (ROMAN * (len(token) - 1)) + THIN
        return size * SPACES.get(token, WIDTH.get(token, OTHER))

    def bracket(self, size: float, depth: int) -> float:
        """Return the width of a pair of brackets, which grow with their content, and content."""
        start = self.at
        self.at += 1
        inside = self.group(size, depth)
        tall = self.tall(start)
        self.at += 2
        return inside + 2 * (TALL_BRACKET if tall else size * WIDTH["("]) + THIN

    def tall(self, start: int) -> bool:
        """Return whether a fraction, sum or integral was read since a position."""
        return not {r"\frac", r"\sum", r"\int"}.isdisjoint(self.tokens[start : self.at])

    def big(self, own: float, size: float, depth: int) -> float:
        """Return the width of a sum or integral sign with its limits."""
        limits = own == BIG[r"\sum"]
        if self.at < len(self.tokens) and self.tokens[self.at] == r"\limits":
            limits, self.at = True, self.at + 1
        scripts = 0.0
        if self.at < len(self.tokens) and self.tokens[self.at] in ("^", "_"):
            self.at += 1
            scripts = self.script(SMALLER[size], depth)
        return (max(own, scripts) if limits else own + scripts) + 2 * THIN

    def script(self, size: float, depth: int) -> float:
        """Return the width of a sub- or superscript; a second one has the same position."""
        width = self.one(size, depth + 1, "=")
        if self.at < len(self.tokens) and self.tokens[self.at] in ("^", "_"):
            self.at += 1
            width = max(width, self.one(size, depth + 1, "="))
        return width + SCRIPT_SPACE
