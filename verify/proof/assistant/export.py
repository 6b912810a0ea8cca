"""Certificates for a proof assistant: `coqc` accepts what is written, or it proves nothing.

A certificate for one H without the functions that nothing in it is made of.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from verify.errors import InputError
from verify.formats import read_json
from verify.proof.assistant.coefficients import of_stages, of_tableau
from verify.proof.assistant.every import of_every
from verify.proof.assistant.formulas import KEYWORDS
from verify.proof.assistant.names import polynomials_of
from verify.proof.assistant.one import of_one
from verify.proof.assistant.text import Export, body_of, theorems_of, written
from verify.proof.certificates.checker import check
from verify.proof.certificates.coefficients import Stages, Tableau
from verify.proof.certificates.entries import Expansion, Function
from verify.proof.certificates.established import Established, established
from verify.proof.certificates.file import FORMAT
from verify.proof.certificates.readers import need

_MOST, _DEEPEST = 100, 20  # the time of coqc grows with the square of both
_PARTNERS = {"sin": "cos", "cos": "sin"}


def with_used_functions(entries: Expansion) -> Expansion:
    """The certificate with those that H, the map, L and G are made of, and their derivatives.

    What it says holds without the others, too, and where these are not defined. Raises ValueError
    where they are too many, or nested too deeply, for `coqc` to take it within minutes.
    """
    needed = {name for x in polynomials_of(entries) for names in x for name in names}
    kept: list[Function] = []
    for made in reversed(entries.functions):  # outer functions first
        if made.name in needed or _is_partner(made, kept):
            kept.insert(0, made)
            needed |= {name for names in made.argument for name in names}
    for made in entries.functions:  # of those partners that come before the others
        if made not in kept and _is_partner(made, kept):
            kept.append(made)
    order = {made.name: k for k, made in enumerate(entries.functions)}
    functions = tuple(sorted(kept, key=lambda made: order[made.name]))
    need(
        len(functions) <= _MOST, f"it needs more than {_MOST} functions, which coqc takes long for"
    )
    said = f"its functions are nested more than {_DEEPEST} deep, which coqc takes long for"
    need(_depth(functions) <= _DEEPEST, said)
    return replace(entries, functions=functions)


def _depth(functions: Iterable[Function]) -> int:
    """How many of them stand within one another at most."""
    depths: dict[str, int] = {}
    for made in functions:  # inner ones first
        within = (depths.get(name, 0) for names in made.argument for name in names)
        depths[made.name] = 1 + max(within, default=0)
    return max(depths.values(), default=0)


def _is_partner(made: Function, kept: list[Function]) -> bool:
    """Whether it is the cos of a sin, or the sin of a cos, that is needed."""
    return any(f.argument == made.argument and _PARTNERS.get(f.kind) == made.kind for f in kept)


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
