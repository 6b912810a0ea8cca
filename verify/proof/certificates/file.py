"""A certificate's file, checked: what it establishes, and else why it is refused."""

from pathlib import Path
from typing import Any

from verify.formats import read_json
from verify.proof.certificates.checker import check
from verify.proof.certificates.established import Established, established

FORMAT = "areaproof certificate 2"
Certificate = dict[str, Any]  # as JSON has it; who reads it takes nothing for granted


def checked(path: Path) -> Established | str:
    """What it establishes, or why it is refused; InputError where it is no such certificate."""
    data = read_json(path, FORMAT)
    try:
        return established(check(data))
    except ValueError as reason:
        return str(reason)
    except RecursionError:
        return "its functions are nested too deeply"
