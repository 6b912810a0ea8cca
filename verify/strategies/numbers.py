"""Exact numbers: parameters, initial values and step sizes."""

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Literal, overload

from hypothesis import strategies as st

from verify.algebra.formula import parameter_name
from verify.arithmetic.exact import Exact, magnitude, rational
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.values import InitialState, InitialValue
from verify.strategies.arguments import MOST_DEGREES, whole, yes_no
from verify.strategies.terms import signed_quotient

_FARTHEST = 300  # the exponent of the tiniest and the greatest initial values
_DENOMINATORS = (1, 2, 10, 3, 7, 100)
_LONG = 10**40
_DIGITS = (1, 2, 5, *range(3, 100))


def parameters(
    names_or_hamiltonian: Iterable[str] | Hamiltonian, *, size: int = 9
) -> st.SearchStrategy[dict[str, Fraction]]:
    """A value for each of these names, or for each parameter of H: ±n/d with n, d = 1 … size.

    None is 0, so that no term of H vanishes; H may still be undefined for one, as log(a*q) is for
    a < 0, and then `with_values` says so. Raises InputError for what is not a parameter's name.
    """
    given = names_or_hamiltonian
    if isinstance(given, Hamiltonian):
        names = given.parameters
    elif isinstance(given, str) or not isinstance(given, Iterable):
        raise InputError("names", given, "is not a list of names, nor a Hamiltonian")
    else:
        names = tuple(given)
    for name in names:
        if not isinstance(name, str):
            raise InputError("parameter", name, "is not a name")
        parameter_name(name)
    whole("size", size, 1)
    values = st.integers(0, 2 * size**2 - 1).map(lambda index: signed_quotient(index, size))
    return st.fixed_dictionaries(dict.fromkeys(names, values))


@overload
def initial_values(
    *, most: Exact = ..., extreme: bool = ..., degrees: Literal[1] = ...
) -> st.SearchStrategy[InitialValue]: ...
@overload
def initial_values(
    *, most: Exact = ..., extreme: bool = ..., degrees: int
) -> st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState]: ...
def initial_values(
    *, most: Exact = 2, extreme: bool = False, degrees: int = 1
) -> st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState]:
    """(q, p) as exact rationals with |q|, |p| ≤ most: decimals, halves, thirds and sevenths.

    `degrees`: of freedom, 1 … 8; for more than one q and p are tuples of so many.

    `extreme`: also exact zeros, 10^−300 … 10^300 of either sign, numbers that differ from whole
    ones by 10^−300 … 0.1, and numbers of 40 digits, all of which may be beyond `most`. Raises
    InputError for most ≤ 0.

    >>> from hypothesis import find, settings
    >>> same = settings(database=None, derandomize=True)
    >>> found = find(initial_values(), lambda z: z.q > 1, settings=same)
    >>> str(found.q), str(found.p)
    ('2', '0')
    """
    numbers = _coordinates(most, yes_no("extreme", extreme))
    return starts(numbers, whole("degrees", degrees, 1, MOST_DEGREES))


def starts(
    numbers: st.SearchStrategy[Fraction], degrees: int
) -> st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState]:
    """Initial values whose coordinates are such numbers."""
    if degrees == 1:
        return st.builds(InitialValue, q=numbers, p=numbers)
    of_each = st.tuples(*[numbers] * degrees)
    return st.builds(InitialState, q=of_each, p=of_each)


def initial_times(*, most: Exact = 2) -> st.SearchStrategy[Fraction]:
    """t₀ as an exact rational with |t₀| ≤ most, of the kinds of numbers that initial values are.

    Raises InputError for most ≤ 0.
    """
    return _coordinates(most, extreme=False)


def _coordinates(asked: Exact, extreme: bool) -> st.SearchStrategy[Fraction]:
    most = rational(asked, "most")
    if most <= 0:
        raise InputError("most", asked, "must be greater than 0")
    ordinary = [_multiples(most, d) for d in _DENOMINATORS if most * d >= 1]
    ordinary = ordinary or [_multiples(most, math.ceil(10 / most))]
    if not extreme:
        return st.one_of(ordinary)
    signs, exponents = st.sampled_from((1, -1)), st.integers(1, _FARTHEST)
    whole_numbers = st.integers(-math.ceil(most), math.ceil(most))
    return st.one_of(
        *ordinary,
        st.just(Fraction(0)),
        st.builds(lambda sign, n: sign * Fraction(1, 10**n), signs, exponents),
        st.builds(lambda sign, n: sign * Fraction(10**n), signs, exponents),
        st.builds(lambda k, s, n: k + s * Fraction(1, 10**n), whole_numbers, signs, exponents),
        _multiples(most, _LONG),
    )


def _multiples(most: Fraction, denominator: int) -> st.SearchStrategy[Fraction]:
    """n/denominator up to ±most; the simplest is 0."""
    top = math.floor(most * denominator)
    return st.integers(-top, top).map(lambda n: Fraction(n, denominator))


def step_sizes(*, least: Exact = "1/1000", most: Exact = "1/10") -> st.SearchStrategy[Fraction]:
    """Step sizes h with least ≤ h ≤ most: decimals of one or two digits, powers of two, thirds of
    decimals, and the two ends. Arguments such as "1e-300" and "1e300" give extreme ones.

    Raises InputError for least ≤ 0, least > most,.

    >>> from hypothesis import find, settings
    >>> str(find(step_sizes(), lambda h: h < 1, settings=settings(database=None)))
    '1/10'
    """
    low, high = rational(least, "least"), rational(most, "most")
    if low <= 0:
        raise InputError("least", least, "must be greater than 0")
    if low > high:
        raise InputError("least", least, f"is greater than most={high}")
    decades = magnitude(high) - magnitude(low) + 1
    twos = _binary(high) - _binary(low) + 1

    def decimal(index: int) -> Fraction:
        digits, down = divmod(index, decades)
        return Fraction(_DIGITS[digits]) * Fraction(10) ** (magnitude(high) - down)

    def within(h: Fraction) -> Fraction:
        return min(max(h, low), high)

    # One choice each beside that of the form: the simplest is a decimal.
    forms = [
        st.integers(0, decades * len(_DIGITS) - 1).map(decimal),
        st.integers(0, twos - 1).map(lambda n: Fraction(2) ** (_binary(high) - n)),
        st.integers(0, decades * 3 - 1).map(lambda n: decimal(n) / 3),
    ]
    return st.one_of([form.map(within) for form in forms])


def _binary(x: Fraction) -> int:
    """The exponent e of x > 0: 2^e ≤ x < 2^(e + 1)."""
    e = x.numerator.bit_length() - x.denominator.bit_length()
    return e if Fraction(2) ** e <= x else e - 1
