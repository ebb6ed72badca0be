"""The HTML report: same content as the LaTeX report, one valid file without external resources."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from browser import browser, missing

from derivation.engine import report_files
from derivation.engine.report.document import APPENDICES, REPORT, Text
from derivation.engine.report.figures import figure_file
from derivation.engine.report.html import HtmlError, drawing, page
from derivation.engine.report.pdf import TexError
from derivation.plate import reporting
from derivation.plate.paper import PAPER
from derivation.plate.report.figures import figures
from derivation.plate.report.front import TITLE
from derivation.plate.report.sections import PLAN
from derivation.scene.impact import simulate
from derivation.scene.scene import load

VOID = {"meta", "link", "wbr", "br", "img", "col"}


class Parsed(HTMLParser):
    """Elements of a page: open tags, ids, links, loaded resources, and words outside of code."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.words: list[str] = []
        self.tags: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attrs:
            if name == "id":
                self.ids.append(value or "")
            elif name == "href":
                (self.loaded if tag == "link" else self.links).append(value or "")
            elif name in ("src", "srcset", "data", "action"):
                self.loaded.append(value or "")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_data(self, data: str) -> None:
        if not {"code", "pre", "style", "annotation"} & set(self.open):
            self.words.append(data)


def page_of(body: str) -> str:
    """Return a page with one section and one figure."""
    return page(Text("A", r"\reporttitle{A}{B}", (body,), ""), "A", {"law": b"<svg ></svg>"})


@pytest.fixture(scope="module")
def pages(written: tuple[Path, ...]) -> dict[str, str]:
    return {path.stem: path.read_text() for path in written if path.suffix == ".html"}


@pytest.fixture(scope="module", params=[REPORT, APPENDICES])
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def text(texts: dict[str, Text], name: str) -> Text:
    return texts[name]


@pytest.fixture(scope="module")
def html(pages: dict[str, str], name: str) -> str:
    return pages[name]


@pytest.fixture(scope="module")
def parsed(html: str) -> Parsed:
    return Parsed(html)


def test_elements_are_closed_and_ids_are_unique(parsed: Parsed) -> None:
    assert parsed.open == []
    assert len(parsed.ids) > 40
    assert len(set(parsed.ids)) == len(parsed.ids)


def test_page_loads_no_resource_and_every_link_has_a_target(
    html: str, parsed: Parsed, pages: dict[str, str]
) -> None:
    assert set(parsed.loaded) <= {"data:,"}
    assert "<script" not in html
    assert "@import" not in html
    assert set(re.findall(r"url\(([^)]{0,4})", html)) <= {"#" + name[:3] for name in parsed.ids}
    ids = {f"{name}.html": set(Parsed(other).ids) | {""} for name, other in pages.items()}
    ids[""] = set(parsed.ids)
    documents = set()
    for link in parsed.links:
        if link.startswith("https://doi.org/10."):
            continue
        document, _, target = link.partition("#")
        assert target in ids[document], link
        documents.add(document)
    assert len(documents) == 2  # this document and the other one


def test_text_contains_no_latex_and_no_markup(parsed: Parsed) -> None:
    assert re.findall(r"\\[A-Za-z]+|[{}]|\$|</?[a-z]", " ".join(parsed.words)) == []


def test_page_has_the_elements_of_the_latex_document(text: Text, html: str, parsed: Parsed) -> None:
    whole = "\n".join(text.sections)
    assert parsed.tags.count("h2") == len(re.findall(r"\\section\{", whole)) + (
        text.references != ""
    )
    assert parsed.tags.count("h3") == len(re.findall(r"\\subsection\*?\{", whole))
    assert html.count('class="equation"') == whole.count(r"\begin{equation}")
    assert parsed.tags.count("figure") == whole.count(r"\begin{figure}")
    assert parsed.tags.count("pre") == whole.count(r"\begin{verbatim}")
    tables = re.findall(
        r"\\begin\{(longtable|tabular)\}(.*?)\\end\{\1\}", whole + text.front, re.DOTALL
    )
    assert parsed.tags.count("table") == parsed.tags.count("thead") == len(tables)
    ends = r"(?:\\\\(?:\[\d+pt\])?|\\kept|\\heads\{.*\})$"
    rows = sum(
        len(re.findall(ends, re.sub(r"(?s)\\caption.*?\}\\\\\n", "", table), re.MULTILINE))
        for _, table in tables
    )
    assert parsed.tags.count("tr") == rows
    displayed = len(re.findall(r"(?<!\\)\\\[|\\begin\{equation\}", whole))
    inline = len(re.findall(r"(?<!\\)\$", whole + text.front)) // 2
    assert parsed.tags.count("math") >= displayed + inline


