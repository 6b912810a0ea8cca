"""Options that name what is written, and what is seen of it before anything is computed.

A folder that is not there is made, but only under one that is: what is typed may be mistyped.
"""

import re
from pathlib import Path
from typing import Any

from verify.commands.shared.input import GivenPath
from verify.errors import InputError

STANDARD_OUTPUT = Path("-")
_KEPT = "kept"  # the folder of what is finished
# Of a name that ends so a file is meant.
_OF_FILES = ".csv .htm .html .json .md .pdf .png .svg .toml .txt .v .zip".split()  # noqa: SIM905


class _OutFile(GivenPath):
    """A file that is to be written, in a folder that is there; or -, which an option may take."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        from verify.files import check_replaceable

        path, option = super().convert(value, param, ctx), param.opts[-1]
        if path != STANDARD_OUTPUT:
            _check_above(path, option)
            check_replaceable(path, option)
            try:
                writable(path.parent)
            except InputError as error:
                raise InputError(option, str(path), error.problem) from None
        return path


class _OutFolder(GivenPath):
    """A folder that is to be written into, which is there, or is to be made in one that is."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        path = super().convert(value, param, ctx)
        option = param.opts[-1] if param.opts[-1].startswith("-") else param.metavar
        if path.suffix.lower() in _OF_FILES and not path.is_dir():
            problem = f"names a file; give a folder, into which files are written: {path.stem}"
            raise InputError(option, str(path), problem)
        _check_above(path, option)
        return path


OUT_FILE, OUT_FOLDER = _OutFile(path_type=Path), _OutFolder(path_type=Path)


def _check_above(path: Path, option: str = "--output") -> None:
    if not path.parent.is_dir():
        problem = f"there is no folder {path.parent}; make it first, or give one that is there"
        raise InputError(option, str(path), problem)


def writable(folder: Path, option: str = "--output") -> None:
    """Makes the folder, and sees that a file can be made in it; InputError where that cannot be."""
    from tempfile import TemporaryFile

    _check_above(folder, option)
    if folder.exists() and not folder.is_dir():
        raise InputError(option, str(folder), "File exists, and is no folder; give a folder")
    try:
        folder.mkdir(exist_ok=True)
        with TemporaryFile(dir=folder):
            pass
    except OSError as error:
        problem = error.strerror or "cannot be written to"
        advice = "give a folder that can be written to"
        raise InputError(option, str(folder), f"{problem}; {advice}") from None


def check_ours(folder: Path, own: re.Pattern[str] | None = None, *, advice: str = "") -> None:
    """InputError where a folder holds files, and not those of an earlier report of ours.

    Ours has a report's data, of whatever version, or nothing but what an interrupted one has kept,
    and files whose names match `own`.
    """
    from verify.formats import names_format
    from verify.pages.page import DATA
    from verify.scenes.results.report import FORMAT

    try:
        names = {path.name for path in folder.iterdir()} - {_KEPT} if folder.exists() else set()
        foreign = [name for name in sorted(names) if own is None or not own.fullmatch(name)]
        if foreign and not names_format(folder / DATA, FORMAT):
            problem = f"holds {foreign[0]!a}, which is not ours; take another folder{advice}"
            raise InputError("--output", str(folder), problem)
    except OSError as error:
        raise InputError("--output", str(folder), error.strerror or "cannot be read") from None


def keepable(folder: Path, option: str = "--keep") -> None:
    """As `writable`, for a folder where results are kept.

    InputError also where it lies in what is shipped: the name of a kept result is made of all files
    there, so that what is kept would make itself unknown.
    """
    from verify.content import is_shipped
    from verify.files import clear_abandoned

    if is_shipped(folder):
        problem = "lies in what verify ships; allowed: any other folder"
        raise InputError(option, str(folder), problem)
    writable(folder, option)
    clear_abandoned(folder)


def writable_later(folder: Path) -> None:
    """As `writable` for --output, and leaves no folder that was not there."""
    there = folder.exists()
    writable(folder)
    if not there:
        folder.rmdir()
