"""What is shipped beside the code: what is verified (`reports/`), and published data
(`reference/`).

In a checkout both lie beside the package, in a wheel inside it, in `verify/data`.
"""

import hashlib
import os
from collections.abc import Iterator, Mapping
from importlib.resources import files
from pathlib import Path

_INSTALLED = "data"
_FOLDERS = ("reports", "reference")
_CHECKOUT = "pyproject.toml"  # beside the package; else a folder of that name is somebody else's


def content(*names: str) -> Path:
    """The path of a file or folder of the content, such as `content("reports", "paper")`."""
    return Path(_root(_package()), *names)


def checkout() -> Path | None:
    """The folder of the checkout that the package lies in; None where it is installed."""
    root = _root(_package())
    return root if root == _package().parent else None


def shipped_files(package: Path | None = None) -> dict[str, Path]:
    """Every file of the package and of the content, of whatever kind, by its name.

    A wheel's names are those of the checkout that it was made from. Left out is what Python, an
    editor or the system writes there: bytecode, hidden files, backups. `package`: another one's
    folder.
    """
    package = package or _package()
    root = _root(package)
    shipped = {f"verify/{name}": path for name, path in _below(package) if not _is_content(name)}
    for folder in _FOLDERS:
        shipped |= {f"{folder}/{name}": path for name, path in _below(root / folder)}
    return shipped


def digest_of(files: Mapping[str, Path], others: str = "") -> str:
    """A name for what these files hold, each under its name, and for `others`."""
    digest = hashlib.sha256(others.encode())
    for name, path in sorted(files.items()):
        raw = path.read_bytes()
        digest.update(f"\n{name} {len(raw)}\n".encode() + raw)
    return digest.hexdigest()


def is_shipped(path: Path) -> bool:
    """Whether the path lies in the package or in the content, so that to write there is to change
    what is shipped.
    """
    root, place = _root(_package()), path.resolve()
    folders = (_package(), *(root / name for name in _FOLDERS))
    return any(place.is_relative_to(folder.resolve()) for folder in folders)


def _package() -> Path:
    return Path(str(files("verify")))


def _root(package: Path) -> Path:
    """The folder with both folders of the content; RuntimeError where neither place has them."""
    for root in (package / _INSTALLED, package.parent):
        mine = root != package.parent or (root / _CHECKOUT).is_file()
        if mine and all((root / name).is_dir() for name in _FOLDERS):
            return root
    raise RuntimeError(f"{package}: neither a checkout nor whole: no {' and no '.join(_FOLDERS)}")


def _is_content(name: str) -> bool:
    return name.partition("/")[0] == _INSTALLED


def _below(folder: str | Path, prefix: str = "") -> Iterator[tuple[str, Path]]:
    # Each command that keeps results goes through all files: scandir knows their kinds at once,
    # which is ten times as fast as to ask each path.
    with os.scandir(folder) as entries:
        for entry in entries:
            name = entry.name
            if name.startswith(".") or name.endswith("~") or name == "__pycache__":
                continue  # left behind
            if entry.is_dir(follow_symlinks=False):
                yield from _below(entry.path, f"{prefix}{name}/")
            elif entry.is_file():
                yield f"{prefix}{name}", Path(entry.path)
