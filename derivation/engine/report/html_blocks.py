"""The LaTeX of the report's sections -> HTML: headings, paragraphs, formulas, tables, figures.

It reads what the templates write and nothing more; a command it does not know is an error, so
that both reports say the same.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from markupsafe import Markup

from derivation.engine.report.html_text import HtmlError, Words, anchor, argument, parts
from derivation.engine.report.mathml import mathml

_BLOCK = re.compile(
    r"\\(?P<heading>section|subsection)(?P<star>\*?)(?=\{)"
    r"|\\begin\{equation\}\\label\{(?P<label>[^}]*)\}(?P<numbered>.*?)\\end\{equation\}"
    r"|\\\[(?P<display>.*?)\\\]"
    r"|\\begin\{verbatim\}\n(?P<code>.*?)\n\\end\{verbatim\}"
    r"|\\begin\{(?P<kind>longtable|tabular)\}(?=\{)"
    r"|\\begin\{figure\}\[H\](?P<figure>.*?)\\end\{figure\}"
    r"|\\begin\{itemize\}(?P<items>.*?)\\end\{itemize\}"
    r"|\\begin\{thebibliography\}\{99\}(?P<sources>.*?)\\end\{thebibliography\}"
    r"|\\(?:begin\{)?(?P<pair>formula|reporttitle)\}?(?=\{)"
    r"|(?P<appendix>\\appendix)"
    r"|(?P<skipped>\\(?:begin|end)\{(?:center|listing)\}|\\end\{formula\}|\\(?:begingroup|endgroup|scriptsize|clearpage"
    r"|sloppy)\b|\\setlength\{[^}]*\}\{[^}]*\}|\\stepcounter\{captioned\}"
    r"|\\lines\{\d+\})",
    re.DOTALL,
)
_LABEL = re.compile(r"\\label\{(sec:[^}]*)\}")
_RULES = re.compile(r"\\(?:toprule|midrule|bottomrule)\n?")
_COLUMN = re.compile(r"@\{[^}]*(?:\{[^}]*\})?\}|(?P<column>[lrcC]|P\{[^}]*\})")
_SPAN = re.compile(r"\\multicolumn\{(\d+)\}\{([^}]*)\}(?=\{)")


@dataclass(frozen=True)
class Heading:
    """An entry of the table of contents."""

    level: int
    anchor: str
    number: str
    title: Markup


def numbers_of(sections: tuple[str, ...]) -> dict[str, str]:
    """Numbers of equations and of sections that have a label, in the order of the text."""
    found: dict[str, str] = {}
    equations, chapters = 0, Counter()
    pattern = re.compile(
        r"\\begin\{equation\}\\label\{(?P<equation>[^}]*)\}|(?P<appendix>\\appendix)"
        r"|\\section\{[^}]*\}(?:\\label\{(?P<section>[^}]*)\})?"
    )
    for match in pattern.finditer("\n".join(sections)):
        if match["equation"]:
            equations += 1
            found[match["equation"]] = str(equations)
        elif match["appendix"]:
            chapters.appendix()
        else:
            chapters.section()
            if match["section"]:
                found[match["section"]] = chapters.text
    return found


class Counter:
    """Numbers of sections; letters from the appendix on."""

    def __init__(self) -> None:
        self.chapter, self.part, self.letters = 0, 0, False

    def appendix(self) -> None:
        """Begin the appendix."""
        self.chapter, self.letters = 0, True

    def section(self) -> None:
        """Begin a section."""
        self.chapter, self.part = self.chapter + 1, 0

    @property
    def text(self) -> str:
        """The current section's number."""
        return chr(ord("A") + self.chapter - 1) if self.letters else str(self.chapter)


