"""The command line, one command a file; `main` puts them together, and says errors in one line."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from verify.discovery import Catalogue

if TYPE_CHECKING:
    import click

_FILES = Catalogue(__name__, __path__)


def commands() -> "Iterator[click.Command]":
    """What is called as its file; what heavy libraries do in it, it imports when it is run."""
    from click import Command

    for name in _FILES.names:
        found = getattr(_FILES.module(name), name.replace("-", "_"), None)
        if isinstance(found, Command):
            yield found
