"""A certificate's file, checked: what it establishes, and else why it is refused."""

from pathlib import Path
from typing import Any

from verify.formats import read_json
from verify.proof.certificates.established import Established, accepted

FORMAT = "areaproof certificate 2"
Certificate = dict[str, Any]  # as JSON has it; who reads it takes nothing for granted


def checked(path: Path) -> Established | str:
    """What it establishes, or why it is refused; InputError where it is no such certificate."""
    return accepted(read_json(path, FORMAT))
