"""Certificates for a proof assistant: `coqc` accepts what is written, or it proves nothing."""

import re
from dataclasses import dataclass
from pathlib import Path

from verify.errors import InputError
from verify.formats import read_json
from verify.proof.assistant.coefficients import of_stages, of_tableau
from verify.proof.assistant.every import of_every
from verify.proof.assistant.formulas import KEYWORDS
from verify.proof.assistant.one import of_one
from verify.proof.assistant.text import Export, body_of, theorems_of, written
from verify.proof.assistant.used import with_used_functions
from verify.proof.certificates.checker import check
from verify.proof.certificates.coefficients import Stages, Tableau
from verify.proof.certificates.entries import Expansion
from verify.proof.certificates.established import Established, established
from verify.proof.certificates.file import FORMAT

_FILE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\.v")


@dataclass(frozen=True)
class Exported:
    """`text`: of the file; `of`: what it proves; `theorems`: their names in it, in order."""

    text: str
    of: Established
    theorems: tuple[str, ...]


def exported(path: Path, *, stands_alone: bool = True) -> Exported:
    """The certificate in this file as one for Rocq.

    Raises InputError where it is no certificate, and where the small checker refuses it.
    """
    data = read_json(path, FORMAT)
    try:
        entries = check(data)
        if isinstance(entries, Expansion):
            entries = with_used_functions(entries)
        export = _export(entries)
        of = established(entries, nonzero=export.shows_nonzero)
    except InputError:
        raise
    except ValueError as reason:
        raise InputError("file", str(path), f"is refused: {reason}") from None
    except RecursionError:
        said = "is refused: its functions are nested too deeply, or too many"
        raise InputError("file", str(path), said) from None
    text = written(export, of, stands_alone=stands_alone)
    return Exported(text, of, theorems_of(body_of(export)))


def check_file_name(path: Path) -> None:
    """InputError unless `coqc` takes a file of this name, which is that of a module."""
    if not _FILE.fullmatch(path.name) or path.stem in KEYWORDS:
        said = "coqc takes a name of letters, digits and _ that ends in .v, such as lie2.v"
        raise InputError("coq", str(path), said)


def _export(entries: Stages | Tableau | Expansion) -> Export:
    if isinstance(entries, Stages):
        return of_stages(entries)
    if isinstance(entries, Tableau):
        return of_tableau(entries)
    if entries.hamiltonian is None:
        return of_every(entries)
    return of_one(entries, entries.hamiltonian)
