"""The store of parsed Hamiltonians on disk, for later commands.

A run needs the text of H, its names, the domain in which it is smooth, and its element of a ring.
To compute these from a formula takes sympy, whose import is half of the time of a short command. So
they are stored with the kernels (`verify.code_cache`), and the formula is parsed again only if its
expression is used.

Only an H that is smooth everywhere is stored. The key is made of the text from which it was read,
the values of its parameters, and the code and libraries that read it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from verify import code_cache
from verify.algebra.formula import parse
from verify.algebra.ring import record_of
from verify.arithmetic.exact import text
from verify.content import digest_of
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian

_FORMAT = "hamiltonian 2"
_MOST_BYTES, _MOST_TERMS = 2**20, 2000
_CODE = (
    "algebra/**/*.py",
    "functions/**/*.py",
    "hamiltonians/**/*.py",
    "structures/**/*.py",
    "arithmetic/exact.py",
)
_LIBRARIES = ("sympy", "python-flint")


def load_or_read(
    source: str, values: Mapping[str, str], read: Callable[[Mapping[str, str]], Hamiltonian]
) -> Hamiltonian:
    """Return H from the store; if it is not stored, return `read(values)`, and store that if it is
    smooth everywhere. `source`: the formula, or the name of the system."""
    if code_cache.folder() is None or not _readers():
        return read(values)
    values_text = json.dumps(sorted(values.items()))
    # The key has a digest of the code that reads formulas: a new version uses no old record.
    key = code_cache.key_of(_FORMAT, _readers(), source, values_text)
    record_text = code_cache.load(key)
    if record_text is not None:
        return Hamiltonian.from_record(json.loads(record_text))
    hamiltonian = read(values)
    record = _record_of(hamiltonian)
    if record is not None:
        encoded = json.dumps(record, separators=(",", ":")).encode()
        if len(encoded) <= _MOST_BYTES:
            code_cache.keep(key, encoded)
    return hamiltonian


def _record_of(hamiltonian: Hamiltonian) -> dict[str, Any] | None:
    """Return the record of a Hamiltonian; None if it must not be stored."""
    if hamiltonian.domain or hamiltonian.text_domain:
        return None
    # The formula may parse to another expression after zeros were substituted.
    if parse(hamiltonian.formula) != hamiltonian.expression:
        return None
    try:
        # A new ring, since schemes have added generators to the shared one.
        ring, energy, _ = hamiltonian.embed_in_ring(most_terms=_MOST_TERMS)
    except InputError:  # too large, or not defined: an error is raised when it is used
        return None
    return {
        "formula": hamiltonian.formula,
        "values": [(name, text(value)) for name, value in hamiltonian.values],
        "parameters": hamiltonian.parameters,
        "coordinates": hamiltonian.coordinates,
        "time_dependent": hamiltonian.time_dependent,
        "ring": record_of(ring, energy),
        "generic": _record_of(hamiltonian.with_symbols()) if hamiltonian.values else None,
    }


@cache
def _readers() -> str:
    """Return a digest of all code that reads a formula; empty if there are no source files."""
    package = Path(__file__).parents[1]
    files = {str(x.relative_to(package)): x for pattern in _CODE for x in package.glob(pattern)}
    return digest_of(files, " ".join(map(version, _LIBRARIES))) if files else ""
