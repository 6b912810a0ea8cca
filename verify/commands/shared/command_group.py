"""Groups of commands, whose refusals name options as they are typed: `--step-size`.

A repeated option of a single value is refused: click would take the last value, and ignore the
others without a word.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import wraps
from typing import Any

import click

from verify.errors import NOT_GIVEN, InputError


class CommandGroup(click.Group):
    """A group that checks the options of a command before the command reads them."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name, command, arguments = super().resolve_command(ctx, args)
        applies = not ctx.resilient_parsing  # a shell that completes a line must get no message
        if applies and command is not None and not isinstance(command, click.Group):
            _check_single_options(
                command, click.Context(command, parent=ctx, info_name=name), arguments
            )
        return name, command, arguments


def _check_single_options(
    command: click.Command, context: click.Context, arguments: list[str]
) -> None:
    try:
        # The parser runs once more, only to count the options: click itself forgets repeated ones.
        _, _, typed_options = command.make_parser(context).parse_args(list(arguments))
    except click.ClickException:  # the command reports it when it parses the arguments itself
        return
    for option, repeats in Counter(typed_options).items():
        # A repeated flag means the same as a single one, and is no mistake.
        single = isinstance(option, click.Option) and not (option.multiple or option.is_flag)
        if single and repeats > 1:
            from verify.commands.shared.usage import commands_with

            several = commands_with(set(option.opts), context, several=True)
            instead = f"several go with {several}" if several else "call it once for each"
            problem = f"{context.command_path} takes one; {instead}"
            values = ", ".join(_values_after(option, arguments)) or NOT_GIVEN
            raise InputError(option.opts[-1], values, problem)


def _values_after(option: click.Parameter, arguments: Sequence[str]) -> list[str]:
    """Return the values of the option: the word after it, or the text after its `=`."""
    parts = [word.partition("=") for word in arguments]
    pairs = zip(parts, [*arguments[1:], ""], strict=True)
    return [x if equals else word for (name, equals, x), word in pairs if name in option.opts]


def with_typed_names(command: click.Command) -> click.Command:
    """Make the InputErrors of a command, and of its subcommands, name options as typed."""
    if isinstance(command, click.Group):
        for inner in command.commands.values():
            with_typed_names(inner)
    callback, typed_names = command.callback, _typed_names(command)
    if callback is None:
        return command

    @wraps(callback)
    def wrapper(*args: Any, **options: Any) -> Any:
        try:
            return callback(*args, **options)
        except InputError as error:
            # An error may name two options, such as `p, q`.
            names = error.name.split(", ")
            if not set(names) <= set(typed_names):
                raise
            labels = ", ".join(typed_names[name] for name in names)
            raise type(error)(labels, error.value, error.problem) from None

    command.callback = wrapper
    return command


def _typed_names(command: click.Command) -> Mapping[str, str]:
    """Return the typed form of each option and argument, by its names in Python."""
    names = {}
    for parameter in command.params:
        label = (
            parameter.opts[-1]
            if isinstance(parameter, click.Option)
            else parameter.human_readable_name
        )
        for name in (parameter.name, *parameter.opts):
            names[(name or "").lstrip("-").replace("-", "_")] = label.strip("[]")
    return names