def test_references_link_to_their_targets(text: Text, html: str) -> None:
    whole = "\n".join([text.front, *text.sections])
    for label in set(re.findall(r"\\ref\{(.*?)\}", whole)):
        assert re.search(rf'<a href="#{re.escape(label)}">(\d+|[A-Z])</a>', html), label
    for keys in re.findall(r"\\cite\{(.*?)\}", whole):
        for key in keys.split(","):
            assert f'href="#source-{key}"' in html
    assert html.count('id="source-') == text.references.count(r"\bibitem")


def test_equations_are_numbered_as_in_latex(text: Text, html: str) -> None:
    labels = re.findall(r"\\begin\{equation\}\\label\{eq:(\w+)\}", "\n".join(text.sections))
    matches = re.findall(
        r'id="eq:(\w+)" class="equation">.*?<span class="count">\((\d+)\)</span>', html, re.DOTALL
    )
    assert matches == [(name, str(number)) for number, name in enumerate(labels, start=1)]


def test_every_figure_has_a_caption_and_a_label(html: str) -> None:
    figures = re.findall(r"<figure>.*?</figure>", html, re.DOTALL)
    for number, figure in enumerate(figures, start=1):
        assert re.search(r'<svg role="img" aria-label="[^"]{20,}"', figure)
        assert f"<figcaption>Figure {number}: " in figure


@pytest.mark.parametrize(
    "wrong",
    [
        r"a \nonsense{x}",
        r"$\nonsense{x}$",
        r"\begin{nonsense}a\end{nonsense}",
        r"see \ref{eq:none}",
        r"see \cite{none}",
        r"\begin{figure}[H]\includegraphics{figures/none.pdf}\caption{A.}\end{figure}",
    ],
)
def test_unknown_commands_and_references_are_rejected(wrong: str) -> None:
    with pytest.raises(HtmlError, match="non"):
        page_of(wrong)


def test_page_is_reproducible_and_text_is_escaped() -> None:
    body = r"a\textless{}b \& \emph{c}~1--2 of $a$, \texttt{a*\allowbreak{}b}"
    actual = page_of(body)
    assert actual == page_of(body)
    assert "a&lt;b &amp; <em>c</em>\u00a01\u20132 of" in actual
    assert "<code>a*</code><wbr><code>b</code>" in actual
    assert re.search(r"</math>,</span>", actual)  # a comma stays on the line of its formula


def test_sections_of_the_appendix_have_letters() -> None:
    body = (
        r"\section{One}\subsection{Two}\subsection*{None}\appendix\section{Last}\label{sec:last}"
        "\n\nsee \\ref{sec:last}"
    )
    actual = re.sub(r"</?span[^>]*>", "", page_of(body))
    for heading in ("<h2>1 One", "<h3>1.1 Two", "None</h3>", "<h2>A Last"):
        assert heading in actual
    assert 'see <a href="#sec:last">A</a>' in actual


def test_figures_are_reproducible_and_have_unique_ids() -> None:
    result = simulate(load(reporting.PAPER))
    first, second = (
        figure_file(figures(reporting.paper_case(), result, 1.0)["figure2"](), ".svg")
        for _ in range(2)
    )
    assert first == second
    ids = [re.findall(r'\bid="([^"]*)"', drawing(name, first)) for name in ("one", "two")]
    assert ids[0]
    assert not set(ids[0]) & set(ids[1])


@pytest.mark.parametrize("section", PLAN.names)
def test_each_section_can_be_written_alone(section: str) -> None:
    [alone] = report_files.documents(PAPER, [section]).values()
    whole = "\n".join([*alone.sections, alone.front, alone.references])
    assert set(re.findall(r"\\ref\{(.*?)\}", whole)) <= set(re.findall(r"\\label\{(.*?)\}", whole))
    drawn = dict.fromkeys(re.findall(r"figures/([\w-]+)\.pdf", whole), b"<svg ></svg>")
    assert Parsed(page(alone, TITLE, drawn)).tags.count("h2") == 1 + (alone.references != "")


def test_html_is_written_without_latex(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(TexError, match="texlive-latex-base"):
        report_files.write(PAPER, tmp_path, sections=["speed"])
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["report-speed.html", "report-speed.tex", "report.bib"]
    assert "<h2" in (tmp_path / "report-speed.html").read_text()


@pytest.mark.skipif(bool(missing()), reason=missing())
def test_browser_shows_page_without_errors_or_overflow(html: str, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    path.write_text(html)
    with browser(tmp_path) as window:
        backgrounds = {}
        for width in (400, 1400):
            for dark in (False, True):
                window.open(path, width, dark)
                assert window.console_messages() == []
                inner, wide = window.run(
                    "return [innerWidth, document.documentElement.scrollWidth]"
                )
                assert inner == width
                assert wide <= inner
                backgrounds[dark] = window.run(
                    "return getComputedStyle(document.body).backgroundColor"
                )
        assert window.run("return document.querySelectorAll('math').length") == html.count("<math")
        tall = "const m = document.querySelector('math[display=block]').getBoundingClientRect()"
        assert window.run(f"{tall}; return m.width > 50 && m.height > 10")
        assert backgrounds[False] != backgrounds[True]
