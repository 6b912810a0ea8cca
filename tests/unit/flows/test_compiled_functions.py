"""Gragg's rule as one function, held against the rule in Fractions, of a field whose are exact."""

from collections.abc import Callable, Sequence
from fractions import Fraction

import pytest

from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.arithmetic.exact import quotient
from verify.arithmetic.systems import mpfr
from verify.flows.compiled_functions import ElementCode, defined_values, functions_at

BITS_LOST = Fraction(1, 10**37)  # of 40 digits
Slopes = Callable[..., tuple[Fraction, ...]]
CASES: dict[str, tuple[tuple[str, ...], tuple[str, ...], Slopes]] = {
    "plane": (("p", "q"), ("-q - q**3", "p"), lambda p, q: (-q - q**3, p)),
    "plane in time": (("p", "q", "t"), ("-q*t", "p + t**2"), lambda p, q, t: (-q * t, p + t**2)),
    "two degrees": (
        ("p1", "p2", "q1", "q2"),
        ("-q2", "-q1*q2", "p1", "2*p2"),
        lambda p1, p2, q1, q2: (-q2, -q1 * q2, p1, 2 * p2),
    ),
    # The names are those that the source has for its own variables.
    "names of the source": (
        ("x", "count", "v0", "k", "v1"),
        ("v0", "v1*k", "-x", "x", "-count*x"),
        lambda x, count, v0, k, v1: (v0, v1 * k, -x, x, -count * x),
    ),
    "constant": (("p", "q", "t"), ("1/3", "t"), lambda _p, _q, t: (Fraction(1, 3), t)),
}


def by_hand(slopes: Slopes, z: Sequence[Fraction], time: Fraction, count: int) -> list[Fraction]:
    """The rule as W. B. Gragg has it; the last of z is t where there is one more than slopes."""
    h, first = time / count, list(z)
    own = len(slopes(*z))

    def at(x: Sequence[Fraction], k: int) -> tuple[Fraction, ...]:
        return slopes(*x, *(t + k * h for t in first[own:]))

    before = first[:own]
    x = [a + h * b for a, b in zip(before, at(before, 0), strict=True)]
    for k in range(1, count):
        after = [a + 2 * h * b for a, b in zip(before, at(x, k), strict=True)]
        before, x = x, after
    return [(a + b + h * c) / 2 for a, b, c in zip(x, before, at(x, count), strict=True)]


def written(name: str) -> ElementCode:
    names, formulas, _ = CASES[name]
    ring, elements = embed([parse(x) for x in formulas], names)
    return ElementCode.from_elements(mpfr.make(40), [(ring, x) for x in elements], names)


def apart(name: str, slopes: Slopes, time: Fraction, count: int) -> Fraction:
    """How far the function is from the rule by hand with these slopes."""
    arithmetic, names = mpfr.make(40), CASES[name][0]
    z = [Fraction(k + 2, 7) for k in range(len(names))]
    with arithmetic.context():
        given = [arithmetic.number(x) for x in (*z, time)]
        found = written(name).build_gragg_rule()(*given, count)
    true = by_hand(slopes, z, time, count)
    return max(abs(arithmetic.exact(a) - b) for a, b in zip(found, true, strict=True))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("time", "count"), [("1/3", 1), ("1/3", 2), ("-3/5", 6), ("0", 4)])
def test_it_is_the_rule(name: str, time: str, count: int) -> None:
    assert apart(name, CASES[name][2], Fraction(time), count) < BITS_LOST


@pytest.mark.parametrize("name", CASES)
def test_of_another_field_it_is_not(name: str) -> None:
    _, _, slopes = CASES[name]

    def others(*z: Fraction) -> tuple[Fraction, ...]:
        first, *rest = slopes(*z)
        return (first + Fraction(1, 10**30), *rest)

    assert apart(name, others, Fraction(1, 3), 2) > BITS_LOST


def test_a_clock_that_stands_still_is_another_rule() -> None:
    slopes, at_first = CASES["plane in time"][2], Fraction(4, 7)
    assert apart("plane in time", lambda p, q, _: slopes(p, q, at_first), Fraction(1, 3), 2) > 0.01


def test_slopes_are_those_of_the_functions_beside_it() -> None:
    arithmetic, (names, formulas, slopes) = mpfr.make(40), CASES["two degrees"]
    ring, elements = embed([parse(x) for x in formulas], names)
    z = [Fraction(k + 2, 7) for k in range(4)]
    with arithmetic.context():
        at = functions_at(arithmetic, [(ring, x) for x in elements], names)
        found = at(*(arithmetic.number(x) for x in z))
    for x, y in zip(found, slopes(*z), strict=True):
        assert abs(arithmetic.exact(x) - y) < BITS_LOST


@pytest.mark.parametrize(
    ("formula", "at"),
    [("log(q)/p", []), ("log(q)", [2, 3]), ("1/p", [4]), ("q/p", [4]),
     ("exp(q**10)", [1, 2, 3, 4]), ("exp(q**20)", [1, 2, 3, 4])],
)  # fmt: skip
def test_where_a_function_has_no_value_there_is_none_and_the_others_are_there(
    formula: str, at: list[int]
) -> None:
    """Also where another point's error is seen only when the context is left."""
    made = mpfr.make(40)
    ring, elements = embed([parse(formula)], ("p", "q"))
    function = functions_at(made, [(ring, x) for x in elements])
    points = [(1, "1/3"), (2, 4), (3, -4), (4, -60), (0, 5), (7, 1)] if at else [(1, 2), (3, 4)]
    exact = [tuple(map(Fraction, point)) for point in points]
    found = defined_values(made, function, list(zip(*exact, strict=True)))
    assert [k for k, x in enumerate(found) if x is None] == at
    for point, x in zip(exact, found, strict=True):
        if x is not None:
            with made.context():
                assert [x] == list(function(*map(made.number, point)))
    if not at:
        assert len(found) == 2


def test_numbers_of_other_precisions_are_taken_as_they_are() -> None:
    made, wide = mpfr.make(40), mpfr.make(90)
    ring, elements = embed([parse("p*q")], ("p", "q"))
    function = functions_at(made, [(ring, x) for x in elements])
    given = [0.1, wide.number(Fraction(1, 3)), quotient(Fraction(1, 3)), Fraction(-1, 7)]
    ones = [Fraction(1)] * len(given)
    exact = [Fraction(*map(int, x.as_integer_ratio())) for x in given]
    assert defined_values(made, function, [given, ones]) == list(map(made.number, exact))
