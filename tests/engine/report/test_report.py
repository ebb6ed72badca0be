"""The LaTeX report: up to date, escaped, with readable formulas, and compiled without warnings."""

import re
import shutil
import tomllib
from pathlib import Path

import pytest
import sympy as sp

from derivation.engine import report_files
from derivation.engine.formula.notation import to_latex, to_markdown, to_plain
from derivation.engine.report.document import APPENDICES, REPORT, Text, cited_keys
from derivation.engine.report.equations import (
    COLUMN,
    DEEPEST,
    INDENT,
    PAGE,
    body,
    displayed,
    equation,
    function_by_name,
    in_parts,
)
from derivation.engine.report.latex import escape, prose
from derivation.engine.report.numbers import number
from derivation.engine.report.pdf import TexError, compile_pdf, typeset
from derivation.engine.report.sentences import typeset_sentence, with_large_fractions
from derivation.engine.report.width import typeset_width
from derivation.plate import derived, reporting
from derivation.plate import vocabulary as symbols
from derivation.plate.chain import STEPS
from derivation.plate.paper import PAPER
from derivation.plate.report.consequence import Consequences
from derivation.plate.report.listings import function_source
from derivation.plate.report.prose import REFERENCES
from derivation.plate.vocabulary import PLATE, R, a, lam, mu, phi
from derivation.scene.impact import simulate
from derivation.scene.scene import load
from generated import influence

NEEDS_TEX = pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
DOCUMENTS = (REPORT, APPENDICES)
MAX_OVERFULL = 2.0
"""Width by which a box may exceed the line without a report [pt]."""


def problems(log: str) -> list[str]:
    """Return overfull boxes and warnings from a log of LaTeX."""
    boxes = re.finditer(r"^Overfull .*?\(([\d.]+)pt too .*$", log, re.MULTILINE)
    warnings = re.findall(r"^(?:LaTeX|Package \S+|pdfTeX) [Ww]arning.*$", log, re.MULTILINE)
    return [box[0] for box in boxes if float(box[1]) > MAX_OVERFULL] + warnings


def test_committed_report_is_up_to_date() -> None:
    freshness = report_files.freshness(PAPER, None, "platecontact report")
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
def test_special_characters_are_escaped(plain: str, latex: str) -> None:
    assert escape(plain) == latex


@pytest.mark.parametrize(
    ("written", "latex", "plain", "markdown"),
    [
        ("a and phi_j, 50 %", r"a and phi\_j, 50 \%", "a and phi_j, 50 %", r"a and phi\_j, 50 %"),
        (r"$\phi_j h$ of a_b", r"$\phi_j h$ of a\_b", "phi_j h of a_b", r"$\phi_j h$ of a\_b"),
        (r"$P^{2/3} \le 1$", r"$P^{2/3} \le 1$", "P^(2/3) <= 1", r"$P^{2/3} \le 1$"),
        (
            r"$\sigma_{zz}$, $J_0(\sqrt{m/2})$, $E^* \to \infty$",
            r"$\sigma_{zz}$, $J_0(\sqrt{m/2})$, $E^* \to \infty$",
            "sigma_zz, J0(sqrt(m/2)), E* -> oo",
            r"$\sigma_{zz}$, $J_0(\sqrt{m/2})$, $E^* \to \infty$",
        ),
        ("to 1.5e-07", r"to $1.5\cdot10^{-7}$", "to 1.5e-07", "to 1.5e-07"),
        ("0x1p+3, 1e+20", "0x1p+3, $10^{20}$", "0x1p+3, 1e+20", "0x1p+3, 1e+20"),
        ("0.0e+00 of it", "0 of it", "0.0e+00 of it", "0.0e+00 of it"),
    ],
)  # fmt: skip
def test_text_between_dollars_is_mathematics(
    written: str, latex: str, plain: str, markdown: str
) -> None:
    assert prose(written) == latex
    assert to_plain(written) == plain
    assert to_markdown(written) == markdown


def test_unpaired_dollar_is_rejected() -> None:
    for convert in (prose, to_plain, to_markdown):
        with pytest.raises(ValueError, match="expected dollars in pairs"):
            convert("5 $")


def test_plain_text_of_meanings_and_proofs_contains_no_latex(formulas) -> None:
    """Dollars, commands and braces are removed."""
    for formula in formulas.values():
        for sentence in (formula.meaning, formula.proof.argument):
            assert not re.search(r"[$\\{}]", to_plain(sentence)), sentence


