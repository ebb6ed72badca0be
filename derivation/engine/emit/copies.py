"""Copies of handwritten modules in the generated package, and descriptions of their functions.

A copy has the lines of the original except for three changes: a header names the generator, imports
from the package are relative, and docstrings state error budget and domain of the functions that
the manifest lists, or given notes.
"""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.kernels import ArgumentText

MARK = "in_manifest"
"""The decorator of the functions that the manifest lists; see `engine.runtime.arrays`."""
NO_NOTES: Mapping[str, Sequence[str]] = {}
_UNIT = re.compile(r"\[([^\]]+)\]")


@dataclass(frozen=True)
class ListedFunction:
    """The description of a handwritten function, from its docstring and decorator.

    Parameters
    ----------
    name
        Name of the function.
    arguments
        Its arguments, as described in the docstring.
    unit
        Units of its results, separated by commas.
    symbol, equation, domain, kernel
        As given in the decorator.
    meaning
        The first line of the docstring in lower case, without "Compute the" and period.
    """

    name: str
    arguments: tuple[ArgumentText, ...]
    unit: str
    symbol: str
    equation: str
    meaning: str
    domain: str
    kernel: bool = False


def listed_functions(file: Path) -> tuple[ListedFunction, ...]:
    """Return the functions of a module that the manifest lists, from the syntax tree.

    Raises
    ------
    ValueError
        If a docstring or decorator is incomplete; the message states the function.
    """
    return tuple(
        _listed_function(node, mark, file)
        for node, mark in _listed_definitions(ast.parse(file.read_text()))
    )


def function_text(file: Path, name: str) -> str:
    """Return the source text of one function of a module.

    Raises
    ------
    StopIteration
        If the module has no function of this name.
    """
    text = file.read_text()
    named = (n for n in ast.parse(text).body if isinstance(n, ast.FunctionDef) and n.name == name)
    return ast.get_source_segment(text, next(named)) or ""


def copy_text(
    file: Path,
    package: str,
    header: str,
    budgets: Mapping[str, Budget],
    notes: Mapping[str, Sequence[str]] = NO_NOTES,
) -> str:
    """Return the text of a module's copy.

    Parameters
    ----------
    file
        The original.
    package
        Import name of the generated package.
    header
        Comment below the module's docstring.
    budgets
        Error budgets of the functions that the manifest lists, by name.
    notes
        Lines about errors, by function, for functions that the manifest does not list.
    """
    tree = ast.parse(file.read_text())
    lines = file.read_text().splitlines()
    added: list[tuple[int, list[str]]] = [(_end_of_docstring(tree, file), header.splitlines())]
    for node, mark in _listed_definitions(tree):
        words = _decorator_arguments(mark)
        known = budgets[node.name].notes(words.get("domain", ""))
        if words.get("equation"):
            known = (f"The result belongs to equation ({words['equation']}) of the paper.", *known)
        added.append(_stated_limit(node, known, lines))
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    added += (_stated_limit(functions[name], text, lines) for name, text in notes.items())
    for place, text in sorted(added, key=lambda pair: -pair[0]):
        lines[place:place] = text
    return "\n".join(relative(line, package) for line in lines) + "\n"


def relative(line: str, package: str) -> str:
    """Return a line with an import from the package as an import within it."""
    for own in (package, f".{package}", "derivation.engine.runtime"):
        line = re.sub(rf"^from {re.escape(own)}\.(\w+) import", r"from .\1 import", line)
    return re.sub(rf"^from \.?{re.escape(package)} import", "from . import", line)


def _listed_definitions(tree: ast.Module) -> Iterator[tuple[ast.FunctionDef, ast.Call]]:
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            for mark in node.decorator_list:
                if isinstance(mark, ast.Call) and ast.unparse(mark.func) == MARK:
                    yield node, mark


def _decorator_arguments(mark: ast.Call) -> dict[str, str]:
    """Return the decorator's arguments by name."""
    given = zip(("symbol", "equation", "domain", "kernel"), mark.args, strict=False)
    named = ((str(word.arg), word.value) for word in mark.keywords)
    return {name: str(ast.literal_eval(value)) for name, value in (*given, *named)}


def _listed_function(node: ast.FunctionDef, mark: ast.Call, file: Path) -> ListedFunction:
    text = ast.get_docstring(node) or ""
    words, parts = _decorator_arguments(mark), _sections(text)
    meanings = dict(_parameters(parts.get("Parameters", ())))
    arguments = []
    for argument in node.args.args:
        meaning = meanings.get(argument.arg, "")
        unit = _UNIT.search(meaning)
        if unit is None:
            raise ValueError(
                f"{file.name}: expected a unit in brackets for the argument {argument.arg} of "
                f"{node.name}, got {meaning!r}"
            )
        arguments.append(ArgumentText(argument.arg, unit[1], meaning[: unit.start()].strip(), ""))
    units = _UNIT.findall(" ".join(parts.get("Returns", ())))
    if not units or "symbol" not in words:
        raise ValueError(f"{file.name}: {node.name} needs a symbol, and units of its results")
    meaning = re.sub("^Compute (the )?", "", text.partition("\n")[0]).rstrip(".")
    return ListedFunction(
        node.name,
        tuple(arguments),
        ", ".join(units),
        words["symbol"],
        words.get("equation", ""),
        meaning[0].lower() + meaning[1:],
        words.get("domain", ""),
        words.get("kernel") == str(True),
    )


def _sections(text: str) -> dict[str, list[str]]:
    """Return the lines of a docstring by the heading above them."""
    sections: dict[str, list[str]] = {}
    lines = text.splitlines()
    current: list[str] = []
    for line, below in zip(lines, [*lines[1:], ""], strict=True):
        if below and set(below) == {"-"}:
            current = sections.setdefault(line, [])
        elif line and set(line) != {"-"}:
            current.append(line)
    return sections


def _parameters(lines: list[str] | tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yield names and meanings of a section."""
    names: list[str] = []
    meaning: list[str] = []
    for line in lines:
        if line.startswith(" "):
            meaning.append(line.strip())
            continue
        yield from ((name, " ".join(meaning)) for name in names)
        names, meaning = line.partition(":")[0].replace(",", " ").split(), []
    yield from ((name, " ".join(meaning)) for name in names)


def _stated_limit(
    node: ast.FunctionDef, notes: Sequence[str], lines: list[str]
) -> tuple[int, list[str]]:
    """Return the position for the notes in a docstring, and the lines to insert there."""
    docstring = node.body[0]
    last = int(docstring.end_lineno or 0) - 1
    indented = [f"    {note}" for note in notes]
    headings = {lines[i - 1].strip(): i for i in range(docstring.lineno, last)
                if set(lines[i].strip()) == {"-"}}  # fmt: skip
    if "Notes" in headings:
        return headings["Notes"] + 1, [*indented, ""]
    section = ["    Notes", "    -----", *indented]
    if "Examples" in headings:
        return headings["Examples"] - 1, [*section, ""]
    return last, ["", *section]


def _end_of_docstring(tree: ast.Module, file: Path) -> int:
    if ast.get_docstring(tree) is None:
        raise ValueError(f"{file.name}: expected a docstring in its first line")
    return int(tree.body[0].end_lineno or 0)
