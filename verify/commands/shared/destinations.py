"""Options that name a file or folder to write, checked before anything is computed.

A missing folder is made, but only in an existing one: if more is missing, the path may be mistyped.
"""

import re
from pathlib import Path
from typing import Any

from verify.commands.shared.input import NonemptyPath
from verify.errors import InputError
from verify.files import check_replaceable, clear_abandoned

STANDARD_OUTPUT = Path("-")
_KEPT_FOLDER = "kept"  # the name of the folder of finished results, within that of a report
# With one of these suffixes a name means a file.
_FILE_SUFFIXES = ".csv .htm .html .json .md .pdf .png .svg .toml .txt .v .zip".split()  # noqa: SIM905


class _OutFile(NonemptyPath):
    """The type of a file to write, in an existing folder.

    A - is not checked: a command may take it for standard output.
    """

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:

        path, option = super().convert(value, param, ctx), param.opts[-1]
        if path != STANDARD_OUTPUT:
            _check_parent(path, option)
            check_replaceable(path, option)
            try:
                ensure_writable(path.parent)
            except InputError as error:
                raise InputError(option, str(path), error.problem) from None
        return path


class _OutFolder(NonemptyPath):
    """The type of a folder to write into, which exists or can be made in an existing one."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        path = super().convert(value, param, ctx)
        option = param.opts[-1] if param.opts[-1].startswith("-") else param.metavar
        if path.suffix.lower() in _FILE_SUFFIXES and not path.is_dir():
            problem = f"names a file; give a folder, into which files are written: {path.stem}"
            raise InputError(option, str(path), problem)
        _check_parent(path, option)
        return path


OUT_FILE, OUT_FOLDER = _OutFile(path_type=Path), _OutFolder(path_type=Path)


def _check_parent(path: Path, option: str = "--output") -> None:
    if not path.parent.is_dir():
        problem = f"there is no folder {path.parent}; make it first, or give one that is there"
        raise InputError(option, str(path), problem)


def ensure_writable(folder: Path, option: str = "--output") -> None:
    """Make the folder, and check that a file can be made in it; InputError if it cannot."""
    from tempfile import TemporaryFile

    _check_parent(folder, option)
    if folder.exists() and not folder.is_dir():
        raise InputError(option, str(folder), "File exists, and is no folder; give a folder")
    try:
        folder.mkdir(exist_ok=True)
        # Permissions alone do not tell: the disk may be full or mounted read-only.
        with TemporaryFile(dir=folder):
            pass
    except OSError as error:
        problem = error.strerror or "cannot be written to"
        advice = "give a folder that can be written to"
        raise InputError(option, str(folder), f"{problem}; {advice}") from None


def check_ours(folder: Path, pattern: re.Pattern[str] | None = None, *, advice: str = "") -> None:
    """Raise InputError if a folder holds files that an earlier report of ours did not write.

    A folder of ours has the data of a report, of whatever version; or else nothing but the kept
    results of an interrupted report, and files whose names match `pattern`.
    """
    from verify.formats import names_format
    from verify.pages.page import DATA
    from verify.scenes.results.report import FORMAT

    try:
        names = (
            {path.name for path in folder.iterdir()} - {_KEPT_FOLDER} if folder.exists() else set()
        )
        foreign = [name for name in sorted(names) if pattern is None or not pattern.fullmatch(name)]
        # A report of any version is ours, and may be replaced by a new one.
        if foreign and not names_format(folder / DATA, FORMAT):
            problem = f"holds {foreign[0]!a}, which is not ours; take another folder{advice}"
            raise InputError("--output", str(folder), problem)
    except OSError as error:
        raise InputError("--output", str(folder), error.strerror or "cannot be read") from None


def ensure_keepable(folder: Path, option: str = "--keep") -> None:
    """Make a folder where results are kept, as `ensure_writable` does.

    InputError also if it lies in what verify ships: the name of a kept result has a digest of all
    shipped files, so that a result kept there would change the names of all results.
    """
    from verify.content import is_shipped

    if is_shipped(folder):
        problem = "lies in what verify ships; allowed: any other folder"
        raise InputError(option, str(folder), problem)
    ensure_writable(folder, option)
    clear_abandoned(folder)


def ensure_writable_later(folder: Path) -> None:
    """Check --output as `ensure_writable` does, but remove the folder again if that made it."""
    existed = folder.exists()
    ensure_writable(folder)
    if not existed:
        folder.rmdir()
