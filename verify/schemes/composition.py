"""Compositions of maps in closed form: of polynomial ones in the ring, and how large others are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from verify.algebra.formula import symbol
from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring
from verify.late import sympy

Map = tuple[Poly, Poly]  # p' and q'
STATE = ("p", "q")


def polynomial(ring: Ring, maps: Sequence[Map]) -> bool:
    """Whether p and q occur in no generator, so that the maps are polynomials in them."""
    inside = arguments(ring, *(x for pair in maps for x in pair))
    return not any(ring.depends(a, name) for a in inside for name in STATE)


def arguments(ring: Ring, *elements: Poly) -> list[Poly]:
    """The arguments of the generators that the elements are made of."""
    return [g.argument for g in ring.generators_in(*elements) if g.argument is not None]


def composed_polynomials(ring: Ring, maps: Sequence[Map], most: int) -> list[Poly] | None:
    """p' and q' of polynomial maps, the first one made first; None beyond `most` terms."""
    start: list[Poly] = [ring.variable(name) for name in STATE]
    for pair in maps:
        after = [_at(ring, x, start, most) for x in pair]
        start = [x for x in after if x is not None]
        if len(start) < len(after):
            return None
    return start


def in_stages(ring: Ring, elements: Sequence[Poly]) -> bool:
    """Whether there are no other generators in the elements than names of stages."""
    return all(g.kind in ("variable", "stage") for g in ring.generators_in(*elements))


def unfolded(ring: Ring, elements: Sequence[Poly], most: int) -> list[Poly] | None:
    """Elements that are `in_stages` with every name replaced by what it stands for.

    None where there are more than `most` terms on the way.
    """
    used = ring.generators_in(*elements)
    images = {g.index: ring.variable(g.name) for g in used if g.kind == "variable"}
    for g in used:
        if g.kind == "stage":
            image = _put(ring, g.inner, images, most)
            if image is None:
                return None
            images[g.index] = image
    found = [x for y in elements if (x := _put(ring, y, images, most)) is not None]
    return found if len(found) == len(elements) else None


def _put(ring: Ring, x: Poly, images: Mapping[int, Poly], most: int) -> Poly | None:
    """The polynomial with generators replaced by their images; None beyond `most` terms."""
    powers: dict[tuple[int, int], Poly] = {}

    def power(index: int, n: int) -> Poly:
        if (index, n) not in powers:
            powers[index, n] = images[index] * (power(index, n - 1) if n > 1 else ring.one)
        return powers[index, n]

    total = ring.zero
    for monomial, coefficient in terms_of(x):
        term = ring.context.constant(coefficient)
        for index, degree in enumerate(monomial):
            for n in range(1, int(degree) + 1):
                if len(power(index, n)) > most:
                    return None
            if degree:
                term = term * power(index, int(degree))
            if len(term) > most:
                return None
        total += term
        if len(total) > most:
            return None
    return total


def _at(ring: Ring, x: Poly, point: Sequence[Poly], most: int) -> Poly | None:
    """The polynomial at a point of polynomials, by Horner's rule in p, the coefficients in q."""

    def horner(x: Poly, at: int) -> Poly | None:
        if at == len(STATE):
            return x
        powers = ring.powers(x, STATE[at])
        total = ring.zero
        for n in range(max(powers, default=0), -1, -1):
            inner = horner(powers.get(n, ring.zero), at + 1)
            if inner is None:
                return None
            total = ring.multiply(total, point[at]) + inner
            if len(total) > most:
                return None
        return total

    return horner(x, 0)


def occurrences(ring: Ring, maps: Sequence[Map]) -> int:
    """How often p and q occur in the composition as a formula: it may double with every map."""
    sizes = dict.fromkeys(map(symbol, STATE), 1)
    for pair in maps:
        formulas = [list(sympy.preorder_traversal(ring.expression(x))) for x in pair]
        counts = [sum(f.count(y) * size for y, size in sizes.items()) for f in formulas]
        sizes = dict(zip(sizes, counts, strict=True))
    return sum(sizes.values())