@pytest.mark.parametrize(
    ("plain", "latex"),
    [
        (r"per $s(a \phi)$, z", r"per $s(a \phi)$, z"),
        ("the factor mu*(lam + mu)/(pi*R) of it", r"the factor ${}$ of it"),
        ("read 2*a + sin(a*phi), not b", r"read ${}$, not b"),
        ("found [kg^2 m^-2]", "found [kg$^{2}$ m$^{-2}$]"),
        ("where x*y is none", "where x*y is none"),
        ("a phi_j of K_j and K_j_bottom", r"a $\phi_j$ of $K_j$ and K\_j\_bottom"),
        ("sigma_rr times e^(-2 x)/2^-30", r"$\sigma_{rr}$ times $e^{-2 x}$/$2^{-30}$"),
        ("coefficient of P^(5/3) in delta", r"coefficient of $P^{5/3}$ in $\delta$"),
    ],
)
def test_formulas_typed_as_code_are_typeset(plain: str, latex: str) -> None:
    inner = {"the": mu * (lam + mu) / (sp.pi * R),
             "read": 2 * a + sp.sin(a * phi)}  # fmt: skip
    expected = inner.get(plain.split(" ")[0])
    assert typeset_sentence(plain, PLATE) == (
        latex if expected is None else latex.replace("{}", to_latex(expected, PLATE))
    )


def test_only_outer_fractions_of_a_sentence_are_large() -> None:
    typeset = r"read $\frac{\frac{a}{b}}{c}$ and $x^{\frac{1}{3}}$, not $\fracture$"
    large = with_large_fractions(typeset)
    assert large == typeset.replace(r"\frac{\frac", r"\dfrac{\frac")


@pytest.mark.parametrize("width", [PAGE, COLUMN])
def test_wide_formulas_are_split_into_parts(formulas, width: float) -> None:
    """Every line fits the page or the column, and the nesting of fractions is limited."""
    for formula in formulas.values():
        text = body(formula, room=width).removeprefix(r"\begin{aligned}")
        lines = text.removesuffix(r"\end{aligned}").split(r"\\")
        parts = [match[1] for line in lines if (match := re.match(r"\s*& (Z_\d+) = ", line))]
        assert parts == [f"Z_{k}" for k in range(1, len(parts) + 1)]
        assert all(typeset_width(line) <= width for line in lines), formula.name
        assert all(fractions_within(line) <= DEEPEST for line in lines)


def fractions_within(latex: str) -> int:
    """Return the depth of nested fractions."""
    depth = 0
    for match in re.finditer(r"\\frac(?=\{)", latex):
        numerator, end = argument(latex, match.end())
        denominator, _ = argument(latex, end)
        inner = max(fractions_within(numerator), fractions_within(denominator))
        depth = max(depth, 1 + inner)
    return depth


def argument(latex: str, start: int) -> tuple[str, int]:
    """Return the text in braces that begins at `start`, and the index after it."""
    depth = 0
    for brace in re.finditer(r"\\.|[{}]", latex[start:]):
        depth += {"{": 1, "}": -1}.get(brace[0], 0)
        if depth == 0:
            break
    return latex[start + 1 : start + brace.start()], start + brace.end()


def test_parts_inserted_into_the_value_give_the_formula(formulas) -> None:
    for formula in formulas.values():
        for room in (PAGE, COLUMN):
            value, parts = in_parts(formula.expression, room - INDENT, PLATE)
            for _ in parts:  # a part may contain other parts
                value = value.xreplace(dict(parts))
            assert value == formula.expression or value == sp.expand(formula.expression)


def test_summand_with_several_terms_is_replaced_by_a_symbol() -> None:
    """Otherwise the summation sign would apply to the first term only."""
    long = sum(sp.sin(n * a * phi) for n in range(1, 30))
    text = equation("S", long, PLATE, r"\sum_{j=1}^{\infty} ")
    assert re.match(r"\\begin\{aligned\}& S = +\\sum_\{j=1\}\^\{\\infty\} +Z_\{1\} ", text)
    negative = equation("S", -a * phi, PLATE, r"\sum_{j=1}^{\infty} ")
    assert negative == r"S = - \sum_{j=1}^{\infty} a \phi_j"


def test_plate_factor_is_written_as_function_G(formulas) -> None:
    whole = formulas["c_1_modes"].expression
    short = function_by_name(whole, formulas["G"])
    assert "G{" in to_latex(short, PLATE)
    assert "sinh" not in to_latex(short, PLATE)
    G = sp.Function("G")
    again = short.replace(G, lambda T: formulas["G"].expression.xreplace({symbols.T: T}))
    assert again == whole
    assert function_by_name(formulas["K_j"].expression, formulas["G"]) == formulas["K_j"].expression


