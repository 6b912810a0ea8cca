"""The format of our JSON files: its name and version under the key `format`, read first.

    {"format": "areaproof certificate 2", …}

The version of a format is a whole number. It grows if readers of the old version would misread the
new one. Each format is named where its files are written: `FORMAT` of
`proof.certificates.certificate_file` and of `scenes.results.report` (results.json), `KEPT` and
`CHECKPOINT` of `execution.keeper`, `DATA_FORMAT` of `reference.make.models`, `MANIFEST_FORMAT` of
`reference.make.data_files`.
"""

import json
from pathlib import Path
from typing import Any

from verify.errors import InputError
from verify.files import open_regular_file, read_bytes

_BEGINNING_BYTES = 200  # our files name their format within these


def read_json(path: Path, expected: str) -> dict[str, Any]:
    """Read a JSON object of the format `expected`. InputError if the file does not hold one."""
    try:
        data = json.loads(read_bytes(path), object_pairs_hook=reject_repeated_keys)
    except InputError:
        raise
    except RecursionError:
        # Arrays nested thousands deep exhaust the stack of Python's parser.
        raise InputError("file", str(path), "is not JSON") from None
    except ValueError as error:
        raise InputError("file", str(path), f"is not JSON: {error}") from None
    return check_format(data, expected, str(path))


def reject_repeated_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Build the object; ValueError if a key stands twice."""
    # `json` takes the last of two values, other readers take the first.
    result = dict(pairs)
    if len(result) < len(pairs):
        raise ValueError("a key stands twice")
    return result


def check_format(data: object, expected: str, file: str) -> dict[str, Any]:
    """Return the data if they are an object of the format `expected`.

    >>> check_format({"format": "areaproof certificate 3"}, "areaproof certificate 2", "lie2.json")
    Traceback (most recent call last):
    verify.errors.InputError: file=lie2.json: has the format 'areaproof certificate 3', which is \
newer; this version reads 'areaproof certificate 2'

    Raises InputError, one line, for an older or newer version, for another format and for none.
    """
    if isinstance(data, dict) and data.get("format") == expected:
        return data
    if not isinstance(data, dict):
        problem = f"is no JSON object, but {_shorten(data)}"
    elif "format" not in data:
        problem = "names no format"
    else:
        problem = (
            f"has the format {_shorten(data['format'])}{_describe_age(data['format'], expected)}"
        )
    raise InputError("file", file, f"{problem}; this version reads {expected!r}")


def names_format(path: Path, expected: str) -> bool:
    """Return True if a file's beginning has the name of this format; its version may differ."""
    try:
        with open_regular_file(path) as file:
            return expected.rpartition(" ")[0].encode() in file.read(_BEGINNING_BYTES)
    except InputError:
        return False


def _describe_age(actual: object, expected: str) -> str:
    """Return the remark that a version of the same format is older or newer; else an empty text."""
    (name, _, version), (expected_name, _, current) = (
        str(x).rpartition(" ") for x in (actual, expected)
    )
    if name != expected_name or not version.isdecimal():
        return ""
    # The first nine digits are enough; int() refuses texts of thousands of digits.
    return ", which is newer" if int(version[:9]) > int(current) else ", which is older"


def _shorten(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:60]}…"
