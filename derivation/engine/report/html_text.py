"""Words in the LaTeX of the report's templates -> HTML; anything else in it is refused."""

import re
from collections.abc import Callable, Iterator, Mapping

from markupsafe import Markup, escape

from derivation.engine.report.mathml import mathml

SYMBOLS = {
    ",": "\u2009", " ": " ", "%": "%", "&": "&", "#": "#", "$": "$", "_": "_", "{": "{", "}": "}",
    "-": "", "ldots": "…", "quad": "\u2003", "textbackslash": "\\", "textasciitilde": "~",
    "textasciicircum": "^", "textless": "<", "textgreater": ">",
}  # fmt: skip
TAGS = {"emph": "em", "textbf": "strong", "textit": "em", "texttt": "code"}
DROPPED = {"normalfont", "strut", "small"}
_TOKEN = re.compile(
    r"(?P<comment>(?<!\\)%[^\n]*\n?)|(?<!\\)\$(?P<math>[^$]*)\$|\\(?P<command>[A-Za-z]+|.)"
    r"|(?P<open>\{)|(?P<tie>~)|(?P<dash>--)|(?P<plain>[^\\{}$~%-]+|-)",
    re.DOTALL,
)
_BOUND = re.compile(r"(<math>(?:(?!</math>).)*</math>[.,;:)\]]+)", re.DOTALL)
"""A formula and the point or comma behind it, which stay on its line."""


class HtmlError(ValueError):
    """The report's LaTeX holds a command that has no counterpart in HTML here."""


def argument(text: str, start: int) -> tuple[str, int]:
    """What stands in braces from a place on, and where they end.

    Raises
    ------
    HtmlError
        If there are none, or they are not closed.
    """
    depth = 0
    braces = re.compile(r"\\.|[{}]", re.DOTALL)
    for match in braces.finditer(text, start) if text.startswith("{", start) else ():
        depth += {"{": 1, "}": -1}.get(match[0], 0)
        if depth == 0:
            return text[start + 1 : match.start()], match.end()
    raise HtmlError(f"expected an argument in braces, got {text[start : start + 30]!r}")


def parts(text: str, separator: str) -> Iterator[str]:
    """A text cut at a separator that stands outside of braces and of mathematics."""
    pattern = re.compile(rf"{separator}|\\.|[{{}}$]", re.DOTALL)
    depth, formula, last = 0, False, 0
    for match in pattern.finditer(text):
        if match[0] == "$":
            formula = not formula
        elif match[0] in "{}":
            depth += 1 if match[0] == "{" else -1
        elif depth == 0 and not formula and re.fullmatch(separator, match[0]):
            yield text[last : match.start()]
            last = match.end()
    yield text[last:]


class Words:
    """Reads words: symbols, formulas, references to equations, sections and sources.

    Parameters
    ----------
    numbers
        Number by label of what can be referred to.
    sources
        Number by key of what can be cited.
    """

    def __init__(self, numbers: Mapping[str, str], sources: Mapping[str, int]) -> None:
        self.numbers, self.sources = numbers, sources
        self.special: dict[str, Callable[[str], Markup]] = {
            "ref": self._reference,
            "cite": self._citation,
            "bibitem": lambda _: Markup(""),
        }

    def read(self, text: str) -> Markup:
        """A paragraph's or a cell's text as HTML.

        Raises
        ------
        HtmlError
            If it holds a command that is not known.
        """
        pieces: list[Markup] = []
        place = 0
        while place < len(text):
            match = _TOKEN.match(text, place)
            if match is None:
                raise HtmlError(f"no HTML for {text[place : place + 30]!r}")
            place = match.end()
            if match["open"]:
                inner, place = argument(text, match.start())
                pieces.append(self.read(inner))
            elif match["command"]:
                piece, place = self._command(match["command"], text, place)
                pieces.append(piece)
            elif match["math"] is not None:
                pieces.append(mathml(match["math"]))
            else:
                pieces.append(_plain(match))
        whole = str(Markup("").join(pieces))
        return Markup(_BOUND.sub(r"<span>\1</span>", whole))  # escaped above

    def _command(self, name: str, text: str, place: int) -> tuple[Markup, int]:
        """A command whose arguments, if any, follow at a place; and where they end."""
        if name in TAGS:
            inner, place = argument(text, place)
            tag = TAGS[name]
            return Markup("<{0}>{1}</{0}>").format(Markup(tag), self.read(inner)), place
        if name in self.special:
            inner, place = argument(text, place)
            return self.special[name](inner), place
        if name == "allowbreak":
            return Markup("<wbr>"), place
        if name in SYMBOLS:
            return escape(SYMBOLS[name]), place
        if name in DROPPED:
            return Markup(""), place
        raise HtmlError(f"no HTML for \\{name} in {text[max(0, place - 30) : place + 30]!r}")

    def _reference(self, label: str) -> Markup:
        return Markup('<a href="#{}">{}</a>').format(anchor(label), self.numbers[label])

    def _citation(self, keys: str) -> Markup:
        links = (
            Markup('<a href="#source-{}">{}</a>').format(key, self.sources[key])
            for key in keys.split(",")
        )
        return Markup("[{}]").format(Markup(", ").join(links))


def _plain(match: re.Match[str]) -> Markup:
    if match["comment"]:
        return Markup("")
    if match["tie"]:
        return Markup("&nbsp;")
    return escape("\u2013" if match["dash"] else match["plain"] or "")


def anchor(label: str) -> str:
    """An id for a label."""
    return re.sub(r"[^A-Za-z0-9_]+", "-", label)