@NEEDS_TEX
def test_estimated_widths_agree_with_tex(formulas, tmp_path: Path) -> None:
    """The estimate is within 10 % for at least 14 of 15 formulas, and within 25 % for all."""
    shown = [displayed(formula.expression, PLATE) for formula in formulas.values()]
    boxes = "".join(rf"\sbox0{{$\displaystyle {text}$}}\typeout{{W\the\wd0}}" for text in shown)
    source = tmp_path / "boxes.tex"
    source.write_text(
        rf"\documentclass{{article}}\usepackage{{amsmath,lmodern}}"
        rf"\begin{{document}}{boxes}x\end{{document}}"
    )
    _, log = typeset(source)
    widths = [float(matches) for matches in re.findall(r"^W([\d.]+)pt", log, re.MULTILINE)]
    assert len(widths) == len(shown)
    ratios = [w / typeset_width(text) for w, text in zip(widths, shown, strict=True)]
    assert sum(not 0.9 < ratio < 1.1 for ratio in ratios) <= len(ratios) // 15
    assert all(0.8 < ratio < 1.25 for ratio in ratios)


def test_long_sums_are_broken_and_short_ones_are_not(formulas) -> None:
    assert "aligned" in equation("g", formulas["g_j"].expression, PLATE)
    assert "aligned" not in equation("G", formulas["G"].expression, PLATE)


def test_sums_count_by_the_index_of_their_symbols(formulas) -> None:
    for formula in formulas.values():
        if formula.summed:
            indices = re.findall(r"(?:\\phi|j)_(\w)", formula.right_hand_side)
            assert set(indices) <= {formula.sum_sign[len(r"\sum_{")]}, formula.name


def test_every_derivation_step_and_formula_is_in_the_report(
    texts: dict[str, Text], formulas
) -> None:
    text = "\n".join(texts[APPENDICES].sections)
    for name, _ in STEPS:
        assert rf"\subsection{{{name[0].upper() + name[1:]}}}" in text
    for name in formulas:
        assert rf"\begin{{formula}}{{{escape(name)}}}" in text
        assert rf"\label{{eq:{name}}}" in text


@NEEDS_TEX
def test_pdfs_are_reproducible_and_free_of_warnings(
    written: tuple[Path, ...], tmp_path: Path
) -> None:
    folder = written[0].parent
    assert {path.name for path in written if path.parent == folder} == {"report.bib"} | {
        f"{name}{suffix}" for name in DOCUMENTS for suffix in (".tex", ".html", ".pdf")
    }
    assert set(written) == {path for path in folder.rglob("*") if path.is_file()}
    shutil.copytree(folder, tmp_path / "two")
    for name in DOCUMENTS:
        again, log = typeset(tmp_path / "two" / f"{name}.tex")
        assert again == (folder / f"{name}.pdf").read_bytes()
        assert problems(log) == []
        pages = int(re.findall(r"Output written on .*\((\d+) pages", log)[0])
        assert pages <= 40 or name == APPENDICES


@NEEDS_TEX
def test_overfull_boxes_and_warnings_are_found(tmp_path: Path) -> None:
    path = tmp_path / "bad.tex"
    path.write_text(
        r"\documentclass{article}\begin{document}\hbox to 10pt{\vrule width 13pt}"
        r"\hbox to 10pt{\vrule width 11pt}\ref{none}\end{document}"
    )
    actual = problems(typeset(path)[1])
    assert sum(line.startswith("Overfull") for line in actual) == 1
    assert any("none" in line for line in actual)


@NEEDS_TEX
def test_chosen_sections_compile_alone(tmp_path: Path) -> None:
    written = report_files.write(PAPER, tmp_path, sections=["speed", "misprints"])
    assert written[-1].name == "report-misprints-speed.pdf"
    tex = written[0].read_text()
    assert re.findall(r"\\label\{sec:(.*?)\}", tex) == ["misprints", "speed"]
    assert "otherpart{" not in tex.partition(r"\begin{document}")[2]
    assert problems(typeset(written[0])[1]) == []


def test_unknown_section_is_rejected_with_the_names_of_all() -> None:
    with pytest.raises(ValueError, match=r"did you mean misprints\?.*misprints, symbols, law"):
        report_files.documents(PAPER, ["misprint"])


