"""Base classes of the commands: check and name options, accept their former names."""

from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import Any

from typer import BadParameter
from typer.core import TyperCommand, TyperGroup, TyperOption
from typer.exceptions import TyperException

from derivation.engine.console import NOTES

RENAMED = {
    "--kernel": "--function",
    "--moving": "--dynamic",
    "--propose": "--suggest-budgets",
    "--record": "--update",
}
"""Former names of options, accepted with a notice."""


class Command(TyperCommand):
    """A command that rejects repeated options, and names options as typed in error messages."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        """Create the command; its help shows arguments without the names of their Python types."""
        super().__init__(*args, **kwargs)
        for argument in self.params:
            if argument.param_type_name == "argument":
                setattr(argument, "display_type", lambda _: "")  # noqa: B010 (a method)

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the parts of the usage line: a required argument is not in braces."""
        return [piece.strip("{}") for piece in super().collect_usage_pieces(ctx)]

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Replace former names and reject repeated options before the arguments are parsed.

        The parser does not say in which command an option lacks its value.
        """
        try:
            return super().parse_args(ctx, with_present_names(self, ctx, args))
        except TyperException as error:
            if not getattr(error, "ctx", None):
                setattr(error, "ctx", ctx)  # noqa: B010 (not known to the type)
            raise

    def invoke(self, ctx: Any) -> Any:
        """Run the command; an error of an argument names the option as it was typed."""
        try:
            return super().invoke(ctx)
        except ValueError as error:
            name = str(error).partition(":")[0]
            if not any(name == option.name for option in typed_options(self, ctx)):
                raise
            raise ValueError(f"--{error}") from None


class SignedCommand(Command):
    """A command whose arguments may begin with a minus sign, such as -5 or "-x + 1"."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Move arguments that begin with a minus sign behind --, after which nothing is an option.

        Options with a single minus sign that do not exist are thus read as arguments.
        """
        return super().parse_args(ctx, with_signs_last(self, ctx, args))


class Group(TyperGroup):
    """A command with subcommands; its own options apply only without a subcommand."""

    def own_arguments(self, args: list[str]) -> list[str]:
        """Return the arguments before the subcommand."""
        return list(takewhile(lambda arg: arg not in self.commands, args))

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Replace former names; reject repeated options, and options that have no effect."""
        own = with_present_names(self, ctx, self.own_arguments(args))
        rest = args[len(self.own_arguments(args)) :]
        misplaced = [option for option in given_options(self, ctx, own) if not option.is_eager]
        if rest and misplaced and not ctx.resilient_parsing:
            ctx.fail(
                f"{misplaced[0].opts[0]} has no effect before the subcommand {rest[0]}; write the "
                f"options of {rest[0]} after it"
            )
        return super().parse_args(ctx, [*own, *rest])


def with_signs_last(command: Any, ctx: Any, args: list[str]) -> list[str]:
    """Return the arguments with those that begin with a minus sign after all others, behind --."""
    signed: list[str] = []
    while True:
        plain = list(takewhile(lambda arg: arg != "--", args))
        try:
            command.make_parser(ctx).parse_args(args=list(plain))
        except TyperException as error:
            name = getattr(error, "option_name", "--")
            found = [i for i, arg in enumerate(plain) if arg.startswith(name)]
            if name.startswith("--") or not found:
                return args
            signed.append(args.pop(found[0]))
        else:
            return [*plain, "--", *signed, *args[len(plain) + 1 :]] if signed else args


def with_present_names(command: Any, ctx: Any, args: list[str]) -> list[str]:
    """Return the arguments with former names of options replaced.

    Raises
    ------
    typer.BadParameter
        If an option that takes one value is given several times.
    """
    if ctx.resilient_parsing:
        return args
    args = list(_present_names(command, args))
    options = given_options(command, ctx, args)
    for option in options:
        count = options.count(option)
        if count > 1 and not (option.multiple or option.is_flag):
            problem = f"expected once, got {count} times; remove all but one"
            raise BadParameter(problem, ctx=ctx, param=option)
    return args


def typed_options(command: Any, ctx: Any) -> Iterator[TyperOption]:
    """Yield the options as given on the command line."""
    for option in command.params:
        source = ctx.get_parameter_source(option.name)
        if isinstance(option, TyperOption) and source is not None and source.name == "COMMANDLINE":
            yield option


def given_options(command: Any, ctx: Any, args: Sequence[str]) -> list[TyperOption]:
    """Return the options among the arguments; a repeated option has several entries."""
    order = command.make_parser(ctx).parse_args(args=list(args))[2]
    return [option for option in order if isinstance(option, TyperOption)]


def _present_names(command: Any, args: Sequence[str]) -> Iterator[str]:
    """Yield the arguments; each former name of an option is replaced, with a notice."""
    known = {name for parameter in command.params for name in parameter.opts}
    for arg in args:
        name, equals, value = arg.partition("=")
        new = RENAMED.get(name)
        if new is None or new not in known or name in known:
            yield arg
            continue
        NOTES.say(f"note: {name} is now {new}; the former name will be removed")
        yield new + equals + value
