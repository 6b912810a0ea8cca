"""The command line: one command a file. `main` joins them, and prints an error in one line."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from verify.discovery import Catalogue

if TYPE_CHECKING:
    import click

_FILES = Catalogue(__name__, __path__)


class Commands(Mapping[str, "click.Command"]):
    """The commands by their names, each called as its file.

    Only the file of a requested command is imported, and a command imports heavy libraries when it
    is run.
    """

    def __init__(self) -> None:
        self._loaded: dict[str, click.Command] = {}

    def __getitem__(self, name: str) -> "click.Command":
        from click import Command

        from verify.commands.shared.command_group import with_typed_names

        if name not in self._loaded:
            command = getattr(_FILES.module(name), name.replace("-", "_"), None)
            if not isinstance(command, Command):  # a module without a command, as `hunt`
                raise KeyError(name)
            self._loaded[name] = with_typed_names(command)
        return self._loaded[name]

    def __iter__(self) -> Iterator[str]:
        return (name for name in _FILES.names if name in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)