def test_consequences_of_misprints_against_a_calculation_by_hand(formulas) -> None:
    """The published Omega_3 has an extra factor 1/phi, where phi_1 = j_1/b."""
    cost = Consequences(reporting.paper_case(), formulas)
    known = {finding.printed.name: cost.of(finding) for finding in derived.misprints()
             if finding.is_misprint}  # fmt: skip
    assert f"{1 / 2.404825557695773:.4g}$ times" in known["Omega_3"]
    assert "0.500 of its largest value, in place of 0.354" in known["force_power"]
    indentation = float(simulate(load(reporting.PAPER)).max_indentation)
    assert f"in place of {number(indentation)} m" in known["delta"]
    assert "$-1$ times" in known["u"]
    assert set(known) == {finding.printed.name for finding in derived.misprints()
                          if finding.is_misprint}  # fmt: skip


def test_derivation_steps_named_by_references_exist() -> None:
    known = {name for name, _ in derived.chain()}
    named = {
        link
        for entry in tomllib.loads(REFERENCES.table.read_text()).values()
        for link in entry.get("links", ())
    }
    assert named <= known
    assert set(REFERENCES.cited("spherical profile")) == {"sneddon1965"}


@NEEDS_TEX
@pytest.mark.parametrize("wide", ["", r"\setlength\textwidth{514pt}\setlength\columnsep{10pt}"])
def test_fragments_of_all_derivation_steps_fit_a_column(tmp_path: Path, wide: str) -> None:
    """Columns are 221 pt (article) or 252 pt (IEEE) wide; fragments contain no definitions."""
    first, *others = (name for name, _ in derived.chain())
    pasted = [report_files.fragments(PAPER, names) for names in ([first], others)]
    assert not re.findall(r"\\(?:re)?new|\\def\\|\\usepackage", uncommented("".join(pasted)))
    keys = sorted({key for text in pasted for key in cited_keys([text])})
    listed = "".join(rf"\bibitem{{{key}}} A." for key in keys)
    path = tmp_path / "paste.tex"
    path.write_text(
        rf"\documentclass[a4paper,twocolumn]{{article}}\usepackage{{amsmath,amssymb}}{wide}"
        rf"\begin{{document}}{''.join(pasted)}"
        rf"\begin{{thebibliography}}{{9}}{listed}\end{{thebibliography}}\end{{document}}"
    )
    assert problems(typeset(path)[1]) == []


def uncommented(text: str) -> str:
    """Return LaTeX without its comments."""
    return re.sub(r"(?m)^%.*$", "", text)


def test_fragment_is_one_formula_with_its_source(formulas) -> None:
    text = report_files.fragments(PAPER, ["K_j"])
    assert text.count(r"\begin{equation}") == 1
    assert r"\label{eq:K_j}" in text
    assert r"equation~(6) of~\cite{paper}" in text
    assert body(formulas["K_j"], room=COLUMN) in text
    with pytest.raises(ValueError, match="did you mean K_j"):
        report_files.fragments(PAPER, ["Kj"])


def test_fragments_are_written_with_the_bibliography(tmp_path: Path) -> None:
    names = [path.name for path in report_files.write_fragments(PAPER, ["G", "G_m"], tmp_path)]
    assert names == ["fragment.tex", "report.bib"]
    assert (tmp_path / "fragment.tex").read_text().count(r"\begin{equation}") == 2


def test_fragments_replace_only_equal_files_unless_asked(tmp_path: Path) -> None:
    for _ in range(2):
        report_files.write_fragments(PAPER, ["G"], tmp_path)
    mine = tmp_path / "fragment.tex"
    mine.write_text("mine")
    with pytest.raises(ValueError, match="exists already with other content"):
        report_files.write_fragments(PAPER, ["G"], tmp_path)
    assert mine.read_text() == "mine"
    report_files.write_fragments(PAPER, ["G"], tmp_path, replace=True)
    assert "equation" in mine.read_text()


def test_fragment_states_its_symbols() -> None:
    lines = report_files.fragments(PAPER, ["delta"]).splitlines()
    assert "% $R$ [m]: sphere radius" in lines
    assert not [line for line in lines if "J_1" in line and line.startswith("% $")]


def test_listings_are_the_generated_functions_without_docstrings() -> None:
    source = Path(influence.__file__).read_text()
    cut = function_source(source, "G")
    assert cut.startswith("@quiet\ndef G(")
    assert '"""' not in cut
    names: dict[str, object] = {}
    exec(
        compile(source.replace("from .", "from generated.").split("@quiet")[0] + cut, "G", "exec"),
        names,
    )
    assert names["G"](2.0) == influence.G(2.0)
    with pytest.raises(ValueError, match="no_such"):
        function_source(source, "no_such")


@NEEDS_TEX
def test_error_of_latex_is_reported(tmp_path: Path) -> None:
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
