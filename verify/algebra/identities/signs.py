"""The sign of a polynomial that has one wherever it is defined, shown by its terms or its roots.

Shown are: a sum of terms of one sign, each a product of even powers and of what is positive; a
sum of even powers of one generator whose coefficients have one sign; a polynomial in one generator
without a (positive) root; a quadratic a x² + b x + c where a and 4ac − b² have a sign that is
shown; a number beside which terms in sines and cosines are small. What has no sign, or is too hard
to see, has none here.
"""

from typing import Any, Protocol

import flint

from verify.algebra.identities.polynomials import Poly, split, terms_of

_DEEPEST = 3
_MOST_TERMS = 60
_MOST_DEGREE = 40
_MOST_BITS = 2000


class Known(Protocol):
    """What is known of the generators, each of which is real."""

    def positive(self, place: int) -> bool:
        """Whether the generator of that place is > 0 wherever it is defined."""
        ...

    def bounded(self, place: int) -> bool:
        """Whether it is between −1 and 1."""
        ...


def definite(x: Poly, known: Known, *, strict: bool = False) -> int | None:
    """1 where x ≥ 0 everywhere, −1 where x ≤ 0 everywhere, None where that is not shown.

    `strict`: that x vanishes nowhere is shown, too.
    """
    if x.is_zero() or len(x) > _MOST_TERMS:
        return None
    if strict and _vanishes_at_origin(x, known):
        return None
    return _definite(x, known, strict, _DEEPEST)


def _vanishes_at_origin(x: Poly, known: Known) -> bool:
    """Whether x is 0 where all generators are, and nothing known here excludes that point.

    What is shown below holds for all such values of the generators: the search would end without
    a result, of a squared distance in space only after 5000 polynomials.
    """
    degrees = x.degrees()
    return x[(0,) * len(degrees)] == 0 and not any(
        power and known.positive(place) for place, power in enumerate(degrees)
    )


def _definite(x: Poly, known: Known, strict: bool, levels: int) -> int | None:
    if x.is_zero():
        return None
    by_terms = _by_terms(x, known, strict)
    if by_terms is not None or levels < 0:
        return by_terms
    common = x.term_content()
    if not common.is_constant():
        # The common power product is a polynomial of one term.
        sign = _by_terms(common, known, strict)
        rest = sign and _definite(x / common, known, strict, levels - 1)
        return sign * rest if sign and rest else None
    degrees = x.degrees()
    places = [place for place, power in enumerate(degrees) if power > 0]
    if len(places) == 1:
        return _by_roots(x, places[0], degrees[places[0]], known)
    for place in places:
        found = _by_even_powers(x, place, known, strict, levels - 1)
        if found is None and degrees[place] == 2:
            found = _by_square(x, place, known, strict, levels - 1)
        if found is not None:
            return found
    return None


def _by_terms(x: Poly, known: Known, strict: bool) -> int | None:
    """By terms that all have one sign, but for such as are together smaller than a number."""
    number = x[(0,) * len(x.degrees())]
    own, room, nowhere_zero = (number > 0) - (number < 0), abs(number), False
    for monomial, c in terms_of(x):
        places = [place for place, power in enumerate(monomial) if power]
        signed = all(monomial[place] % 2 == 0 or known.positive(place) for place in places)
        if signed and own * c >= 0:
            own = 1 if c > 0 else -1
            nowhere_zero |= all(known.positive(place) for place in places)
        elif number != 0 and all(known.bounded(place) for place in places):
            room -= abs(c)
        else:
            return None
    if number != 0 and room < 0:
        return None
    return own if not strict or (nowhere_zero and (number == 0 or room > 0)) else None


def _by_roots(x: Poly, place: int, degree: int, known: Known) -> int | None:
    """Of a polynomial in one generator: strictly, as it must have no root at all."""
    coefficients = [flint.fmpq(0)] * (degree + 1)
    for monomial, c in terms_of(x):
        coefficients[monomial[place]] = c
    polynomial = flint.fmpq_poly(coefficients).numer()
    if degree > _MOST_DEGREE or polynomial.height_bits() > _MOST_BITS:
        return None
    found: Any = polynomial.complex_roots()  # a real root's imaginary part is 0, exactly
    real = [root for root, _ in found if root.imag == 0]
    if any(not (known.positive(place) and root.real < 0) for root in real):
        return None
    return 1 if x.leading_coefficient() > 0 else -1


def _by_even_powers(x: Poly, place: int, known: Known, strict: bool, levels: int) -> int | None:
    """Of a sum of even powers of one generator, of any powers where it is positive."""
    signs = set()
    for power, part in split(x, place).items():
        if power % 2 and not known.positive(place):
            return None
        signs.add(_definite(part, known, strict and power == 0, levels))
    return signs.pop() if len(signs) == 1 else None


def _by_square(x: Poly, place: int, known: Known, strict: bool, levels: int) -> int | None:
    parts = split(x, place)
    c, b, a = (parts.get(power, x * 0) for power in range(3))
    sign = _definite(a, known, True, levels)
    if sign is None or _definite(4 * a * c - b * b, known, strict, levels) != 1:
        return None
    return sign
