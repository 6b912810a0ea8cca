"""Certificates for a proof assistant: `coqc` accepts what is written, or it proves nothing."""

from pathlib import Path

from verify.errors import InputError
from verify.formats import read_json
from verify.proof.assistant.every import of_every
from verify.proof.assistant.one import of_one
from verify.proof.assistant.text import Export, written
from verify.proof.certificates.checker import check
from verify.proof.certificates.entries import Expansion, Stages
from verify.proof.certificates.established import established
from verify.proof.certificates.file import FORMAT


def exported(path: Path, *, stands_alone: bool = True) -> str:
    """The certificate in this file as one for Rocq.

    Raises InputError where it is no certificate, and where the small checker refuses it.
    """
    try:
        entries = check(read_json(path, FORMAT))
        return written(_export(entries), established(entries), stands_alone=stands_alone)
    except ValueError as reason:
        raise InputError("certificate", str(path), f"is refused: {reason}") from None


def _export(entries: Stages | Expansion) -> Export:
    assert isinstance(entries, Expansion)
    return of_every(entries) if entries.hamiltonian is None else of_one(entries)
