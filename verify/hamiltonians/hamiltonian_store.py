"""Hamiltonians that were parsed, stored on disk for later commands.

A run needs the text of H, its names, the domain where it is smooth, and its element of a ring. To
make these from a formula takes sympy, whose import is half of the time of a short command. So they
are stored with the kernels (`verify.code_cache`), and the formula is parsed again only where its
expression is used.

Only an H that is smooth everywhere is stored: under a name made of the text it was read from, the
values of its parameters, and the code and libraries that read it.
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
    """Return the H of that formula, or system, with these values: from the store, else as it is
    `read`, and stored from then on where possible."""
    if code_cache.folder() is None or not _readers():
        return read(values)
    values_text = json.dumps(sorted(values.items()))
    # The key has the code that reads formulas in it: a new version never uses an old record.
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
    """Return the record of a Hamiltonian; None where it is not stored."""
    if hamiltonian.domain or hamiltonian.text_domain:
        return None
    if parse(hamiltonian.formula) != hamiltonian.expression:  # with zeros put in it may be so
        return None
    try:
        # Anew, without what schemes have added to the ring that is shared.
        ring, energy, _ = hamiltonian.embed_in_ring(most_terms=_MOST_TERMS)
    except InputError:  # too large, or not defined: refused later, where it is used
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
    """Return a digest of all code that reads a formula; empty where the source files are not
    available."""
    house = Path(__file__).parents[1]
    files = {str(x.relative_to(house)): x for pattern in _CODE for x in house.glob(pattern)}
    return digest_of(files, " ".join(map(version, _LIBRARIES))) if files else ""
