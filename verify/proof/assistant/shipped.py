"""The theory: files for Rocq below `theory/`, each of which imports those that it stands on.

`coqc -Q theory AreaPreservation` compiles them one by one; a file that is to stand alone holds
what it needs of them as modules.
"""

import re
from collections.abc import Container, Iterable
from functools import cache
from pathlib import Path

from verify.files import write_atomically
from verify.proof.assistant.needed import needed

FOLDER = Path(__file__).parent / "theory"
LOGICAL = "AreaPreservation"  # by which coqc knows the folder

_IMPORT = re.compile(rf"^From {LOGICAL} Require Import ([^.]*)\.\n", re.MULTILINE)
_LIBRARY = re.compile(r"^From Coq Require Import ([^.]*)\.\n", re.MULTILINE)


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
    return _words(_IMPORT, text_of(name))


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


def as_modules(names: Iterable[str], by: str) -> str:
    """What the text `by` needs of these files, and of what they stand on, as modules in one file.

    It ends with the line that imports them.
    """
    names = list(names)
    ordered = in_order(names)
    # Libraries are imported once for all modules: each time takes a fifth of a second. Every file
    # says which scopes it means, and its own names are imported after theirs.
    library = sorted({word for name in ordered for word in _words(_LIBRARY, text_of(name))})
    below = {name: in_order([name]) for name in ordered}
    files = needed({name: text_of(name) for name in ordered}, below, by)
    modules = [
        f"Module {name}.\n{_inside(text, files)}End {name}.\n" for name, text in files.items()
    ]
    loaded = f"From Coq Require Import {' '.join(library)}.\n"
    return "\n".join([loaded, *modules, _import(names, files)])


def _words(pattern: re.Pattern[str], text: str) -> list[str]:
    return [word for found in pattern.findall(text) for word in found.split()]


def _inside(text: str, files: Container[str]) -> str:
    """A file within a module, which imports those of these files that it did."""
    own = _IMPORT.sub(lambda found: _import(found[1].split(), files), text)
    return _LIBRARY.sub("", own)


def _import(names: Iterable[str], files: Container[str]) -> str:
    left = [name for name in names if name in files]
    return f"Import {' '.join(left)}.\n" if left else ""


def install(folder: Path) -> list[Path]:
    """Writes the theory there, with the project file that `coq_makefile` takes.

    Raises InputError where a file cannot be written.
    """
    written = []
    for name in in_order(files()):
        path = folder / files()[name].relative_to(FOLDER)
        write_atomically(path, text_of(name))
        written.append(path)
    listed = "".join(f"{path.relative_to(folder).as_posix()}\n" for path in written)
    write_atomically(folder / "_CoqProject", f"-Q . {LOGICAL}\n{listed}")
    return written
