"""The help of `platecontact`, which lists the commands by topic."""

from typing import Any

from typer.core import TyperGroup

GROUPS = {
    "Scenes": (
        "examples",
        "simulate",
        "sweep",
        "explain",
        "map",
        "indent",
        "reference",
        "materials",
        "schema",
    ),
    "Formulas": ("derive", "misprints", "diagnose", "rewrite"),
    "Checks": ("check", "benchmark"),
    "Papers (your own with --paper FOLDER)": ("build", "generate", "report", "new"),
}
"""Commands of each group, in the order of the help."""


class GroupedHelp(TyperGroup):
    """A command whose help lists its subcommands by topic."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002
        """Write a section of the help for each group."""
        longest = max(len(name) for names in GROUPS.values() for name in names)
        for title, names in GROUPS.items():
            helps = (self.commands[x].get_short_help_str(formatter.width) for x in names)
            rows = [(f"{name:{longest}}", text) for name, text in zip(names, helps, strict=True)]
            with formatter.section(title):
                formatter.write_dl(rows)
