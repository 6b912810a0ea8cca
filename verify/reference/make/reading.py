"""Files that may be corrupt or hostile → texts and JSON, or one InputError that says what is wrong.

Nothing is read that is larger than `MOST_BYTES`, and no JSON that would become very many objects.
"""

import csv
import io
import json
import re
from typing import Any

from verify.errors import InputError
from verify.files import text_of
from verify.formats import reject_repeated_keys

MOST_CELLS = 8 * 2**20  # or commas and brackets, each about an object of Python's
_MOST_OPEN = 2**21
_HALF = re.compile(r"(?<!\\)(?:\\\\)*\\u[dD][89a-fA-F]")  # a surrogate, which no UTF-8 text has


def json_of(content: bytes, name: str) -> Any:
    """Return the JSON in it, in which no number is a float. InputError for what is not such
    JSON."""
    # Counted before parsing: a few megabytes of brackets would become gigabytes of Python objects.
    opened = content.count(b"[") + content.count(b"{")
    if opened > _MOST_OPEN or opened + content.count(b",") > MOST_CELLS:
        raise InputError("file", name, "has too many parts")
    text = text_of(content, name)
    if _HALF.search(text):
        raise InputError("file", name, "is not JSON in UTF-8: it has half a character, as \\ud800")
    try:
        return json.loads(
            text,
            object_pairs_hook=reject_repeated_keys,
            parse_float=_no_float,
            parse_constant=_no_float,
        )
    except RecursionError:
        raise InputError("file", name, "is nested too deep") from None
    except InputError:
        raise
    except ValueError as error:  # JSONDecodeError is one, and so is an integer of too many digits
        raise InputError("file", name, f"is not JSON: {error}") from None


def _no_float(text: str) -> None:
    raise ValueError(f"{text[:20]} is no number that these files have")


def rows_of(content: bytes, name: str) -> list[tuple[str, ...]]:
    """Return the rows of a CSV file. InputError for what is not CSV."""
    source = text_of(content, name)
    if content.count(b",") > MOST_CELLS or content.count(b"\n") > MOST_CELLS:
        raise InputError("file", name, "has too many cells")
    try:
        return [tuple(row) for row in csv.reader(io.StringIO(source, newline=""), strict=True)]
    except csv.Error as error:
        raise InputError("file", name, f"is not CSV: {error}") from None
