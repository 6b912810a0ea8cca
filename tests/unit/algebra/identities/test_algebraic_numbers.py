"""Whether algebraic numbers are 0, by bounds from below."""

from fractions import Fraction

import flint
import pytest

from verify.algebra.identities.algebraic_numbers import bounds_of, number_sign, rational_root
from verify.algebra.identities.field import Field, Quotient, UndecidedError
from verify.algebra.identities.powers import Divisors, FinerError, Powers


def powers() -> Powers:
    """With square roots of primes, as many as are asked for."""
    finer = Divisors()
    finer.divisors |= {("root", k): 2 for k in range(40)}
    return Powers(Field((), 40), finer)


def root(of: Powers, n: int | Quotient) -> Quotient:
    x = of.field.number(n) if isinstance(n, int) else n
    return of.power(x, Fraction(1, 2))


def test_sums_of_roots_that_cancel_are_zero_and_others_have_their_sign() -> None:
    of = powers()
    one, two, three = of.field.one, root(of, 2), root(of, 3)
    nested = root(of, one.times(5) + (two * three).times(2))
    assert number_sign(of.field, (nested - two - three).above) == 0
    tiny = of.field.number(Fraction(1, 10**500))
    assert number_sign(of.field, (nested - two - three + tiny).above) == 1
    assert number_sign(of.field, (nested - two - three - tiny).above) == -1
    assert number_sign(of.field, (two - three).above) == -1


def test_the_size_of_a_number_bounds_its_conjugates() -> None:
    of = powers()
    x = (root(of, 2).times(Fraction(1, 3)) + root(of, 3)).above
    own = bounds_of(of.field, x)
    assert own.degree == 4
    assert own.divisor == 3
    assert 2.2034 < own.house < 2.2035  # √3 + √2/3


def test_numbers_of_too_high_a_degree_are_left_undecided() -> None:
    of = powers()
    total = of.field.zero
    for prime in (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31):
        total += root(of, prime)
    with pytest.raises(UndecidedError):
        number_sign(of.field, total.above)


def test_a_unit_that_is_too_coarse_asks_for_a_finer_one_once() -> None:
    finer = Divisors()
    of = Powers(Field((), 4), finer)
    with pytest.raises(FinerError):
        of.power(of.field.number(2), Fraction(1, 3))
    of = Powers(Field((), 4), finer)
    cube = of.power(of.field.number(2), Fraction(1, 3))
    assert (cube**3).rational == 2


@pytest.mark.parametrize(
    ("number", "degree", "expected"),
    [(flint.fmpq(8, 27), 3, flint.fmpq(2, 3)),
     (flint.fmpq(2), 2, None), (flint.fmpq(4, 3), 2, None), (flint.fmpq(10**80 + 1), 2, None),
     (flint.fmpq(10**80), 2, flint.fmpq(10**40))],
)  # fmt: skip
def test_a_root_is_rational_or_not(
    number: flint.fmpq, degree: int, expected: flint.fmpq | None
) -> None:
    assert rational_root(number, degree) == expected
