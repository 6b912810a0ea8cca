"""What shows that the first coefficient of a defect is not 0: numbers that Rocq calculates with.

For every H, a polynomial H for which it is not 0 at a rational point. For one H, a derivative of it
at a rational point at which sin, cos and exp are taken of 0, so that all values are rational.
"""

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, islice, product
from math import factorial, prod

from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion, Function, derived_by
from verify.proof.certificates.readers import Poly, collected

_POINTS = 4000
_TRIED = 40  # of them, those where all is defined
_NUMBERS = tuple(map(Fraction, ("0", "1", "-1", "2", "1/2", "-2", "3")))
_ENERGIES = 20  # that are drawn
_DERIVATIVES = 6  # by how many coordinates the coefficient is derived
_AT_ZERO = {"sin": Fraction(0), "cos": Fraction(1), "exp": Fraction(1)}
Entry = tuple[str, str]


@dataclass(frozen=True)
class ShownByEnergy:
    """An entry of L, and a polynomial H for which it is not 0 at a point, by its coordinates."""

    entry: Entry
    energy: Poly
    point: Mapping[str, Fraction]


def energy_that_shows(entries: Expansion) -> ShownByEnergy | None:
    """What shows that L is not 0 for every H; None where nothing is found."""
    for entry, leading in entries.leading.items():
        for values in _values_of_derivatives(leading):
            if _value(leading, values):
                point = {x: values.get(x, Fraction(0)) for x in (*entries.coordinates, "t")}
                return ShownByEnergy(entry, _energy(values, point), point)
    return None


def _values_of_derivatives(leading: Poly) -> Iterator[dict[str, Fraction]]:
    """Values that some H has: derivatives at a point are free."""
    for names in sorted(leading, key=len):  # one term that is not 0, and not many beside it
        yield dict.fromkeys(names, Fraction(1))
    names_of_all = sorted({name for names in leading for name in names})
    for attempt in range(_ENERGIES):
        drawn = random.Random(attempt)  # noqa: S311 - no secret
        yield {name: Fraction(drawn.randint(-3, 3)) for name in names_of_all}


def _energy(values: Mapping[str, Fraction], point: Mapping[str, Fraction]) -> Poly:
    """The polynomial whose derivatives at the point these are."""
    made: Poly = {}
    for name, value in values.items():
        if not name.startswith("H_") or not value:
            continue
        by = derived_by(name)
        term: Poly = {(): value / prod(factorial(by.count(x)) for x in set(by))}
        for x in by:  # times (x - its value)
            term = collected([*_times(term, x, Fraction(1)), *_times(term, None, -point[x])])
        made = collected([*made.items(), *term.items()])
    return made


def _times(x: Poly, name: str | None, c: Fraction) -> list[tuple[tuple[str, ...], Fraction]]:
    return [(tuple(sorted([*names, *([name] if name else [])])), c * d) for names, d in x.items()]


def _value(x: Poly, values: Mapping[str, Fraction]) -> Fraction:
    """At values of the names; a coordinate that has none is 0."""
    total = Fraction(0)
    for names, c in x.items():
        total += c * prod(values.get(name, Fraction(0)) for name in names)
    return total


@dataclass(frozen=True)
class Shown:
    """By which coordinates the entry is derived, and the values of all names at a point."""

    entry: Entry
    by: tuple[str, ...]
    values: Mapping[str, Fraction]


def point_that_shows(entries: Expansion) -> Shown | None:
    """A derivative of an entry of L that is not 0 at such a point; None where none is found."""
    for values in islice(_points(entries), _TRIED):
        algebra = Identities(entries)  # which counts its work, for each point anew
        try:
            for entry, leading in entries.leading.items():
                for by, derived in _derived(algebra, leading):
                    if _value(derived, values):
                        return Shown(entry, by, values)
        except ValueError:  # more work than a checker may have
            continue
    return None


def _derived(algebra: Identities, x: Poly) -> Iterator[tuple[tuple[str, ...], Poly]]:
    """The polynomial and its derivatives, low ones first."""
    level: dict[tuple[str, ...], Poly] = {(): x}
    for order in range(_DERIVATIVES + 1):
        yield from level.items()
        if order < _DERIVATIVES:
            chosen = combinations_with_replacement(algebra.given.coordinates, order + 1)
            level = {by: algebra.diff(level[by[:-1]], by[-1]) for by in chosen}


def _points(entries: Expansion) -> Iterator[dict[str, Fraction]]:
    """Points, with values of the parameters, where all functions have rational values."""
    names = (*entries.coordinates, "t", *entries.parameters)
    # 0 first, as arguments have to be; of a parameter last, as it may hide what is sought.
    own = (*_NUMBERS[1:], _NUMBERS[0])
    choices = [own if name in entries.parameters else _NUMBERS[:4] for name in names]
    seen: list[dict[str, Fraction]] = []
    for tried in islice(product(*choices), _POINTS):
        found = _moved(entries.functions, dict(zip(names, tried, strict=True)))
        if found is not None and found not in seen:
            seen.append(found)
            yield found


def _moved(functions: Sequence[Function], at: Mapping[str, Fraction]) -> dict[str, Fraction] | None:
    """Such a point, with the values of all functions there: this one, or one beside it.

    Where a function is of something else than 0, one of the names in its argument gets another
    value, which no function before it depends on.
    """
    values, kept = dict(at), set[str]()
    for made in functions:
        argument = _value(made.argument, values)
        if made.kind == "inverse" and not argument:
            return None
        if made.kind != "inverse" and argument:
            name = next((x for x in at if x not in kept and _slope(made, x, values)), None)
            if name is None:
                return None
            values[name] -= argument / _slope(made, name, values)
        kept |= {name for names in made.argument for name in names}
        values[made.name] = 1 / argument if made.kind == "inverse" else _AT_ZERO[made.kind]
    return values


def _slope(made: Function, name: str, values: Mapping[str, Fraction]) -> Fraction:
    """By how much the argument grows with the name; 0 where not by the same everywhere."""
    if any(names.count(name) > 1 for names in made.argument):
        return Fraction(0)
    rest = {tuple(x for x in m if x != name): c for m, c in made.argument.items() if name in m}
    return _value(rest, values)
