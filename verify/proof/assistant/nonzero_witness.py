"""Numbers that show Rocq that the leading coefficient of a defect is not 0.

For every H, they are a polynomial H and a rational point at which the coefficient is not 0. For one
H, they are a derivative of the coefficient and a rational point at which it is not 0; the arguments
of sin, cos and exp are 0 there, so that all values are rational.
"""

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, islice, product
from math import factorial, prod

from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion, NamedFunction, derived_by
from verify.proof.certificates.readers import Poly, collect_terms

_MOST_POINTS = 4000
_MOST_WITNESSES = 40  # limit of the points with rational values of all functions
_NUMBERS = tuple(map(Fraction, ("0", "1", "-1", "2", "1/2", "-2", "3")))
_RANDOM_ATTEMPTS = 20
_MOST_DERIVATIVES = 6  # limit of the order of derivatives of the coefficient
_AT_ZERO = {"sin": Fraction(0), "cos": Fraction(1), "exp": Fraction(1)}
Entry = tuple[str, str]


@dataclass(frozen=True)
class EnergyWitness:
    """An entry of L, and a polynomial H (`energy`) and a `point` for which it is not 0."""

    entry: Entry
    energy: Poly
    point: Mapping[str, Fraction]


def energy_that_shows(entries: Expansion) -> EnergyWitness | None:
    """Find an H, with a point, for which L is not 0; None if none is found."""
    for entry, leading in entries.leading.items():
        for values in _values_of_derivatives(leading):
            if _value(leading, values):
                point = {x: values.get(x, Fraction(0)) for x in (*entries.coordinates, "t")}
                return EnergyWitness(entry, _energy(values, point), point)
    return None


def _values_of_derivatives(leading: Poly) -> Iterator[dict[str, Fraction]]:
    """Yield values of the coordinates and of H's derivatives; some H has these values."""
    for names in sorted(leading, key=len):  # then one term is not 0, and few others
        yield dict.fromkeys(names, Fraction(1))
    names_of_all = sorted({name for names in leading for name in names})
    for attempt in range(_RANDOM_ATTEMPTS):
        generator = random.Random(attempt)  # noqa: S311 - no secret
        yield {name: Fraction(generator.randint(-3, 3)) for name in names_of_all}


def _energy(values: Mapping[str, Fraction], point: Mapping[str, Fraction]) -> Poly:
    """Return the polynomial H that has these derivatives at the point."""
    energy: Poly = {}
    for name, value in values.items():
        if not name.startswith("H_") or not value:
            continue
        coordinates = derived_by(name)
        term: Poly = {(): value / prod(factorial(coordinates.count(x)) for x in set(coordinates))}
        for x in coordinates:
            # value·Π (x − point)ⁿ/n! has this one derivative at the point, and no other.
            term = collect_terms([*_times(term, x, Fraction(1)), *_times(term, None, -point[x])])
        energy = collect_terms([*energy.items(), *term.items()])
    return energy


def _times(x: Poly, name: str | None, c: Fraction) -> list[tuple[tuple[str, ...], Fraction]]:
    return [(tuple(sorted([*names, *([name] if name else [])])), c * d) for names, d in x.items()]


def _value(x: Poly, values: Mapping[str, Fraction]) -> Fraction:
    """Evaluate x at values of the names; a coordinate without a value is 0."""
    total = Fraction(0)
    for names, c in x.items():
        total += c * prod(values.get(name, Fraction(0)) for name in names)
    return total


@dataclass(frozen=True)
class NonzeroWitness:
    """An entry of L, the variables of its derivative, and the values of all names at a point."""

    entry: Entry
    derived_by: tuple[str, ...]
    values: Mapping[str, Fraction]


def point_that_shows(entries: Expansion) -> NonzeroWitness | None:
    """Find a rational point, and a derivative of an entry of L that is not 0 there; or None.

    All functions have rational values there.
    """
    for values in islice(_points(entries), _MOST_WITNESSES):
        algebra = Identities(entries)  # a new one for each point, as its work is limited
        try:
            for entry, leading in entries.leading.items():
                for coordinates, derived in _with_derivatives(algebra, leading):
                    if _value(derived, values):
                        return NonzeroWitness(entry, coordinates, values)
        except ValueError:  # the limit of work is reached
            continue
    return None


def _with_derivatives(algebra: Identities, x: Poly) -> Iterator[tuple[tuple[str, ...], Poly]]:
    """Yield the polynomial and its derivatives, low orders first."""
    level: dict[tuple[str, ...], Poly] = {(): x}
    for order in range(_MOST_DERIVATIVES + 1):
        yield from level.items()
        if order < _MOST_DERIVATIVES:
            chosen = combinations_with_replacement(algebra.entries.coordinates, order + 1)
            level = {index: algebra.diff(level[index[:-1]], index[-1]) for index in chosen}


def _points(entries: Expansion) -> Iterator[dict[str, Fraction]]:
    """Yield points, with values of the parameters, where all functions have rational values."""
    names = (*entries.coordinates, "t", *entries.parameters)
    # 0 comes first for coordinates, as arguments must be 0; last for a parameter, as L may vanish.
    numbers = (*_NUMBERS[1:], _NUMBERS[0])
    choices = [numbers if name in entries.parameters else _NUMBERS[:4] for name in names]
    previous: list[dict[str, Fraction]] = []
    for tried in islice(product(*choices), _MOST_POINTS):
        values = _make_rational(entries.functions, dict(zip(names, tried, strict=True)))
        if values is not None and values not in previous:
            previous.append(values)
            yield values


def _make_rational(
    functions: Sequence[NamedFunction], point: Mapping[str, Fraction]
) -> dict[str, Fraction] | None:
    """Return a point at which all functions are rational, with their values; None if not found.

    It is `point` if possible. If the argument of a sin, cos or exp is not 0, one of the names in it
    gets another value; no earlier function may depend on that name.
    """
    values, fixed = dict(point), set[str]()
    for function in functions:
        argument = _value(function.argument, values)
        if function.kind == "inverse" and not argument:
            return None
        # One Newton step solves argument = 0 exactly, as the argument is linear in the chosen name.
        if function.kind != "inverse" and argument:
            name = next((x for x in point if x not in fixed and _slope(function, x, values)), None)
            if name is None:
                return None
            values[name] -= argument / _slope(function, name, values)
        fixed |= {name for names in function.argument for name in names}
        values[function.name] = (
            1 / argument if function.kind == "inverse" else _AT_ZERO[function.kind]
        )
    return values


def _slope(function: NamedFunction, name: str, values: Mapping[str, Fraction]) -> Fraction:
    """Return the derivative of the argument by a name; 0 unless the argument is linear in it."""
    if any(names.count(name) > 1 for names in function.argument):
        return Fraction(0)
    slope = {tuple(x for x in m if x != name): c for m, c in function.argument.items() if name in m}
    return _value(slope, values)
