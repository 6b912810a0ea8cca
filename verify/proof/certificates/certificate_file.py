"""The check of a certificate's file: what it establishes, or why it is refused."""

from pathlib import Path
from typing import Any

from verify.formats import read_json
from verify.proof.certificates.established_statement import EstablishedStatement, check_certificate

FORMAT = "areaproof certificate 2"
Certificate = dict[str, Any]  # as in JSON; its readers check every entry


def check_file(path: Path) -> EstablishedStatement | str:
    """Check a certificate's file: return what it establishes, or the reason of the refusal.

    Raises InputError if the file is no such certificate.
    """
    return check_certificate(read_json(path, FORMAT))
