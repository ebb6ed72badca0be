"""Jinja2 for LaTeX: its delimiters, and filters that escape text and typeset symbols in it."""

import re
from itertools import chain, zip_longest
from pathlib import Path

import jinja2

TEMPLATES = Path(__file__).parent / "templates"

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


GREEK = (
    "alpha|beta|gamma|delta|eps|eta|kappa|lambda|lam|mu|nabla|nu|omega|Omega|phi|pi|rho|sigma|theta"
    "|chi|xi"
)
_SYMBOL = re.compile(
    rf"(?<![\\A-Za-z0-9_'\[])(?P<minus>(?<=[ (])-)?(?:(?P<greek>{GREEK})|(?P<latin>[A-Za-z]))"
    r"(?:_(?P<sub>[A-Za-z0-9]{1,2})(?![A-Za-z0-9_]))?"
    r"(?:\^(?:\((?P<group>(?:[^()]|\([^()]*\))*)\)|(?P<power>\d+|[a-z](?![A-Za-z]))))?(?![A-Za-z0-9_^])"
)
_MODULUS = re.compile(r"((?<![A-Za-z0-9_*])E(?:_[0-9])?\*(?![A-Za-z0-9(*]))")
_SIGNS = {
    r"\\textgreater\{\}=": r"$\\ge$",
    r"\\textless\{\}=": r"$\\le$",
    r"-\\textgreater\{\}": r"$\\to$",
    r"\boo\b": r"$\\infty$",
    r"\+-": r"$\\pm$",
    r"\bint(?= )": r"$\\int$",
    r"\bThat(?= *$)": r"$\\hat{T}$",
    r"\b(sinh|cosh|tanh|coth|sin|cos|tan|log)\\textasciicircum\{\}(\d+)": r"$\\\1^{\2}$",
    r"\\textasciicircum\{\}(\d+)": r"$^{\1}$",
}
"""What words make of signs, once escaped; in this order."""
_ROOT = re.compile(r"sqrt\(([^()]*)\)")
_POWER = re.compile(r"\)\\textasciicircum\{\}(?:\((\d+/\d+)\)|(\d+)|\$(\w)\$)")


def prose(text: object) -> str:
    """A sentence as LaTeX, its symbols (phi_j, sigma_zz, y^3, J0) set as mathematics.

    Words and code (whatever holds a `*`) stay as they are; 1e-12 is set as a power of ten.
    """
    return "".join(_modulus(piece) or _mixed(piece) for piece in _MODULUS.split(str(text)))


def _modulus(text: str) -> str:
    """E* and E_1*, whose star multiplies nothing."""
    if _MODULUS.fullmatch(text) is None:
        return ""
    index = text[1:-1].lstrip("_")
    return rf"$E_{{{index}}}^*$" if index else "$E^*$"


def _mixed(text: str) -> str:
    """Words and code, which holds a star."""
    pieces = re.split(r"(\S*\*\S*)", text)
    return "".join(_code(p) if "*" in p else _numbers(p) for p in pieces)


def _numbers(text: str) -> str:
    """Words, with numbers like 2.5e+20 as powers of ten."""
    pieces = re.split(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d+)(?![\w.]*\w)", text)
    found = [_words(pieces[0])]
    for mantissa, power, after in zip(pieces[1::3], pieces[2::3], pieces[3::3], strict=True):
        lead = "" if mantissa == "1" else rf"{mantissa}\cdot"
        number = rf"${lead}10^{{{int(power)}}}$" if float(mantissa) else "0"
        found += [number, _words(after)]
    return "".join(found)


def _code(text: str) -> str:
    """Code in typewriter, to be broken after a star."""
    return rf"\texttt{{{escape(text)}}}".replace("*", r"*\allowbreak{}")


def _words(text: str) -> str:
    """Words with the symbols among them typeset, roots as roots."""
    pieces = _ROOT.split(text)
    roots = [rf"$\sqrt{{{_bare(inner)}}}$" for inner in pieces[1::2]]
    return "".join(chain(*zip_longest(map(_symbols, pieces[::2]), roots, fillvalue="")))


def _bare(text: str) -> str:
    """Words' symbols within mathematics."""
    return _symbols(text).replace("$", "")


def _symbols(text: str) -> str:
    """Words with the symbols among them typeset."""
    source = re.sub(r"\b([IJKcv])([013])\b", r"\1_\2", text)
    pieces, last = [], 0
    for match in _SYMBOL.finditer(source):
        pieces += [escape(source[last : match.start()]), _mathematics(match)]
        last = match.end()
    return _raised("".join(pieces) + escape(source[last:]))


def _raised(text: str) -> str:
    """LaTeX of words with powers of parentheses and functions raised: (a/h)^3, sinh^2; with >=."""
    text = _POWER.sub(lambda m: f")$^{{{m[1] or m[2] or m[3]}}}$", text)
    for plain, typeset in _SIGNS.items():
        text = re.sub(plain, typeset, text)
    return text


def _mathematics(match: re.Match[str]) -> str:
    """A symbol with its subscript and power; the article `a` and a bare `I` are words."""
    greek, latin = match["greek"], match["latin"]
    subscript, power = match["sub"], match["group"] or match["power"]
    if latin in ("a", "A", "I") and not (subscript or power or match["minus"]):
        return str(latin)
    name = {"lam": r"\lambda", "eps": r"\varepsilon"}.get(greek, rf"\{greek}") if greek else latin
    power = re.sub(rf"\b({GREEK})\b", r"\\\1 ", power) if power else ""
    tail = (f"_{{{subscript}}}" if subscript else "") + (f"^{{{power}}}" if power else "")
    return f"${match['minus'] or ''}{name}{tail}$"


def unit(text: str) -> str:
    """A unit as LaTeX: m^2 raised."""
    return re.sub(r"\^(?:\(([^)]*)\)|(-?\d+(?:/\d+)?))", lambda m: f"$^{{{m[1] or m[2]}}}$", text)


def columns(spec: str) -> str:
    """A table's columns in LaTeX's own letters; `P{0.3}` is text in a share of the line."""
    return re.sub(r"P\{([\d.]+)\}", r">{\\ragged}p{\1\\linewidth}", spec)


def environment(*folders: Path) -> jinja2.Environment:
    """Jinja2 with delimiters that LaTeX leaves alone; what is not defined is an error.

    Templates are looked for in the folders, then among those of every report.
    """
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader([*folders, TEMPLATES]),
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
    made.filters["columns"] = columns
    return made
