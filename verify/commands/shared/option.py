"""Options of commands: names, the placeholder of the value, and a help text in few words."""

from collections.abc import Callable
from typing import Any

import click

Command = Callable[..., Any]
Decorator = Callable[[Command], Command]


def option(names: str, metavar: str, help: str, **settings: Any) -> Decorator:  # noqa: A002
    """Return the decorator for an option with a value.

    `names`: as typed, and then that of the argument if it is another, separated by blanks;
    `metavar`: what the help shows for the value; `settings`: as for `click.option`.
    """
    return click.option(*names.split(), metavar=metavar, help=help, **settings)


def flag(names: str, help: str, **settings: Any) -> Decorator:  # noqa: A002
    """Return the decorator for an option without a value, which is True if it is typed."""
    return click.option(*names.split(), is_flag=True, help=help, **settings)


def options(*decorators: Decorator) -> Decorator:
    """Return a decorator that adds these options, which the help lists in this order."""
    # Decorators are applied from the last to the first, and click lists the last applied first.

    def with_options(command: Command) -> Command:
        for decorator in reversed(decorators):
            command = decorator(command)
        return command

    return with_options
