"""Jinja2 for LaTeX: its delimiters, an escape filter, and sums broken into lines."""

import re
from pathlib import Path

import jinja2
import sympy as sp

from derivation.formula.notation import to_latex

TEMPLATES = Path(__file__).parent / "templates"
LINE_WIDTH = 92
"""Characters, as typeset, after which a sum is broken."""

FAR_TOO_WIDE, LEAST_PART = 2 * LINE_WIDTH, 12
"""Characters from which a formula would be illegible on one line; of parts worth a name."""
LONG_LEFT = 16
"""Characters of a left side from which the right one begins a line of its own."""

SPECIAL = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
}


def escape(text: object) -> str:
    """Plain text as LaTeX."""
    return "".join(SPECIAL.get(character, character) for character in str(text))


GREEK = "alpha|beta|gamma|delta|eta|kappa|lambda|lam|mu|nu|omega|Omega|phi|pi|sigma|theta|xi"
_SYMBOL = re.compile(
    rf"(?<![\\A-Za-z0-9_'\[])(?P<minus>(?<=[ (])-)?(?:(?P<greek>{GREEK})|(?P<latin>[A-Za-z]))"
    r"(?:_(?P<sub>[A-Za-z0-9]{1,2})(?![A-Za-z0-9_]))?"
    r"(?:\^(?:\((?P<group>[^()]*)\)|(?P<power>\d+)))?(?![A-Za-z0-9_^])"
)


def prose(text: object) -> str:
    """A sentence as LaTeX, its symbols (phi_j, sigma_zz, y^3, J0) set as mathematics.

    Words and code (whatever holds a `*`) stay as they are; 1e-12 is set as a power of ten.
    """
    pieces = re.split(r"(\S*\*\S*)", str(text))
    return "".join(_code(p) if "*" in p else _numbers(p) for p in pieces)


def _numbers(text: str) -> str:
    """Words, with numbers like 2.5e+20 as powers of ten."""
    pieces = re.split(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d+)(?![\w.]*\w)", text)
    found = [_words(pieces[0])]
    for mantissa, power, after in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        lead = "" if mantissa == "1" else rf"{mantissa}\cdot"
        found += [rf"${lead}10^{{{int(power)}}}$", _words(after)]
    return "".join(found)


def _code(text: str) -> str:
    """Code in typewriter, to be broken after a star."""
    return rf"\texttt{{{escape(text)}}}".replace("*", r"*\allowbreak{}")


def _words(text: str) -> str:
    """Words with the symbols among them typeset."""
    source = re.sub(r"\b([IJKcv])([013])\b", r"\1_\2", text)
    pieces, last = [], 0
    for match in _SYMBOL.finditer(source):
        pieces += [escape(source[last : match.start()]), _mathematics(match)]
        last = match.end()
    return "".join(pieces) + escape(source[last:])


def _mathematics(match: re.Match[str]) -> str:
    """A symbol with its subscript and power; the article `a` and a bare `I` are words."""
    greek, latin = match["greek"], match["latin"]
    subscript, power = match["sub"], match["group"] or match["power"]
    if latin in ("a", "A", "I") and not (subscript or power or match["minus"]):
        return str(latin)
    name = {"lam": r"\lambda"}.get(greek, rf"\{greek}") if greek else latin
    power = re.sub(rf"\b({GREEK})\b", r"\\\1 ", power) if power else ""
    tail = (f"_{{{subscript}}}" if subscript else "") + (f"^{{{power}}}" if power else "")
    return f"${match['minus'] or ''}{name}{tail}$"


def environment() -> jinja2.Environment:
    """Jinja2 with delimiters that LaTeX leaves alone; what is not defined is an error."""
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        undefined=jinja2.StrictUndefined,
        block_start_string=r"\BLOCK{",
        block_end_string="}",
        variable_start_string=r"\VAR{",
        variable_end_string="}",
        comment_start_string=r"\#{",
        comment_end_string="}",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    made.filters["tex"] = escape
    made.filters["prose"] = prose
    return made


