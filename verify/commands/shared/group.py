"""A group of commands, in which an option that stands once stands once.

click takes the last of several and says nothing of the others.
"""

from collections import Counter

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
            raise InputError(option.opts[-1], NOT_GIVEN, f"is given {times} times; it stands once")
