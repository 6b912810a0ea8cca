"""The theory: files for Rocq below `theory/`, each of which imports those that it stands on.

`coqc -Q theory AreaPreservation` compiles them one by one; a file that is to stand alone holds
what it needs of them as modules.
"""

import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent / "theory"
LOGICAL = "AreaPreservation"  # by which coqc knows the folder

_IMPORT = re.compile(rf"^From {LOGICAL} Require Import ([^.]*)\.\n", re.MULTILINE)


@cache
def files() -> dict[str, Path]:
    """The files of the theory by their names, which are different in all folders."""
    return {path.stem: path for path in sorted(FOLDER.rglob("*.v"))}


@cache
def text_of(name: str) -> str:
    """The file of this name as it stands."""
    return files()[name].read_text(encoding="utf-8")


def imports_of(name: str) -> list[str]:
    """The files that it imports."""
    return [word for found in _IMPORT.findall(text_of(name)) for word in found.split()]


def in_order(names: Iterable[str]) -> list[str]:
    """These files and all that they stand on, each after what it imports."""
    ordered: dict[str, None] = {}

    def add(name: str) -> None:
        if name not in ordered:
            for below in imports_of(name):
                add(below)
            ordered[name] = None

    for name in names:
        add(name)
    return list(ordered)


def imported(names: Iterable[str]) -> str:
    """The line by which a file imports these from an installed theory."""
    return f"From {LOGICAL} Require Import {' '.join(names)}.\n"


def as_modules(names: Iterable[str]) -> str:
    """These files and what they stand on as modules in one file, and the line that imports them."""
    names = list(names)
    modules = [f"Module {name}.\n{_inside(name)}End {name}.\n" for name in in_order(names)]
    return "\n".join([*modules, f"Import {' '.join(names)}.\n"])


def _inside(name: str) -> str:
    return _IMPORT.sub(r"Import \1.\n", text_of(name))