def typeset_width(latex: str) -> int:
    """Rough width of a formula in characters, fractions as wide as their wider part."""
    text = latex
    fraction = re.compile(r"\\frac\{([^{}]*)\}\{([^{}]*)\}")
    text = re.sub(r"\\(left|right|displaystyle|,|;|quad)\b", "", text)
    text = re.sub(r"\\([a-zA-Z]+)", lambda m: m[0] if m[1] == "frac" else m[1][:4], text)
    for _ in range(8):
        text = re.sub(r"([\^_])\{([^{}]*)\}", r"\2", text)
        text, found = fraction.subn(lambda m: max(m[1], m[2], key=len), text)
        text = re.sub(r"\{((?:[^{}\\]|\\[{}])*)\}", r"\1", text) if not found else text
    return len(re.sub(r"[\s{}\\]", "", text))


def equation(left: str, expression: sp.Expr, prefix: str = "") -> str:
    """Body of a displayed equation, its sum broken over as many lines as it needs."""
    whole = f"{left} = {prefix}{to_latex(expression)}"
    if typeset_width(whole) <= LINE_WIDTH:
        return whole
    if not isinstance(expression, sp.Add):
        expression = _expanded(expression)
    if not isinstance(expression, sp.Add):
        if typeset_width(whole) > FAR_TOO_WIDE:
            return _in_parts(f"{left} = {prefix}", expression)
        return rf"\fit{{{whole}}}"
    lines = [f"{left} = {{}}& {prefix}"]
    for index, term in enumerate(_signed_terms(expression)):
        if index and typeset_width(lines[-1] + term) > LINE_WIDTH:
            lines.append(r"& \quad ")
        lines[-1] += f" {term}"
    return r"\begin{aligned}" + " \\\\\n".join(lines) + r"\end{aligned}"


def _in_parts(left: str, expression: sp.Expr) -> str:
    """A formula whose sums and repeated parts are named, X_1, X_2 ..., and stand below it."""
    sums = sorted(expression.atoms(sp.Sum), key=sp.default_sort_key)
    rows = [(sp.Symbol(f"X_{k}"), part) for k, part in enumerate(sums, start=1)]
    named, (value,) = sp.cse(
        expression.xreplace({part: symbol for symbol, part in rows}), sp.numbered_symbols("_")
    )
    short: dict[sp.Symbol, sp.Expr] = {}
    for symbol, part in named:
        part = part.xreplace(short)
        if typeset_width(to_latex(part)) <= LEAST_PART:
            short[symbol] = part
        else:
            short[symbol] = sp.Symbol(f"X_{len(rows) + 1}")
            rows.append((short[symbol], part))
    body = rf"\fit[0.75]{{{to_latex(value.xreplace(short))}}}"
    lines = [f"{left}& {body}"] if typeset_width(left) <= LONG_LEFT else [f"{left}&", f"& {body}"]
    lines += [rf"{symbol} = {{}}& \fit[0.75]{{{to_latex(part)}}}" for symbol, part in rows]
    return r"\begin{aligned}" + " \\\\\n".join(lines) + r"\end{aligned}"


def _expanded(expression: sp.Expr) -> sp.Expr:
    """A product of powers multiplied out; functions and roots of sums only get worse by it."""
    nested = any(not p.exp.is_Integer and p.base.is_Add for p in expression.atoms(sp.Pow))
    worse = nested or expression.has(sp.Function, sp.Integral)
    return expression if worse else sp.expand(expression)


def _signed_terms(expression: sp.Add) -> list[str]:
    """LaTeX of a sum's terms in printed order, each with its sign but the first's plus."""
    text: list[str] = []
    for term in expression.as_ordered_terms():
        negative = term.could_extract_minus_sign()
        sign = "-" if negative else "+" if text else ""
        text.append(f"{sign} {to_latex(-term if negative else term)}")
    return text
