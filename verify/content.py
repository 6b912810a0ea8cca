"""The content shipped with the code: scenes and claims (`reports/`), published data (`reference/`).

In a checkout both lie beside the package, in an installed wheel inside it, in `verify/data`.
"""

import hashlib
import os
from collections.abc import Iterator, Mapping
from importlib.resources import files
from pathlib import Path

_DATA_FOLDER = "data"  # the folder of the content within an installed package
_CONTENT_FOLDERS = ("reports", "reference")
_CHECKOUT_FILE = "pyproject.toml"  # without it a folder `reports` beside the package is not ours


def content(*names: str) -> Path:
    """Return the path of a file or folder of the content, such as `content("reports", "paper")`."""
    return Path(_find_root(_package()), *names)


def checkout() -> Path | None:
    """Return the folder of the checkout that holds the package; None if it is installed."""
    root = _find_root(_package())
    return root if root == _package().parent else None


def shipped_files(package: Path | None = None) -> dict[str, Path]:
    """Return every file of the package and of the content, by its name in a checkout.

    Files of all kinds are returned but those that Python, an editor or the system adds: bytecode,
    hidden files, backups. `package`: the folder of the package, if it is that of another
    installation.
    """
    package = package or _package()
    root = _find_root(package)
    shipped = {
        f"verify/{name}": path for name, path in _walk_files(package) if not _is_content(name)
    }
    for folder in _CONTENT_FOLDERS:
        shipped |= {f"{folder}/{name}": path for name, path in _walk_files(root / folder)}
    return shipped


def digest_of(files: Mapping[str, Path], others: str = "") -> str:
    """Return the SHA-256 digest of these files, each with its name, and of `others`."""
    digest = hashlib.sha256(others.encode())
    for name, path in sorted(files.items()):
        raw = path.read_bytes()
        # With the length of a file no content can imitate the beginning of the next one.
        digest.update(f"\n{name} {len(raw)}\n".encode() + raw)
    return digest.hexdigest()


def is_shipped(path: Path) -> bool:
    """Return True if the path lies in the package or in the content.

    Writing there would change what is shipped, and the digest of all shipped files with it.
    """
    # Links are followed, as a link may lead into the package.
    root, target = _find_root(_package()), path.resolve()
    folders = (_package(), *(root / name for name in _CONTENT_FOLDERS))
    return any(target.is_relative_to(folder.resolve()) for folder in folders)


def _package() -> Path:
    return Path(str(files("verify")))


def _find_root(package: Path) -> Path:
    """Return the folder that holds the content; RuntimeError if neither place has both folders."""
    for root in (package / _DATA_FOLDER, package.parent):
        is_candidate = root != package.parent or (root / _CHECKOUT_FILE).is_file()
        if is_candidate and all((root / name).is_dir() for name in _CONTENT_FOLDERS):
            return root
    raise RuntimeError(
        f"{package}: neither a checkout nor whole: no {' and no '.join(_CONTENT_FOLDERS)}"
    )


def _is_content(name: str) -> bool:
    return name.partition("/")[0] == _DATA_FOLDER


def _walk_files(folder: str | Path, prefix: str = "") -> Iterator[tuple[str, Path]]:
    # Each command that keeps results walks through all files. `scandir` gives their kinds with
    # their names, which is ten times as fast as a call for each path.
    with os.scandir(folder) as entries:
        for entry in entries:
            name = entry.name
            if name.startswith(".") or name.endswith("~") or name == "__pycache__":
                continue  # not ours
            if entry.is_dir(follow_symlinks=False):
                yield from _walk_files(entry.path, f"{prefix}{name}/")
            elif entry.is_file():
                yield f"{prefix}{name}", Path(entry.path)
