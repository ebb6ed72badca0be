"""The report: a pure function of theory and committed measurements, escaped and compiled."""

import shutil
from pathlib import Path

import pytest

from derivation import reporting
from derivation.report.latex import LINE_WIDTH, equation, escape, prose, typeset_width
from derivation.report.pdf import TexError, compile_pdf
from derivation.theory.chain import LINKS


def test_committed_tex_is_fresh() -> None:
    freshness = reporting.check_report()
    assert freshness.fresh, str(freshness)


@pytest.mark.parametrize(
    ("plain", "latex"),
    [
        ("a_b", r"a\_b"),
        ("50 %", r"50 \%"),
        ("{x}", r"\{x\}"),
        ("^", r"\textasciicircum{}"),
        ("\\", r"\textbackslash{}"),
    ],
)
def test_escape(plain: str, latex: str) -> None:
    assert escape(plain) == latex


@pytest.mark.parametrize(
    ("plain", "latex"),
    [
        ("to 6e300.", r"to $6\cdot10^{300}$."),
        ("h = b = 1e+20 a", "$h$ = $b$ = $10^{20}$ a"),
        ("1.5e-07 off", r"$1.5\cdot10^{-7}$ off"),
        ("the root of c1, J0 and v0", "the root of $c_{1}$, $J_{0}$ and $v_{0}$"),
        ("x1e5, 0x1p+3 and e^(-x)", r"x1e5, 0x1p+3 and $e^{-x}$"),
    ],
)
def test_numbers_and_symbols_in_words(plain: str, latex: str) -> None:
    assert prose(plain) == latex


def test_what_would_be_illegible_on_a_line_stands_in_parts(formulas) -> None:
    """No line has to be shrunk to less than half."""
    for name in ("time_by_radius", "time_by_thickness"):
        text = equation("", formulas[name].expression)
        assert text.startswith(r"\begin{aligned}")
        lines = text.split(r"\\")
        assert [line.split("=")[0].strip() for line in lines[1:]] == ["X_1", "X_2", "X_3", "X_4"]
        assert all(typeset_width(line) < 2 * LINE_WIDTH for line in lines)


def test_long_sums_are_broken_and_short_ones_are_not(formulas) -> None:
    assert "aligned" in equation("g", formulas["g_j"].expression)
    assert "aligned" not in equation("G", formulas["G"].expression)
    assert typeset_width(r"\frac{a + b}{c}") == 3


def test_every_link_and_formula_is_in_the_report(formulas) -> None:
    text = reporting.report_files()["report.tex"]
    for name, _ in LINKS:
        assert rf"\subsection{{{name[0].upper() + name[1:]}}}" in text
    for name in formulas:
        assert rf"\formula{{{escape(name)}}}" in text
        assert rf"\label{{eq:{name}}}" in text


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_pdf_compiles_twice_to_the_same_bytes(tmp_path: Path) -> None:
    first, second = (reporting.report(tmp_path / name)[-1] for name in ("one", "two"))
    assert first.name == "report.pdf"
    assert first.read_bytes() == second.read_bytes()
    left = sorted(p.name for p in first.parent.iterdir())
    assert left == ["figures", "report.bib", "report.pdf", "report.tex"]


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_refused_tex_names_the_error(tmp_path: Path) -> None:
    path = tmp_path / "bad.tex"
    path.write_text(r"\documentclass{article}\begin{document}\nonsense\end{document}")
    with pytest.raises(TexError, match="Undefined control sequence"):
        compile_pdf(path)


def test_without_tex_the_message_names_the_packages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(TexError, match="texlive-latex-base"):
        compile_pdf(tmp_path / "report.tex")
