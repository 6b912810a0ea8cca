"""Errors with the name of an option as it is typed: `--step-size`, and not `step_size`."""

from collections.abc import Mapping
from functools import wraps
from typing import Any

import click

from verify.errors import InputError


def as_typed(command: click.Command) -> click.Command:
    """Make the InputErrors of a command, and of those in it, name options as they are typed."""
    if isinstance(command, click.Group):
        for inner in command.commands.values():
            as_typed(inner)
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
    for each in command.params:
        label = each.opts[-1] if isinstance(each, click.Option) else each.human_readable_name
        for name in (each.name, *each.opts):
            names[(name or "").lstrip("-").replace("-", "_")] = label.strip("[]")
    return names
