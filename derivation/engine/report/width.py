"""How wide a displayed formula is once typeset, in points of TeX's fonts at ten points."""

import re

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[{}^_&]|\S")
SMALLER = {1.0: 0.8, 0.8: 0.68, 0.68: 0.68}
"""Size of scripts, and of what stands in fractions within fractions, by what is around it."""
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
"""Widths of letters and signs; any other one, such as a digit, is OTHER wide."""
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
    """Width of a displayed formula [pt]."""
    return _Measure(latex).group(1.0, 0)


class _Measure:
    """A reader of LaTeX that goes through it once."""

    def __init__(self, latex: str) -> None:
        self.tokens = TOKEN.findall(latex)
        self.at = 0

    def group(self, size: float, depth: int) -> float:
        """Width up to the end, or to the brace or the bracket that closes."""
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
        """Width of the next thing: a token, a group, a script, a fraction or a bracket."""
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
        """Width of a letter or a sign with the space around it."""
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
        """Width from a bracket to the one that closes it, which grow with what is between."""
        start = self.at
        self.at += 1
        inside = self.group(size, depth)
        tall = self.tall(start)
        self.at += 2
        return inside + 2 * (TALL_BRACKET if tall else size * WIDTH["("]) + THIN

    def tall(self, start: int) -> bool:
        """Whether something tall was read since a place."""
        return not {r"\frac", r"\sum", r"\int"}.isdisjoint(self.tokens[start : self.at])

    def big(self, own: float, size: float, depth: int) -> float:
        """Width of a sign of a sum or an integral, whose limits stand above and below it."""
        limits = own == BIG[r"\sum"]
        if self.at < len(self.tokens) and self.tokens[self.at] == r"\limits":
            limits, self.at = True, self.at + 1
        scripts = 0.0
        if self.at < len(self.tokens) and self.tokens[self.at] in ("^", "_"):
            self.at += 1
            scripts = self.script(SMALLER[size], depth)
        return (max(own, scripts) if limits else own + scripts) + 2 * THIN

    def script(self, size: float, depth: int) -> float:
        """Width of a sub- or superscript; the second of two stands above the first."""
        width = self.one(size, depth + 1, "=")
        if self.at < len(self.tokens) and self.tokens[self.at] in ("^", "_"):
            self.at += 1
            width = max(width, self.one(size, depth + 1, "="))
        return width + SCRIPT_SPACE
