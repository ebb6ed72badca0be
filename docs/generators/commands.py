"""The command line: the help of every command as `platecontact` prints it."""

import inspect
from collections.abc import Iterator
from typing import Any

from typer.main import get_command

from derivation import cli
from derivation.commands.groups import GROUPS
from docs.generators.markdown import block, table

WIDTH = 90


def text() -> str:
    """Return a table of all commands by subject, then the help of each."""
    commands = get_command(cli.app).commands  # type: ignore[attr-defined]
    parts = []
    for title, names in GROUPS.items():
        rows = [(link(name), _short(commands[name])) for name in names]
        parts += [f"**{title}**", table(("command", "does"), rows)]
    for names in GROUPS.values():
        for name in names:
            parts += list(_entries(name, commands[name], 2))
    return "\n\n".join(parts)


def summaries() -> Iterator[tuple[str, str]]:
    """Yield every command that the help lists, subcommands included, with what it does."""
    commands = get_command(cli.app).commands  # type: ignore[attr-defined]
    for name in (name for group in GROUPS.values() for name in group):
        yield name, _short(commands[name])
        for part, subcommand in getattr(commands[name], "commands", {}).items():
            if not subcommand.hidden:
                yield f"{name} {part}", _short(subcommand)


def exit_status() -> str:
    """Return the exit statuses, as the module of the command line states them."""
    said = " ".join((inspect.getdoc(cli) or "").partition("Exit status:")[2].split())
    rows = (part.strip(" .").partition(" ") for part in said.split(";"))
    return table(("exit status", "meaning"), ((f"`{number}`", text) for number, _, text in rows))


def _entries(name: str, command: Any, level: int) -> Iterator[str]:
    yield f"({anchor(name)})=\n{'#' * level} `platecontact {name}`"
    yield block(_help(name, command), "text")
    for part, subcommand in getattr(command, "commands", {}).items():
        if not subcommand.hidden:
            yield from _entries(f"{name} {part}", subcommand, level + 1)


def _help(name: str, command: Any) -> str:
    context = command.make_context(
        f"platecontact {name}", [], resilient_parsing=True, terminal_width=WIDTH,
        max_content_width=WIDTH,
    )  # fmt: skip
    text: str = command.get_help(context)
    return text


def _short(command: Any) -> str:
    text: str = command.get_short_help_str(200)
    return text


def anchor(name: str) -> str:
    """Return the name of the target of a command's section."""
    return f"command-{name.replace(' ', '-')}"


def link(name: str) -> str:
    """Return a link to the section of a command."""
    return f"[`{name}`](#{anchor(name)})"
