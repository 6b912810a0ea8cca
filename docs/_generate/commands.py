"""The commands of the command line, one after another, with what they are called."""

from collections.abc import Iterator

import click

from verify.commands.main import cli


def contexts() -> Iterator[click.Context]:
    """A context of each command, such as of `verify reference make`, groups before theirs."""
    yield from _below(cli, None)


def _below(command: click.Command, parent: click.Context | None) -> Iterator[click.Context]:
    name = command.name if parent else "verify"
    context = click.Context(command, parent=parent, info_name=name, **command.context_settings)
    yield context
    if isinstance(command, click.Group):
        for inner in command.list_commands(context):
            found = command.get_command(context, inner)
            if found is not None:
                yield from _below(found, context)
