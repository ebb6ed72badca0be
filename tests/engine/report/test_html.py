"""The HTML report: the same text as the LaTeX, one file that needs nothing, sound in a browser."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from browser import browser, missing
from markupsafe import Markup

from derivation.engine import report_files
from derivation.engine.report.document import Text
from derivation.engine.report.figures import saved
from derivation.engine.report.html import drawing, page
from derivation.engine.report.html_blocks import Blocks
from derivation.engine.report.html_text import HtmlError, Words, argument, parts
from derivation.engine.report.latex import _code
from derivation.engine.report.mathml import MathError, mathml, unwrapped
from derivation.engine.report.pdf import TexError
from derivation.plate import reporting
from derivation.plate.paper import PAPER
from derivation.plate.report.figures import figures
from derivation.plate.report.front import TITLE
from derivation.plate.report.prose import REFERENCES
from derivation.plate.report.sections import SECTIONS
from derivation.scene.impact import simulate
from derivation.scene.scene import load

VOID = {"meta", "link", "wbr", "br", "img"}


class Parsed(HTMLParser):
    """Elements of a page: what is not closed, ids, references, and words outside of code."""

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
        if not {"code", "pre", "style"} & set(self.open):
            self.words.append(data)


@pytest.fixture(scope="module")
def text() -> Text:
    return report_files.text(PAPER)


@pytest.fixture(scope="module")
def html(text: Text) -> str:
    drawn = {name: saved(figure, ".svg") for name, figure in reporting.report_figures().items()}
    return page(text, TITLE, drawn, REFERENCES)


@pytest.fixture(scope="module")
def parsed(html: str) -> Parsed:
    return Parsed(html)


def test_every_element_is_closed_and_every_id_its_own(parsed: Parsed) -> None:
    assert parsed.open == []
    assert len(parsed.ids) > 200
    assert len(set(parsed.ids)) == len(parsed.ids)


def test_nothing_is_loaded_and_every_link_leads_somewhere(html: str, parsed: Parsed) -> None:
    assert set(parsed.loaded) <= {"data:,"}
    assert "<script" not in html
    assert "@import" not in html
    assert set(re.findall(r"url\(([^)]{0,4})", html)) <= {"#" + name[:3] for name in parsed.ids}
    assert {link[0] for link in parsed.links} == {"#"}
    assert {link[1:] for link in parsed.links} <= set(parsed.ids)


def test_no_latex_and_no_markup_is_left(parsed: Parsed) -> None:
    assert re.findall(r"\\[A-Za-z]+|[{}]|\$|</?[a-z]", "".join(parsed.words)) == []


def test_it_holds_what_the_latex_holds(text: Text, html: str, parsed: Parsed) -> None:
    whole = "\n".join(text.sections)
    assert parsed.tags.count("h2") == len(re.findall(r"\\section\{", whole)) + 1
    assert parsed.tags.count("h3") == len(re.findall(r"\\subsection\*?\{", whole))
    assert html.count('class="equation"') == whole.count(r"\begin{equation}")
    assert parsed.tags.count("figure") == whole.count(r"\begin{figure}")
    assert parsed.tags.count("pre") == whole.count(r"\begin{verbatim}")
    tables = re.findall(r"\\begin\{(?:longtable|tabular)\}", whole + text.front)
    assert parsed.tags.count("table") == len(tables)


def test_equations_have_the_numbers_of_the_latex(text: Text, html: str) -> None:
    labels = re.findall(r"\\begin\{equation\}\\label\{eq:(\w+)\}", "\n".join(text.sections))
    found = re.findall(r'id="eq-(\w+)">.*?<span>\((\d+)\)</span>', html, re.DOTALL)
    assert found == [(name, str(number)) for number, name in enumerate(labels, start=1)]


def test_words_are_escaped_and_what_is_not_known_is_refused() -> None:
    words = Words({"eq:K_j": "7"}, {"paper": 3})
    assert words.read(r"a<b \& \emph{c}~1--2") == "a&lt;b &amp; <em>c</em>&nbsp;1\u20132"
    assert words.read(r"(\ref{eq:K_j})") == '(<a href="#eq-K_j">7</a>)'
    assert words.read("of $a$, it") == f"of <span>{mathml('a')},</span> it"
    assert words.read(r"\cite{paper}") == '[<a href="#source-paper">3</a>]'
    for wrong in (r"\nonsense{x}", r"\emph x", r"\emph{x"):
        with pytest.raises(HtmlError):
            words.read(wrong)
    for wrong in ("a}", "a$b", "a\\"):
        with pytest.raises(HtmlError, match="no HTML for '"):
            words.read(wrong)
    assert words.read("a% the source's own remark\nb\\%") == "ab%"
    assert words.read(_code("a*b<c")) == "<code>a*<wbr>b&lt;c</code>"  # may be broken there
    with pytest.raises(MathError):
        mathml(r"\nonsense{x}")


def test_cells_are_cut_outside_of_braces_and_formulas() -> None:
    assert list(parts(r"a & {b & c} & $d & e$ & \& f", "&")) == [
        "a ", " {b & c} ", " $d & e$ ", r" \& f",
    ]  # fmt: skip
    assert argument(r"{a\{{b}}c", 0) == (r"a\{{b}", 8)
    for wrong in (r"\{a}", "}a{", "{a{b}", "a", "a{b}"):
        with pytest.raises(HtmlError, match="expected an argument in braces"):
            argument(wrong, 0)


def test_a_figure_without_a_file_is_refused() -> None:
    whole = r"\begin{figure}[H]\includegraphics{%s}\caption{A law.}\end{figure}"
    blocks = Blocks(Words({}, {}), {"law": Markup("<svg/>")})
    assert "<svg/>" in blocks.read(whole % "figures/law.pdf")
    with pytest.raises(HtmlError, match="expected a figure's name"):
        blocks.read(whole % "law.png")


def test_braces_around_a_part_of_a_formula_stay() -> None:
    assert unwrapped("{a + b}") == "a + b"
    assert unwrapped("{a}{b}") == "{a}{b}"
    assert unwrapped(r"{a}\{b\}") == r"{a}\{b\}"


def test_sums_that_are_broken_into_lines_are_aligned() -> None:
    found = mathml(r"\fit{\begin{aligned}a ={}& b \\ & c\end{aligned}}", display=True)
    assert found.count("<mtr>") == 2
    assert found.count("<mtd>") == 4


def test_a_displayed_sum_has_its_limits_below_and_above() -> None:
    assert "<munderover>" in mathml(r"\fit[1]{\sum_{j=1}^{\infty} a}", display=True)


def test_figures_repeat_byte_for_byte_and_do_not_share_ids() -> None:
    result = simulate(load(reporting.PAPER))
    first, second = (
        saved(figures(reporting.paper_case(), result)["figure2"], ".svg") for _ in range(2)
    )
    assert first == second
    ids = [re.findall(r'\bid="([^"]*)"', drawing(name, first)) for name in ("one", "two")]
    assert ids[0]
    assert not set(ids[0]) & set(ids[1])


@pytest.mark.parametrize("name", SECTIONS)
def test_each_section_stands_alone(name: str) -> None:
    alone = report_files.text(PAPER, [name])
    whole = "\n".join([*alone.sections, alone.front, alone.references])
    assert set(re.findall(r"\\ref\{(.*?)\}", whole)) <= set(re.findall(r"\\label\{(.*?)\}", whole))
    drawn = dict.fromkeys(re.findall(r"figures/([\w-]+)\.pdf", whole), b"<svg></svg>")
    assert Parsed(page(alone, TITLE, drawn, REFERENCES)).tags.count("h2") == 2


def test_without_tex_the_html_is_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(TexError, match="texlive-latex-base"):
        report_files.write(PAPER, tmp_path, sections=["speed"])
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["report-speed.html", "report-speed.tex", "report.bib"]
    assert "<h2" in (tmp_path / "report-speed.html").read_text()


@pytest.mark.skipif(bool(missing()), reason=missing())
def test_a_browser_shows_it_without_complaint_or_overflow(html: str, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    path.write_text(html)
    with browser(tmp_path) as window:
        grounds = {}
        for width in (400, 1400):
            for dark in (False, True):
                window.open(path, width, dark)
                assert window.complaints() == []
                inner, wide = window.run(
                    "return [innerWidth, document.documentElement.scrollWidth]"
                )
                assert inner == width
                assert wide <= inner
                grounds[dark] = window.run("return getComputedStyle(document.body).backgroundColor")
        assert window.run("return document.querySelectorAll('math').length") == html.count("<math")
        tall = "const m = document.querySelector('.equation math').getBoundingClientRect()"
        assert window.run(f"{tall}; return m.width > 50 && m.height > 10")
        assert grounds[False] != grounds[True]
