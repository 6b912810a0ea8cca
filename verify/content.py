"""The content shipped with the code: scenes and claims (`reports/`), published data (`reference/`).

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
    """Return the path of a file or folder of the content, such as `content("reports", "paper")`."""
    return Path(_find_root(_package()), *names)


def checkout() -> Path | None:
    """Return the folder of the checkout that holds the package; None if it is installed."""
    root = _find_root(_package())
    return root if root == _package().parent else None


def shipped_files(package: Path | None = None) -> dict[str, Path]:
    """Return every file of the package and of the content by its name, of whatever kind.

    A wheel has the names of the checkout that it was built from. Files that Python, an editor or
    the system writes there are left out: bytecode, hidden files, backups. `package`: the folder of
    another installation.
    """
    package = package or _package()
    root = _find_root(package)
    shipped = {
        f"verify/{name}": path for name, path in _walk_files(package) if not _is_content(name)
    }
    for folder in _FOLDERS:
        shipped |= {f"{folder}/{name}": path for name, path in _walk_files(root / folder)}
    return shipped


def digest_of(files: Mapping[str, Path], others: str = "") -> str:
    """Return the SHA-256 digest of these files, each with its name, and of `others`."""
    digest = hashlib.sha256(others.encode())
    for name, path in sorted(files.items()):
        raw = path.read_bytes()
        # With its length, so that no content can imitate the beginning of the next file.
        digest.update(f"\n{name} {len(raw)}\n".encode() + raw)
    return digest.hexdigest()


def is_shipped(path: Path) -> bool:
    """Return True if the path lies in the package or in the content.

    Writing there would change what is shipped, and the digest of all shipped files with it.
    """
    # With links followed: a link into the package leads there, too.
    root, target = _find_root(_package()), path.resolve()
    folders = (_package(), *(root / name for name in _FOLDERS))
    return any(target.is_relative_to(folder.resolve()) for folder in folders)


def _package() -> Path:
    return Path(str(files("verify")))


def _find_root(package: Path) -> Path:
    """Return the folder that holds the content; RuntimeError if neither place has all of it."""
    for root in (package / _INSTALLED, package.parent):
        is_candidate = root != package.parent or (root / _CHECKOUT).is_file()
        if is_candidate and all((root / name).is_dir() for name in _FOLDERS):
            return root
    raise RuntimeError(f"{package}: neither a checkout nor whole: no {' and no '.join(_FOLDERS)}")


def _is_content(name: str) -> bool:
    return name.partition("/")[0] == _INSTALLED


def _walk_files(folder: str | Path, prefix: str = "") -> Iterator[tuple[str, Path]]:
    # Each command that keeps results goes through all files: scandir knows their kinds at once,
    # which is ten times as fast as to ask each path.
    with os.scandir(folder) as entries:
        for entry in entries:
            name = entry.name
            if name.startswith(".") or name.endswith("~") or name == "__pycache__":
                continue  # left behind
            if entry.is_dir(follow_symlinks=False):
                yield from _walk_files(entry.path, f"{prefix}{name}/")
            elif entry.is_file():
                yield f"{prefix}{name}", Path(entry.path)
