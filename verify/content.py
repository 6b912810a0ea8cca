"""What is shipped beside the code: what is verified (`reports/`), and published data
(`reference/`).

In a checkout both lie beside the package, in a wheel inside it, in `verify/data`.
"""

from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

_INSTALLED = "data"
_FOLDERS = ("reports", "reference")


def content(*names: str) -> Path:
    """The path of a file or folder of the content, such as `content("reports", "paper")`."""
    return Path(_root(_package()), *names)


def shipped_files(package: Path | None = None) -> dict[str, Path]:
    """Every file of the package and of the content, of whatever kind, by its name.

    A wheel's names are those of the checkout that it was made from. Left out is only what Python
    writes itself. `package`: another one's folder.
    """
    package = package or _package()
    root = _root(package)
    shipped = {f"verify/{name}": path for name, path in _below(package) if not _is_content(name)}
    for folder in _FOLDERS:
        shipped |= {f"{folder}/{name}": path for name, path in _below(root / folder)}
    return shipped


def _package() -> Path:
    return Path(str(files("verify")))


def _root(package: Path) -> Path:
    installed = package / _INSTALLED
    return installed if installed.is_dir() else package.parent


def _is_content(name: str) -> bool:
    return name.partition("/")[0] == _INSTALLED


def _below(folder: Path) -> Iterator[tuple[str, Path]]:
    for path in folder.rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts:
            yield path.relative_to(folder).as_posix(), path
