"""Strategies of exact numbers: parameters, initial values and step sizes."""

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Literal, overload

from hypothesis import strategies as st

from verify.algebra.formula import parameter_name
from verify.arithmetic.exact import Number, magnitude, rational, whole
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.values import InitialState, InitialValue
from verify.strategies.arguments import MOST_DEGREES, yes_no
from verify.strategies.terms import signed_quotient

_FARTHEST = 300  # the exponent of the tiniest and the greatest initial values
_DENOMINATORS = (1, 2, 10, 3, 7, 100)  # decimals, and fractions that no binary format holds
_LONG = 10**40
_DIGITS = (1, 2, 5, *range(3, 100))


def parameters(
    names_or_hamiltonian: Iterable[str] | Hamiltonian, *, size: int = 9
) -> st.SearchStrategy[dict[str, Fraction]]:
    """Return a strategy of values for these names, or for H's parameters: ±n/d, n, d = 1 … size.

    None is 0, so that no term of H vanishes; H may still be undefined for one, as log(a*q) is for
    a < 0, and then `with_values` says so. Raises InputError for what is not a parameter's name.
    """
    source = names_or_hamiltonian
    if isinstance(source, Hamiltonian):
        names = source.parameters
    elif isinstance(source, str) or not isinstance(source, Iterable):
        raise InputError("names", source, "is not a list of names, nor a Hamiltonian")
    else:
        names = tuple(source)
    for name in names:
        if not isinstance(name, str):
            raise InputError("parameter", name, "is not a name")
        parameter_name(name)
    whole("size", size, 1)
    values = st.integers(0, 2 * size**2 - 1).map(lambda index: signed_quotient(index, size))
    return st.fixed_dictionaries(dict.fromkeys(names, values))


@overload
def initial_values(
    *, most: Number = ..., extreme: bool = ..., degrees: Literal[1] = ...
) -> st.SearchStrategy[InitialValue]: ...
@overload
def initial_values(
    *, most: Number = ..., extreme: bool = ..., degrees: int
) -> st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState]: ...
def initial_values(
    *, most: Number = 2, extreme: bool = False, degrees: int = 1
) -> st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState]:
    """Return a strategy of exact (q, p) with |q|, |p| ≤ most: decimals, halves, thirds, sevenths.

    `degrees`: of freedom, 1 … 8; for more than one q and p are tuples of so many.

    `extreme`: also exact zeros, 10^−300 … 10^300 of either sign, numbers that differ from whole
    ones by 10^−300 … 0.1, and numbers of 40 digits, all of which may be beyond `most`. Raises
    InputError for most ≤ 0.

    >>> from hypothesis import find, settings
    >>> same = settings(database=None, derandomize=True)
    >>> start = find(initial_values(), lambda z: z.q > 1, settings=same)
    >>> str(start.q), str(start.p)
    ('2', '0')
    """
    numbers = _coordinates(most, yes_no("extreme", extreme))
    return starts(numbers, whole("degrees", degrees, 1, MOST_DEGREES))


def starts(
    numbers: st.SearchStrategy[Fraction], degrees: int
) -> st.SearchStrategy[InitialValue] | st.SearchStrategy[InitialState]:
    """Return a strategy of initial values whose coordinates are such numbers."""
    if degrees == 1:
        return st.builds(InitialValue, q=numbers, p=numbers)
    of_each = st.tuples(*[numbers] * degrees)
    return st.builds(InitialState, q=of_each, p=of_each)


def initial_times(*, most: Number = 2) -> st.SearchStrategy[Fraction]:
    """Return a strategy of exact t₀ with |t₀| ≤ most, of the same kinds as initial values.

    Raises InputError for most ≤ 0.
    """
    return _coordinates(most, extreme=False)


def _coordinates(greatest: Number, extreme: bool) -> st.SearchStrategy[Fraction]:
    most = rational(greatest, "most")
    if most <= 0:
        raise InputError("most", greatest, "must be greater than 0")
    ordinary = [_multiples(most, d) for d in _DENOMINATORS if most * d >= 1]
    # Below 1/100 no denominator of the list leaves a multiple but 0: about ten steps are taken.
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
    """Return a strategy of n/denominator up to ±most; the simplest is 0."""
    top = math.floor(most * denominator)
    return st.integers(-top, top).map(lambda n: Fraction(n, denominator))


def step_sizes(*, least: Number = "1/1000", most: Number = "1/10") -> st.SearchStrategy[Fraction]:
    """Return a strategy of step sizes h with least ≤ h ≤ most.

    They are decimals of one or two digits, powers of two, thirds of decimals, and the two ends.
    Arguments such as "1e-300" and "1e300" give extreme ones. Raises InputError for least ≤ 0 and
    for least > most.

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
    twos = _binary_exponent(high) - _binary_exponent(low) + 1

    def decimal(index: int) -> Fraction:
        # Index 0 is the greatest power of ten up to `most`, to which the drawn number shrinks.
        digits, down = divmod(index, decades)
        return Fraction(_DIGITS[digits]) * Fraction(10) ** (magnitude(high) - down)

    def clamp(h: Fraction) -> Fraction:
        return min(max(h, low), high)

    # Each form takes one choice besides that of the form, so that the simplest is a decimal.
    forms = [
        st.integers(0, decades * len(_DIGITS) - 1).map(decimal),
        st.integers(0, twos - 1).map(lambda n: Fraction(2) ** (_binary_exponent(high) - n)),
        st.integers(0, decades * 3 - 1).map(lambda n: decimal(n) / 3),
    ]
    # A number outside falls on the nearer end, so that no draw is rejected and the ends occur.
    return st.one_of([form.map(clamp) for form in forms])


def _binary_exponent(x: Fraction) -> int:
    """Return the exponent e of x > 0: 2^e ≤ x < 2^(e + 1)."""
    e = x.numerator.bit_length() - x.denominator.bit_length()
    return e if Fraction(2) ** e <= x else e - 1
