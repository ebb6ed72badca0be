"""Python entries: the public API, the generated functions, the exceptions."""

import inspect
import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from importlib import import_module
from typing import Any

import platecontact as pc

import generated as package
from docs.generators.markdown import rst, table

EXCEPTIONS = (
    "derivation.scene.errors.SceneError",
    "derivation.scene.errors.IncompleteError",
    "derivation.engine.bounded.LimitError",
    "derivation.engine.load.PaperError",
    "derivation.engine.failed.FailedError",
)
"""Exceptions that a user can meet."""

RETURNED = (
    "derivation.scene.explanation.Explanation",
    "derivation.scene.indentation.StaticContact",
    "derivation.scene.output.history.History",
    "derivation.scene.output.history.DynamicHistory",
)
"""Classes of objects that functions of `platecontact` return, besides its own classes."""

MORE = (
    "edge_modes",
    "impact",
    "non_hertzian_pressure",
    "perturbation",
    "plate_waves",
    "prepared_plate",
)
"""Modules for users whose names `generated` itself does not offer."""


def api() -> str:
    """Return the entries of `platecontact`."""
    functions = [name for name in pc.__all__ if not inspect.isclass(getattr(pc, name))]
    classes = [name for name in pc.__all__ if inspect.isclass(getattr(pc, name))]
    parts = []
    for title, names in (("Functions", functions), ("Classes", classes)):
        parts += [f"## {title}", _summary("platecontact", names)]
        parts += [_entry("platecontact", name) for name in names]
    parts += ["## Returned objects", *(_entry(*name.rsplit(".", 1)) for name in RETURNED)]
    return "\n\n".join(parts)


def generated() -> str:
    """Return the entries of the generated functions, module by module."""
    parts, by_module = [], dict(modules())
    rows = (
        (f"[`{module}`](#module-{module.replace('_', '-')})", _first(module), _links(module, names))
        for module, names in by_module.items()
    )
    parts.append(table(("module", "content", "functions"), rows))
    for module, names in by_module.items():
        parts += [
            f"(module-{module.replace('_', '-')})=\n## `generated.{module}`",
            _first(module),
            _summary(f"generated.{module}", names),
            *(_entry(f"generated.{module}", name) for name in names),
        ]
    return "\n\n".join(parts)


def exceptions() -> str:
    """Return the entries of the exceptions."""
    return "\n\n".join(_entry(*name.rsplit(".", 1)) for name in EXCEPTIONS)


def modules() -> Iterator[tuple[str, list[str]]]:
    """Yield each module of the generated package that has public functions, with their names."""
    home: dict[str, list[str]] = {}
    for name in package.__all__:
        module = getattr(package, name).__module__.rpartition(".")[2]
        home.setdefault(module, []).append(name)
    for module in MORE:
        home[module] = list(_own(module))
    yield from sorted(home.items())


def _own(module: str) -> Iterator[str]:
    """Yield the public functions and classes that a module defines."""
    loaded = import_module(f"generated.{module}")
    for name, value in vars(loaded).items():
        public = inspect.isfunction(value) or inspect.isclass(value)
        if public and not name.startswith("_") and value.__module__ == loaded.__name__:
            yield name


def summary(place: str) -> str:
    """Return the first sentence of the docstring of a function or class."""
    module, _, name = place.rpartition(".")
    value = getattr(import_module(module), name)
    return " ".join((inspect.getdoc(value) or "").partition("\n\n")[0].split())


def _first(module: str) -> str:
    return (inspect.getdoc(import_module(f"generated.{module}")) or "").partition("\n")[0]


def _links(module: str, names: Iterable[str]) -> str:
    return ", ".join(f"{{py:obj}}`~generated.{module}.{name}`" for name in names)


def _summary(module: str, names: Iterable[str]) -> str:
    lines = "\n".join(f"   {name}" for name in names)
    return rst(f".. currentmodule:: {module}\n\n.. autosummary::\n\n{lines}")


def _entry(module: str, name: str) -> str:
    value = getattr(import_module(module), name)
    if not inspect.isclass(value):
        return rst(f".. autofunction:: {module}.{name}")
    kind = "exception" if issubclass(value, BaseException) else "class"
    names = ", ".join(_members(value))
    members = f"\n   :members: {names}" if names else ""
    return rst(f".. auto{kind}:: {module}.{name}(){members}")


def _members(value: type[Any]) -> Iterator[str]:
    """Yield the public methods and properties that the docstring of a class does not list."""
    listed = inspect.getdoc(value) or ""
    for name, each in vars(value).items():
        public = inspect.isfunction(each) or isinstance(each, (property, cached_property))
        if (
            public
            and not name.startswith("_")
            and not re.search(rf"^{name}$", listed, re.MULTILINE)
        ):
            yield name
