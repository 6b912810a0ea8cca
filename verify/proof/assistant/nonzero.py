"""What shows that the first coefficient of a defect is not 0: numbers that Rocq calculates with.

For every H, a polynomial H for which it is not 0 at p = q = 0. For one H, a derivative of it at a
rational point at which sin, cos and exp are taken of 0, so that all values are rational.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, islice, product
from math import factorial, prod

from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion, derived_by
from verify.proof.certificates.readers import Poly

_POINTS = 4000
_TRIED = 40  # of them, those where all is defined
_NUMBERS = tuple(map(Fraction, ("0", "1", "-1", "2", "1/2", "-2", "3")))
_DERIVATIVES = 6  # by how many coordinates the coefficient is derived
_AT_ZERO = {"sin": Fraction(0), "cos": Fraction(1), "exp": Fraction(1)}
Entry = tuple[str, str]


def energy_that_shows(entries: Expansion) -> tuple[Entry, Poly] | None:
    """The entry of L that is not 0 for an H, and that polynomial H; None where none is found."""
    for entry, leading in entries.leading.items():
        for names in sorted(leading, key=len):  # one term that is not 0, and not many beside it
            values = {name: Fraction(1) for name in names if name.startswith("H_")}
            if _value(leading, values):
                return entry, _energy(values)
    return None


def _energy(values: Mapping[str, Fraction]) -> Poly:
    """The polynomial whose derivatives at 0 these are."""
    made: Poly = {}
    for name, value in values.items():
        by = derived_by(name)
        if value:
            made[tuple(sorted(by))] = value / prod(factorial(by.count(x)) for x in set(by))
    return made


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
    for tried in islice(product(*choices), _POINTS):
        values = dict(zip(names, tried, strict=True))
        for made in entries.functions:
            argument = _value(made.argument, values)
            if made.kind == "inverse" and argument:
                values[made.name] = 1 / argument
            elif made.kind != "inverse" and not argument:
                values[made.name] = _AT_ZERO[made.kind]
            else:
                break
        else:
            yield values
