"""Errors that name an option as it is typed: `--step-size`, and not `step_size`."""

from collections.abc import Mapping
from functools import wraps
from typing import Any

import click

from verify.errors import InputError


def as_typed(command: click.Command) -> click.Command:
    """The command, and those in it, whose InputErrors name options and arguments as typed."""
    if isinstance(command, click.Group):
        for inner in command.commands.values():
            as_typed(inner)
    callback, typed = command.callback, _typed(command)
    if callback is None:
        return command

    @wraps(callback)
    def told(*args: Any, **options: Any) -> Any:
        try:
            return callback(*args, **options)
        except InputError as error:
            names = error.name.split(", ")
            if not set(names) <= set(typed):
                raise
            shown = ", ".join(typed[name] for name in names)
            raise type(error)(shown, error.value, error.problem) from None

    command.callback = told
    return command


def _typed(command: click.Command) -> Mapping[str, str]:
    """How each option and argument is typed, by the names that it has inside."""
    typed = {}
    for each in command.params:
        shown = each.opts[-1] if isinstance(each, click.Option) else each.human_readable_name
        for name in (each.name, *each.opts):
            typed[(name or "").lstrip("-").replace("-", "_")] = shown.strip("[]")
    return typed
