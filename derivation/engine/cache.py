"""Cache of results as plain data, each under a hash of the sources from which it was computed.

A file contains a checksum and a tree of JSON: numbers, texts, and the parts of an object under the
name of its class. Reading it builds SymPy expressions and the classes that the caller names, and
executes nothing else. A file that cannot be read is ignored, and its result is computed again.
"""

import contextlib
import functools
import hashlib
import json
import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p
from sympy.core.function import Application, AppliedUndef

from derivation.engine.files import PACKAGE, content_hash, read_file, sources, write_file

Value = TypeVar("Value")

BEGIN = time.time()
"""Time at which this process began to import the package."""
LARGEST = 2**26
"""Largest size in bytes of a cache file."""
CONSTANTS: dict[str, sp.Basic] = {
    "Pi": sp.pi, "EulerGamma": sp.EulerGamma, "Exp1": sp.E, "ImaginaryUnit": sp.I,
    "Infinity": sp.oo, "NegativeInfinity": -sp.oo,
}  # fmt: skip
HEADS: dict[str, type] = {
    head.__name__: head
    for head in (sp.Add, sp.Mul, sp.Pow, sp.Derivative, sp.Integral, sp.Sum, sp.Tuple, expm1, log1p)
}
"""Classes of expressions other than SymPy's functions, by name."""


def cached(
    name: str, source_names: tuple[str | Path, ...], compute: Callable[[], Value], *kinds: type
) -> Value:
    """Return the result of a function, cached until one of its sources changes.

    A cache that cannot be read or written is ignored. So is the whole cache if a source of this
    package was edited after its import: the result is that of the code before.

    Parameters
    ----------
    name
        Name of the result.
    source_names
        Sources on which it depends: parts of this package by name, others by path; see
        `derivation.engine.files.sources`.
    compute
        Function that computes the result. It may contain None, booleans, integers, text, SymPy
        expressions, `kinds`, tuples, and mappings with text as keys.
    kinds
        Dataclasses and SymPy functions of this project that the result contains.

    Raises
    ------
    TypeError
        If the result contains something that cannot be cached.
    """
    files = tuple(sources(*source_names))
    key = f"{name}-{content_hash(files)[:32]}"
    folder, known = cache_folder(), {kind.__name__: kind for kind in kinds}
    path = None if folder is None or any(map(_is_edited, files)) else folder / f"{key}.json"
    if path is not None:
        with contextlib.suppress(Exception):  # any exception that a damaged file raises
            kept: Value = _deserialised(key, read_file(path, LARGEST), known)
            return kept
    content = _serialised(key, compute(), known)
    if path is not None:
        with contextlib.suppress(OSError):
            write_file(path, content)
    # SymPy may regroup an expression that is read back. To make the first run equal to later
    # ones, the result is read from what was written.
    value: Value = _deserialised(key, content, known)
    return value


def _is_edited(source: Path) -> bool:
    """Return whether a source of this package was edited since this process began."""
    return source.is_relative_to(PACKAGE) and source.stat().st_mtime > BEGIN


def in_file(
    source_names: tuple[str | Path, ...], *kinds: type
) -> Callable[[Callable[..., Value]], Callable[..., Value]]:
    """Return a decorator that caches the results of a function in memory and in files.

    Parameters
    ----------
    source_names, kinds
        As for `cached`. The function has integers as arguments.
    """

    def decorate(function: Callable[..., Value]) -> Callable[..., Value]:
        @functools.cache
        @functools.wraps(function)
        def read(*arguments: int) -> Value:
            name = "-".join((function.__module__, function.__name__, *map(str, arguments)))
            return cached(name, source_names, lambda: function(*arguments), *kinds)

        return read

    return decorate


def cache_folder() -> Path | None:
    """Return the folder for cached results; None if no private folder is available.

    A relative path in XDG_CACHE_HOME is ignored, as its standard requires. A folder that belongs to
    another user, or into which everybody may write, is not used.
    """
    said = Path(os.environ.get("XDG_CACHE_HOME", ""))
    try:
        folder = (said if said.is_absolute() else Path.home() / ".cache") / "platecontact"
        if not folder.is_absolute():
            return None
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=0o700, exist_ok=True)
        known = folder.stat()
    except (OSError, RuntimeError, ValueError):
        return None
    private = not hasattr(os, "geteuid") or (
        known.st_uid == os.geteuid() and not known.st_mode & 0o002
    )
    return folder if private else None


# --- a file: a checksum, which covers the key, and a line of JSON


def _serialised(key: str, value: object, kinds: Mapping[str, type]) -> bytes:
    text = json.dumps(to_plain(value, kinds), separators=(",", ":")).encode()
    return _checksum(key, text) + b"\n" + text


