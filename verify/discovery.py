"""Catalogues of kinds: each kind is a file, which is listed by its name before it is imported."""

import pkgutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from importlib import import_module
from pathlib import PurePath
from typing import Any


@dataclass(frozen=True)
class Catalogue:
    """The files of a package and of all folders in it.

    `package` is the dotted name of the package, `path` its `__path__`. In the catalogue a file has
    its name with dashes: `double_well.py` is `double-well`. RuntimeError if two files share a name.
    """

    package: str
    path: Iterable[str] = field(compare=False)

    @cached_property
    def _modules(self) -> dict[str, str]:
        # Sorted by the names of files, not by those with dashes: hypothesis draws in this order,
        # and another order would change the draws of a seed.
        entries = sorted(_files(self.package, self.path))
        modules = {file.replace("_", "-"): dotted for file, dotted in entries}
        if len(modules) < len(entries):
            raise RuntimeError(f"{self.package}: two files have one name among {[*modules]}")
        return modules

    @property
    def names(self) -> tuple[str, ...]:
        """All names, in the alphabetical order of their files; none is imported."""
        return tuple(self._modules)

    def __contains__(self, name: object) -> bool:
        return name in self._modules

    def module(self, name: str) -> Any:
        """Import and return the module of that name. Raises KeyError if there is none."""
        return import_module(self._modules[name])

    def folder(self, name: str) -> str:
        """Return the name of the folder that has the file of this name."""
        return self._modules[name].split(".")[-2]


def _files(package: str, path: Iterable[str]) -> Iterator[tuple[str, str]]:
    for module in pkgutil.iter_modules(path):
        dotted = f"{package}.{module.name}"
        if module.ispkg:
            yield from _files(dotted, [str(PurePath(p, module.name)) for p in path])
        else:
            yield module.name, dotted
