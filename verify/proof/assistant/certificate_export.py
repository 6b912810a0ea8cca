"""Certificates exported for Rocq: an exported file proves something only if `coqc` accepts it.

A certificate for one H is exported without the functions that it does not use.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from verify.errors import InputError
from verify.formats import read_json
from verify.proof.assistant.rocq_formulas import KEYWORDS, polynomials_of
from verify.proof.assistant.text import Export, body_of, render_file, theorems_of
from verify.proof.assistant.theorems_by_coefficients import export_stages, export_tableau
from verify.proof.assistant.theorems_for_every_h import export_for_every_h
from verify.proof.assistant.theorems_for_one_h import export_for_one_h
from verify.proof.certificates.certificate_file import FORMAT
from verify.proof.certificates.checker import check
from verify.proof.certificates.coefficients import ButcherTableau, Stages
from verify.proof.certificates.entries import Expansion, NamedFunction
from verify.proof.certificates.established_statement import EstablishedStatement, state_theorem
from verify.proof.certificates.readers import need

# Limits of the number and the nesting of functions; coqc's time grows with the square of both.
_MOST_FUNCTIONS, _MOST_LEVELS = 100, 20
_PARTNERS = {"sin": "cos", "cos": "sin"}
_FILE_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\.v")


@dataclass(frozen=True)
class ExportedFile:
    """An exported file: its `text`, the `facts` it states, and its `theorems` in order."""

    text: str
    facts: EstablishedStatement
    theorems: tuple[str, ...]


def export_certificate(path: Path, *, stands_alone: bool = True) -> ExportedFile:
    """Export the certificate in a file for Rocq.

    `stands_alone`: True if the export includes the needed parts of the theory. Raises InputError if
    the file is no certificate, if the small checker refuses it, and if it is too large for `coqc`.
    """
    data = read_json(path, FORMAT)
    try:
        entries = check(data)
        if isinstance(entries, Expansion):
            entries = with_used_functions(entries)
        export = _export(entries)
        established_facts = state_theorem(entries, nonzero=export.shows_nonzero)
    except InputError:
        raise
    except ValueError as reason:
        raise InputError("file", str(path), f"is refused: {reason}") from None
    except RecursionError:
        problem = "is refused: its functions are nested too deeply, or too many"
        raise InputError("file", str(path), problem) from None
    text = render_file(export, established_facts, stands_alone=stands_alone)
    return ExportedFile(text, established_facts, theorems_of(body_of(export)))


def _export(entries: Stages | ButcherTableau | Expansion) -> Export:
    if isinstance(entries, Stages):
        return export_stages(entries)
    if isinstance(entries, ButcherTableau):
        return export_tableau(entries)
    if entries.hamiltonian is None:
        return export_for_every_h(entries)
    return export_for_one_h(entries, entries.hamiltonian)


def check_file_name(path: Path) -> None:
    """Raise InputError unless `coqc` takes a file of this name, which is also a module name."""
    if not _FILE_NAME.fullmatch(path.name) or path.stem in KEYWORDS:
        problem = "coqc takes a name of letters, digits and _ that ends in .v, such as lie2.v"
        raise InputError("coq", str(path), problem)


# -- used functions -------------------------------------------------------------------------------


def with_used_functions(entries: Expansion) -> Expansion:
    """Drop the functions that H, the map, L and G, and their derivatives, do not use.

    The statement holds without them, also at points where they are not defined. Raises ValueError
    if the remaining ones are so many, or nested so deeply, that `coqc` would take more than
    minutes.
    """
    names_in_use = {name for x in polynomials_of(entries) for names in x for name in names}
    functions_in_use: list[NamedFunction] = []
    for function in reversed(entries.functions):  # outer functions first
        if function.name in names_in_use or _is_partner(function, functions_in_use):
            functions_in_use.insert(0, function)
            names_in_use |= {name for names in function.argument for name in names}
    # sin' is cos and cos' is −sin: derivatives need the partner, which may come earlier in the
    # file.
    for function in entries.functions:
        if function not in functions_in_use and _is_partner(function, functions_in_use):
            functions_in_use.append(function)
    order = {function.name: k for k, function in enumerate(entries.functions)}
    functions = tuple(sorted(functions_in_use, key=lambda function: order[function.name]))
    need(
        len(functions) <= _MOST_FUNCTIONS,
        f"it needs more than {_MOST_FUNCTIONS} functions, which coqc takes long for",
    )
    problem = f"its functions are nested more than {_MOST_LEVELS} deep, which coqc takes long for"
    need(_depth(functions) <= _MOST_LEVELS, problem)
    return replace(entries, functions=functions)


def _depth(functions: Iterable[NamedFunction]) -> int:
    """Return the number of levels to which the functions are nested."""
    depths: dict[str, int] = {}
    for function in functions:  # inner ones first
        inner_depths = (depths.get(name, 0) for names in function.argument for name in names)
        depths[function.name] = 1 + max(inner_depths, default=0)
    return max(depths.values(), default=0)


def _is_partner(function: NamedFunction, functions: list[NamedFunction]) -> bool:
    """Return True if it is the cos of a sin, or the sin of a cos, in `functions`."""
    return any(
        f.argument == function.argument and _PARTNERS.get(f.kind) == function.kind
        for f in functions
    )
