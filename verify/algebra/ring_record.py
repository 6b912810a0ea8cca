"""A ring and an element of it as plain data, from which both are rebuilt without parsing.

The record has what `verify.algebra.embedding.embed` builds: generators with their relations and
gradients, without additions by schemes.
"""

from collections.abc import Mapping
from typing import Any

import flint

from verify.algebra.generator import Poly, terms_of
from verify.algebra.ring import Ring

Record = dict[str, Any]  # of lists, texts and whole numbers
_Terms = list[tuple[list[int], str, str]]  # exponents, numerator, denominator


def record_of(ring: Ring, x: Poly) -> Record:
    """Return the ring and its element x as data for JSON."""
    functions = [g for g in ring.generators if g.kind != "variable"]
    return {
        "variables": ring.variables,
        "room": ring.room,
        "generators": [
            [g.kind, None if g.argument is None else _terms(g.argument), g.degree]
            for g in functions
        ],
        "relations": [
            [index, power, _terms(relation)] for index, power, relation in ring.relations
        ],
        "gradients": [
            [g.index, {name: _terms(part) for name, part in ring.gradient(g.index).items()}]
            for g in functions
        ],
        "element": _terms(x),
    }


def ring_from_record(record: Mapping[str, Any]) -> tuple[Ring, Poly]:
    """Rebuild the ring and the element from their record."""
    ring = Ring(record["variables"], record["room"], spare=0)
    places = ring.context.gens()
    for kind, argument, degree in record["generators"]:
        ring.add(kind, None if argument is None else _poly(ring, argument), degree)
    # Generators come before relations and gradients, which refer to them by their places.
    for index, power, relation in record["relations"]:
        ring.relate(places[index], power, _poly(ring, relation))
    for index, gradient in record["gradients"]:
        ring.set_partials(places[index], {n: _poly(ring, part) for n, part in gradient.items()})
    return ring, _poly(ring, record["element"])


def _terms(x: Poly) -> _Terms:
    # In hexadecimal: Python reads no decimal number of more than 4300 digits.
    return [([*map(int, powers)], f"{int(c.p):x}", f"{int(c.q):x}") for powers, c in terms_of(x)]


def _poly(ring: Ring, terms: _Terms) -> Poly:
    return ring.context.from_dict(
        {tuple(powers): flint.fmpq(int(p, 16), int(q, 16)) for powers, p, q in terms}
    )
