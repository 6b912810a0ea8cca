"""Ring elements that are enclosed again and again, over other boxes: read once.

The same operations in the same order as in `verify.algebra.enclosure`, with its balls.
"""

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import flint

from verify.algebra.enclosure import BALLS, power_of
from verify.algebra.generator import Generator, terms_of
from verify.algebra.ring import Poly, Ring

Ball = Any  # flint.arb
Terms = list[tuple[Any, list[tuple[int, int]]]]  # coefficients, generators with their powers


class Enclosures:
    """Some elements of a ring; equal ones are evaluated once."""

    def __init__(self, ring: Ring, elements: Sequence[Poly]) -> None:
        self.ring, self.elements = ring, elements

    @cached_property
    def _generators(self) -> list[tuple[Generator, Terms]]:
        used = self.ring.used(*self.elements)
        return [(g, [] if g.argument is None else _terms(g.argument)) for g in used]

    @cached_property
    def _distinct(self) -> tuple[list[Terms], list[int]]:
        """The terms of those elements that differ, and of each element its number among them."""
        distinct: list[Poly] = []
        numbers = []
        for x in self.elements:
            if x not in distinct:
                distinct.append(x)
            numbers.append(distinct.index(x))
        return [_terms(x) for x in distinct], numbers

    def over(self, box: Mapping[str, Ball]) -> list[Ball] | None:
        """Balls that contain them at every point of the box, or None where one may be undefined.

        In flint's present precision.
        """
        at = _Point()
        for g, argument in self._generators:
            value = _value(g, argument, at, box)
            if value is None or not value.is_finite():
                return None
            at.values[g.index] = value
        terms, numbers = self._distinct
        found = [at(own) for own in terms]
        return [found[k] for k in numbers]


class _Point:
    """The balls of generators, and their powers as far as they were asked for."""

    def __init__(self) -> None:
        self.values: dict[int, Ball] = {}
        self.powers: dict[tuple[int, int], Ball] = {}

    def __call__(self, terms: Terms) -> Ball:
        total, powers = flint.arb(0), self.powers
        for coefficient, factors in terms:
            term = flint.arb(coefficient)
            for factor in factors:
                known = powers.get(factor)
                if known is None:
                    known = powers[factor] = power_of(self.values[factor[0]], factor[1])
                term *= known
            total += term
        return total


def _value(g: Generator, argument: Terms, at: _Point, box: Mapping[str, Ball]) -> Ball | None:
    if g.kind == "variable":
        return box[str(g.expression)]
    if g.kind == "pi":
        return flint.arb.pi()
    if g.kind == "solved":
        return None
    return at(argument) if g.kind == "stage" else BALLS[g.kind](at(argument), g.degree)


def _terms(x: Poly) -> Terms:
    present = [index for index, degree in enumerate(x.degrees()) if degree > 0]
    return [
        (coefficient, [(index, int(n)) for index in present if (n := monomial[index])])
        for monomial, coefficient in terms_of(x)
    ]