class Blocks:
    """Reads sections one after the other, which share numbers.

    Parameters
    ----------
    words
        Reads what stands in paragraphs and cells.
    figures
        Figures as SVG by name.
    """

    def __init__(self, words: Words, figures: Mapping[str, Markup]) -> None:
        self.words, self.figures = words, figures
        self.counter = Counter()
        self.headings: list[Heading] = []
        self.captions = {"Table": 0, "Figure": 0}

    def read(self, text: str) -> Markup:
        """A section as HTML.

        Raises
        ------
        HtmlError
            If it holds a command that is not known.
        """
        return Markup("\n").join(self._blocks(text))

    def _blocks(self, text: str) -> Iterator[Markup]:
        place = 0
        while match := _BLOCK.search(text, place):
            yield from self._paragraphs(text[place : match.start()])
            made, place = self._block(match, text)
            yield made
        yield from self._paragraphs(text[place:])

    def _paragraphs(self, text: str) -> Iterator[Markup]:
        for paragraph in re.split(r"\n\s*\n", text):
            made = self.words.read(paragraph.strip())
            if made:
                yield Markup("<p>{}</p>").format(made)

    def _block(self, match: re.Match[str], text: str) -> tuple[Markup, int]:
        place = match.end()
        if match["heading"]:
            return self._heading(match, text)
        if match["pair"]:
            first, place = argument(text, place)
            second, place = argument(text, place)
            return self._pair(match["pair"], first, second), place
        if match["kind"]:
            return self._table(match["kind"], text, place)
        if match["appendix"]:
            self.counter.appendix()
        return self._simple(match), place

    def _simple(self, match: re.Match[str]) -> Markup:
        """A block that stands in the match as a whole."""
        if match["label"]:
            number = self.words.numbers[match["label"]]
            return Markup(
                '<div class="equation" id="{}"><div class="wide">{}</div><span>({})</span></div>'
            ).format(anchor(match["label"]), mathml(match["numbered"], display=True), number)
        if match["display"]:
            return Markup('<div class="wide">{}</div>').format(mathml(match["display"], True))
        if match["code"]:
            return Markup('<pre class="wide"><code>{}</code></pre>').format(match["code"])
        if match["figure"]:
            return self._figure(match["figure"])
        if match["items"]:
            items = [self.words.read(item.strip()) for item in match["items"].split(r"\item")[1:]]
            return Markup("<ul>{}</ul>").format(_joined("li", items))
        if match["sources"]:
            return self._sources(match["sources"])
        return Markup("")

    def _heading(self, match: re.Match[str], text: str) -> tuple[Markup, int]:
        title, place = argument(text, match.end())
        label = _LABEL.match(text, place)
        level = 2 if match["heading"] == "section" else 3
        if level == 2:
            self.counter.section()
            number = self.counter.text
        elif match["star"]:
            number = ""
        else:
            self.counter.part += 1
            number = f"{self.counter.text}.{self.counter.part}"
        words = self.words.read(title)
        name = anchor(label[1]) if label else f"part-{len(self.headings) + 1}"
        self.headings.append(Heading(level, name, number, words))
        made = Markup('<h{0} id="{1}">{2}{3}</h{0}>').format(
            level, name, Markup("<span>{}</span> ").format(number) if number else "", words
        )
        return made, label.end() if label else place

    def _pair(self, kind: str, first: str, second: str) -> Markup:
        head, tail = self.words.read(first), self.words.read(second)
        if kind == "formula":
            return Markup('<p class="formula"><code>{}</code> {}</p>').format(head, tail)
        return Markup('<h1>{}</h1>\n<p class="subtitle">{}</p>').format(head, tail)

    def _figure(self, text: str) -> Markup:
        name = re.search(r"figures/([\w-]+)\.pdf", text)
        start = text.index(r"\caption") + len(r"\caption")
        if name is None:
            raise HtmlError(f"expected a figure's name, got {text:.60}")
        caption = self._caption("Figure", argument(text, start)[0])
        return Markup(
            '<figure><div class="wide">{}</div><figcaption>{}</figcaption></figure>'
        ).format(self.figures[name[1]], caption)

    def _caption(self, kind: str, text: str) -> Markup:
        """A caption with the number of its figure or table."""
        self.captions[kind] += 1
        return Markup("{} {}: {}").format(kind, self.captions[kind], self.words.read(text))

    def _sources(self, text: str) -> Markup:
        items = []
        for item in text.split(r"\bibitem")[1:]:
            key, place = argument(item, 0)
            items.append(
                Markup('<li id="source-{}">{}</li>').format(
                    key, self.words.read(item[place:].strip())
                )
            )
        self.headings.append(Heading(2, "references", "", Markup("References")))
        return Markup('<h2 id="references">References</h2>\n<ol>{}</ol>').format(
            Markup("\n").join(items)
        )

    def _table(self, kind: str, text: str, place: int) -> tuple[Markup, int]:
        spec, place = argument(text, place)
        closing = rf"\end{{{kind}}}"
        end = text.index(closing, place)
        body = text[place:end]
        caption = Markup("")
        if body.lstrip().startswith(r"\caption"):
            start = body.index(r"\caption") + len(r"\caption")
            words, after = argument(body, start)
            caption = Markup("<caption>{}</caption>").format(self._caption("Table", words))
            body = body[after:].lstrip().removeprefix(r"\\")
        head, body = _head_and_body(body)
        columns = [m["column"][0] for m in _COLUMN.finditer(spec) if m["column"]]
        made = Markup('<div class="wide"><table>{}<thead>{}</thead><tbody>{}</tbody></table></div>')
        rows = Markup("\n").join(self._rows(body, columns, "td"))
        return made.format(caption, Markup("").join(self._rows(head, columns, "th")), rows), (
            end + len(closing)
        )

    def _rows(self, text: str, columns: list[str], tag: str) -> Iterator[Markup]:
        for row in parts(_RULES.sub("", text), r"\\\\\*?(?:\[\d+pt\])?"):
            if row.strip():
                yield Markup("<tr>{}</tr>").format(
                    Markup("").join(self._cells(row.strip(), columns, tag))
                )

    def _cells(self, row: str, columns: list[str], tag: str) -> Iterator[Markup]:
        at = 0
        for cell in parts(row, "&"):
            text, span = cell.strip(), 1
            column = columns[at] if at < len(columns) else "l"
            wide = _SPAN.match(text)
            if wide:
                span, column = int(wide[1]), wide[2].strip("@{}")[:1]
                text = argument(text, wide.end())[0]
            elif text.startswith(r"\given"):
                span, column, text = len(columns), "g", argument(text, len(r"\given"))[0]
            at += span
            yield self._cell(text, column, span, tag)

    def _cell(self, text: str, column: str, span: int, tag: str) -> Markup:
        words = self.words.read(text)
        if column == "C" and tag == "td":
            words = Markup("<code>{}</code>").format(words)
        kind = {"r": "number", "c": "middle", "P": "text", "g": "given"}.get(column, "")
        attributes = f' class="{kind}"' if kind else ""
        attributes += f' colspan="{span}"' if span > 1 else ""
        return Markup("<{0}{1}>{2}</{0}>").format(Markup(tag), Markup(attributes), words)


def _head_and_body(text: str) -> tuple[str, str]:
    """A table's head, once, and its rows."""
    if r"\endhead" in text:
        head = text.split(r"\endfirsthead")[0].split(r"\endhead")[0]
        return head, text.split(r"\endfoot")[-1]
    head, _, body = text.partition(r"\midrule")
    return head, body


def _joined(tag: str, items: list[Markup]) -> Markup:
    return Markup("\n").join(Markup("<{0}>{1}</{0}>").format(Markup(tag), item) for item in items)
