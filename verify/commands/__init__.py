"""The command line, one command a file; `main` puts them together, and says errors in one line."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from verify.discovery import Catalogue

if TYPE_CHECKING:
    import click

_FILES = Catalogue(__name__, __path__)


class Commands(Mapping[str, "click.Command"]):
    """What is called as its file, by its name; only the file of a command that is asked for is
    imported, and what heavy libraries do in it, it imports when it is run.
    """

    def __init__(self) -> None:
        self._made: dict[str, click.Command] = {}

    def __getitem__(self, name: str) -> "click.Command":
        from click import Command

        from verify.commands.shared.as_typed import as_typed

        if name not in self._made:
            found = getattr(_FILES.module(name), name.replace("-", "_"), None)
            if not isinstance(found, Command):
                raise KeyError(name)
            self._made[name] = as_typed(found)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return (name for name in _FILES.names if name in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)
