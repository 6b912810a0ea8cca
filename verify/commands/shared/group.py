"""A group of commands, in which an option that stands once stands once.

click takes the last of several and says nothing of the others.
"""

from collections import Counter
from collections.abc import Sequence

import click

from verify.errors import NOT_GIVEN, InputError


class Group(click.Group):
    """Sees to it before a command of the group reads its options."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name, command, rest = super().resolve_command(ctx, args)
        told = not ctx.resilient_parsing  # a shell that completes the line wants no word of it
        if told and command is not None and not isinstance(command, click.Group):
            _given_once(command, click.Context(command, parent=ctx, info_name=name), rest)
        return name, command, rest


def _given_once(command: click.Command, context: click.Context, given: list[str]) -> None:
    try:
        _, _, order = command.make_parser(context).parse_args(list(given))
    except click.ClickException:  # which is told when the command itself reads them
        return
    for option, times in Counter(order).items():
        single = isinstance(option, click.Option) and not (option.multiple or option.is_flag)
        if single and times > 1:
            from verify.commands.shared.usage import commands_with

            several = commands_with(set(option.opts), several=True)
            instead = f"several go with {several}" if several else "call it once for each"
            problem = f"{context.command_path} takes one; {instead}"
            values = ", ".join(_values(option, given)) or NOT_GIVEN
            raise InputError(option.opts[-1], values, problem)


def _values(option: click.Parameter, given: Sequence[str]) -> list[str]:
    """The values that stand after the option, or behind its =."""
    parts = [word.partition("=") for word in given]
    pairs = zip(parts, [*given[1:], ""], strict=True)
    return [x if equals else after for (name, equals, x), after in pairs if name in option.opts]