def _deserialised(key: str, content: bytes, kinds: Mapping[str, type]) -> Any:
    checksum, _, text = content.partition(b"\n")
    if checksum != _checksum(key, text):
        raise ValueError(f"{key}: the checksum does not match the content")
    return from_plain(json.loads(text), kinds)


def _checksum(key: str, text: bytes) -> bytes:
    return hashlib.sha256(key.encode() + b"\n" + text).hexdigest().encode()


# --- a value and its tree


def to_plain(value: object, kinds: Mapping[str, type]) -> Any:
    """Return a value as JSON data.

    Raises
    ------
    TypeError
        If it contains something that cannot be cached.
    """
    if value is None or isinstance(value, (bool, int, str)):
        return value
    name = type(value).__name__
    if isinstance(value, tuple) and type(value) is tuple:
        return [to_plain(item, kinds) for item in value]
    if isinstance(value, Mapping):
        return {"mapping": [[_text(key), to_plain(item, kinds)] for key, item in value.items()]}
    if is_dataclass(value) and kinds.get(name) is type(value):
        kept = (one.name for one in fields(value) if one.metadata.get("cached", True))
        return {name: [to_plain(getattr(value, part), kinds) for part in kept]}
    if isinstance(value, sp.Basic):
        return _expression_to_plain(value, kinds)
    raise TypeError(
        f"cache: expected a value that can be cached, got {type(value)}; add it to the kinds"
    )


def _expression_to_plain(value: sp.Basic, kinds: Mapping[str, type]) -> Any:
    name = type(value).__name__
    if type(value) is sp.Symbol:
        return {"Symbol": [value.name, value.__getnewargs_ex__()[1]]}
    if isinstance(value, sp.Rational):
        return {"Rational": [value.p, value.q]}
    if isinstance(value, sp.Float):
        sign, mantissa, exponent, _ = value._mpf_
        return {"Float": [int(sign), str(mantissa), int(exponent), int(value._prec)]}
    if value in CONSTANTS.values():
        return {name: []}
    arguments = [to_plain(argument, kinds) for argument in value.args]
    if isinstance(value, AppliedUndef):
        return {"Function": [name, dict(value.func._kwargs), arguments]}
    if _head(name, kinds) is type(value):
        return {name: arguments}
    raise TypeError(f"cache: expected SymPy's functions, got {type(value)}; name it in HEADS")


def from_plain(plain: Any, kinds: Mapping[str, type]) -> Any:
    """Return the value that a tree represents.

    Raises
    ------
    TypeError, ValueError
        If the tree does not represent a value.
    """
    if plain is None or isinstance(plain, (bool, int, str)):
        return plain
    if isinstance(plain, list):
        return tuple(from_plain(item, kinds) for item in plain)
    if not isinstance(plain, dict) or len(plain) != 1:
        raise ValueError(f"expected one name and its parts, got {plain!r:.40}")
    ((name, parts),) = plain.items()
    if name == "mapping":
        return {_text(key): from_plain(item, kinds) for key, item in parts}
    if is_dataclass(kinds.get(name)):
        return kinds[name](*(from_plain(part, kinds) for part in parts))
    return _expression(name, parts, kinds)


def _expression(name: str, parts: Any, kinds: Mapping[str, type]) -> sp.Basic:
    if name == "Symbol":
        own, assumptions = parts
        return sp.Symbol(_text(own), **_assumptions(assumptions))
    if name == "Rational":
        p, q = parts
        return sp.Rational(int(p), int(q))
    if name == "Float":
        sign, mantissa, exponent, bits = parts
        made = (int(sign), int(mantissa), int(exponent), int(mantissa).bit_length())
        return sp.Float(made, precision=int(bits))
    if name in CONSTANTS:
        return CONSTANTS[name]
    head = _head(name, kinds)
    if name == "Function":
        own, assumptions, parts = parts
        head = sp.Function(_text(own), **_assumptions(assumptions))
    if head is None:
        raise ValueError(f"expected a part of an expression, got {name!r:.40}")
    return head(*_expressions(from_plain(part, kinds) for part in parts))


def _head(name: str, kinds: Mapping[str, type]) -> Any:
    """Return the class of expressions with a name, from `HEADS`, kinds or SymPy; else None."""
    head = HEADS.get(name) or kinds.get(name) or getattr(sp, name, None)
    known = isinstance(head, type) and issubclass(head, (Application, *HEADS.values()))
    return head if known and head not in (Application, sp.Function) else None


def _expressions(values: Iterable[Any]) -> tuple[sp.Basic, ...]:
    expressions = tuple(values)
    if not all(isinstance(value, sp.Basic) for value in expressions):
        raise ValueError("expected expressions as parts of an expression")
    return expressions


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"expected text, got {type(value)}")
    return value


def _assumptions(values: Any) -> dict[str, bool]:
    return {_text(key): bool(value) for key, value in values.items()}
