"""What was read of a Hamiltonian, kept on disk for the commands to come.

A run asks H for its text, its names, where it is smooth, and its element of a ring. To make that of
a formula takes sympy, whose import is half of what a short command does. So what was made is kept
beside the kernels (`verify.code_cache`), and the formula is read again only by who asks for its
expression.

Kept is an H that is smooth everywhere: under a name made of what it was read from, the values of
its parameters, and the code and libraries that read it.
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
from verify.algebra.ring_record import record_of
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


def kept_or_read(
    source: str, values: Mapping[str, str], read: Callable[[Mapping[str, str]], Hamiltonian]
) -> Hamiltonian:
    """The H of that formula, or system, with these values: as it was kept, else as it is `read`,
    and kept from then on where that can be done."""
    if code_cache.folder() is None or not _readers():
        return read(values)
    given = json.dumps(sorted(values.items()))
    key = code_cache.key_of(_FORMAT, _readers(), source, given)
    known = code_cache.load(key)
    if known is not None:
        return Hamiltonian.from_record(json.loads(known))
    found = read(values)
    record = _record_of(found)
    if record is not None:
        written = json.dumps(record, separators=(",", ":")).encode()
        if len(written) <= _MOST_BYTES:
            code_cache.keep(key, written)
    return found


def _record_of(hamiltonian: Hamiltonian) -> dict[str, Any] | None:
    """What is kept of it; None where nothing is."""
    if hamiltonian.domain or hamiltonian.written:
        return None
    if parse(hamiltonian.formula) != hamiltonian.expression:  # with zeros put in it may be so
        return None
    try:
        # Anew, without what schemes have added to the ring that is shared.
        ring, energy, _ = hamiltonian.embedded(most_terms=_MOST_TERMS)
    except InputError:  # too large, or refused where it is asked for
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
    """A name for all that reads a formula; empty where the code is not there to look at."""
    house = Path(__file__).parents[1]
    files = {str(x.relative_to(house)): x for pattern in _CODE for x in house.glob(pattern)}
    return digest_of(files, " ".join(map(version, _LIBRARIES))) if files else ""
