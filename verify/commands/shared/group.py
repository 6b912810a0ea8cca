"""A group of commands that refuses a repeated option of a single value.

click would take the last value, and ignore the others without a word.
"""

from collections import Counter
from collections.abc import Sequence

import click

from verify.errors import NOT_GIVEN, InputError


class Group(click.Group):
    """A group that checks the options of a command before the command reads them."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name, command, rest = super().resolve_command(ctx, args)
        applies = not ctx.resilient_parsing  # a shell that completes the line wants no word of it
        if applies and command is not None and not isinstance(command, click.Group):
            _check_single_options(command, click.Context(command, parent=ctx, info_name=name), rest)
        return name, command, rest


def _check_single_options(
    command: click.Command, context: click.Context, arguments: list[str]
) -> None:
    try:
        # The parser is run once more, only to count the options: click's own pass forgets repeated
        # ones.
        _, _, order = command.make_parser(context).parse_args(list(arguments))
    except click.ClickException:  # which is told when the command itself reads them
        return
    for option, times in Counter(order).items():
        # A repeated flag says the same twice, and is no mistake.
        single = isinstance(option, click.Option) and not (option.multiple or option.is_flag)
        if single and times > 1:
            from verify.commands.shared.usage import commands_with

            several = commands_with(set(option.opts), several=True)
            instead = f"several go with {several}" if several else "call it once for each"
            problem = f"{context.command_path} takes one; {instead}"
            values = ", ".join(_values(option, arguments)) or NOT_GIVEN
            raise InputError(option.opts[-1], values, problem)


def _values(option: click.Parameter, arguments: Sequence[str]) -> list[str]:
    """Return the values after the option, or after its `=`."""
    parts = [word.partition("=") for word in arguments]
    pairs = zip(parts, [*arguments[1:], ""], strict=True)
    return [x if equals else after for (name, equals, x), after in pairs if name in option.opts]
