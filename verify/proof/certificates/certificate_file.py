"""The check of a certificate's file: the statement that it establishes, or a refusal."""

from pathlib import Path
from typing import Any

from verify.formats import read_json
from verify.proof.certificates.established_statement import EstablishedStatement, check_certificate

FORMAT = "areaproof certificate 2"
Certificate = dict[str, Any]  # a JSON object; its readers check every entry


def check_file(path: Path) -> EstablishedStatement | str:
    """Check a certificate's file: return the statement it establishes, or why it is refused.

    Raises InputError if the file cannot be read or has another format.
    """
    return check_certificate(read_json(path, FORMAT))
