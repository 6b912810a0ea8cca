"""The format of our JSON files: its name and version under the key `format`, looked at first.

    {"format": "areaproof certificate 2", …}

A format's version is a whole number, which grows when a reader of the old one would misread the
new. Each format is named where its files are made: `FORMAT` of `proof.certificates.file` and of
`scenes.results.report` (results.json), `KEPT` and `CHECKPOINT` of `execution.keeping`,
`DATA_FORMAT` and `MANIFEST_FORMAT` of `reference.make.models`.
"""

import json
from pathlib import Path
from typing import Any

from verify.errors import InputError
from verify.files import opened, read_bytes

_BEGINNING = 200  # bytes within which our files name their format


def read_json(path: Path, wanted: str) -> dict[str, Any]:
    """The object of that format in a file. InputError for what is not there, or no such JSON."""
    try:
        data = json.loads(read_bytes(path), object_pairs_hook=unique)
    except InputError:
        raise
    except RecursionError:
        raise InputError("file", str(path), "is not JSON") from None
    except ValueError as error:
        raise InputError("file", str(path), f"is not JSON: {error}") from None
    return check_format(data, wanted, str(path))


def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """The object; ValueError where a key stands twice, of which each reader may take another."""
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a key stands twice")
    return found


def check_format(data: object, wanted: str, file: str) -> dict[str, Any]:
    """The data, if they are an object of the format `wanted`.

    >>> check_format({"format": "areaproof certificate 3"}, "areaproof certificate 2", "lie2.json")
    Traceback (most recent call last):
    verify.errors.InputError: file=lie2.json: has the format 'areaproof certificate 3', which is \
newer; this version reads 'areaproof certificate 2'

    Raises InputError, one line, for an older or newer version, for another format and for none.
    """
    if isinstance(data, dict) and data.get("format") == wanted:
        return data
    if not isinstance(data, dict):
        found = f"is no JSON object, but {_short(data)}"
    elif "format" not in data:
        found = "names no format"
    else:
        found = f"has the format {_short(data['format'])}{_age(data['format'], wanted)}"
    raise InputError("file", file, f"{found}; this version reads {wanted!r}")


def names_format(path: Path, wanted: str) -> bool:
    """Whether a file's beginning names this format, of whatever version; False where none is."""
    try:
        with opened(path) as file:
            return wanted.rpartition(" ")[0].encode() in file.read(_BEGINNING)
    except InputError:
        return False


def _age(found: object, wanted: str) -> str:
    """Whether it is the same format of another version."""
    (name, _, version), (own, _, current) = (str(x).rpartition(" ") for x in (found, wanted))
    if name != own or not version.isdecimal():
        return ""
    return ", which is newer" if int(version[:9]) > int(current) else ", which is older"


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:60]}…"
