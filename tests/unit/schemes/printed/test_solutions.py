"""That an exact solution lies near printed numbers is shown where one does, and nowhere else."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

import flint
import pytest

from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.schemes.printed.neighbourhood import AnyNumbers, Neighbourhood
from verify.schemes.printed.solutions import HELD, _solution, _upper, nearest

Function = Callable[[Sequence[Ball]], Ball]


class Conditions(Neighbourhood):
    """Conditions written down, with their derivatives, near numbers of one unit each."""

    def __init__(
        self,
        start: Sequence[Fraction],
        values: Sequence[Function],
        slopes: Sequence[Sequence[Function]],
        second: Sequence[float],
    ) -> None:
        self._values, self._slopes = values, slopes
        self.names = tuple(f"x{k}" for k in range(len(start)))
        exact = dict(zip(self.names, start, strict=True))
        self.numbers = AnyNumbers(
            {n: str(x) for n, x in exact.items()}, exact, dict.fromkeys(exact, Fraction(1, 10**8))
        )
        self.start = [rational_ball(x) for x in start]
        self.unit = [rational_ball(Fraction(1, 10**8)) for _ in start]
        self.second = [flint.arb(x) for x in second]
        self.value = self.residuals(self.start, range(len(values)))
        self.slope = self.slopes(self.start, self.value)

    def residuals(self, at: Sequence[Ball], rows: Sequence[int]) -> dict[int, Ball]:
        return {k: self._values[k](at) for k in rows}

    def slopes(self, at: Sequence[Ball], value: Mapping[int, Ball]) -> dict[int, list[Ball]]:
        return {k: [slope(at) for slope in self._slopes[k]] for k in value}


def parabola(start: Fraction, shift: Fraction) -> Conditions:
    """x² + shift = 0."""
    return Conditions(
        [start], [lambda x: x[0] * x[0] + rational_ball(shift)], [[lambda x: 2 * x[0]]], [2]
    )


@pytest.mark.parametrize("near", [4, 10, 40, 100])
@pytest.mark.parametrize("above", [3, 10, 100, 200])
def test_a_parabola_that_stays_above_0_has_no_zero_near_its_lowest_point(
    near: int, above: int
) -> None:
    """Where its slope is small the second derivative is all that is left."""
    with working_precision(600):
        start = Fraction(1, 2**near)
        conditions = parabola(start, start / 2**above)
        assert _solution(conditions, [0], conditions.start) is None
        assert nearest(conditions, [0]) is None


def square_of_sum(start: Fraction, count: int, shift: Fraction) -> Conditions:
    """(x0 + x1 + …)² + shift = 0, all of whose second derivatives are 2."""

    def total(x: Sequence[Ball]) -> Ball:
        return sum(x, flint.arb(0))

    return Conditions(
        [start / count] * count, [lambda x: total(x) ** 2 + rational_ball(shift)],
        [[lambda x: 2 * total(x)] * count], [2],
    )  # fmt: skip


@pytest.mark.parametrize("count", [1, 2, 3, 8])
@pytest.mark.parametrize("near", [10, 40])
def test_of_several_numbers_the_second_derivatives_bend_along_all_of_them(
    near: int, count: int
) -> None:
    with working_precision(600):
        start = Fraction(1, 2**near)
        conditions = square_of_sum(start, count, start / 2**100)
        assert _solution(conditions, [0], conditions.start) is None


@pytest.mark.parametrize("count", [1, 2, 3, 8])
def test_what_several_numbers_within_their_units_make_is_not_excluded(count: int) -> None:
    """At its lowest point a square of a sum of n numbers of unit u reaches (n u)², and no more."""
    with working_precision(600):
        reached = (Fraction(count) / 10**8) ** 2
        for share, beyond in ((Fraction(9, 10), False), (Fraction(11, 10), True)):
            conditions = square_of_sum(Fraction(0), count, -share * reached)
            assert conditions._excludes({0: flint.arb(1)}, 1) is beyond
            assert conditions._excludes({0: flint.arb(-3)}, 1) is beyond


@pytest.mark.parametrize("off", [12, 30, 60])
def test_a_zero_that_is_near_is_shown_and_where_it_is(off: int) -> None:
    with working_precision(600):
        for root in (Fraction(1, 3), Fraction(-5, 7)):
            conditions = parabola(root + Fraction(1, 2**off), -root * root)
            found = nearest(conditions, [0])
            assert found is not None
            assert (found.shown_count, found.other_residual) == (1, 0)
            assert abs(found.numbers["x0"] - root) < Fraction(1, 2**150)
            assert abs(found.distance / (Fraction(10**8, 2**off)) - 1) < Fraction(1, 2**20)
            balls = _solution(conditions, [0], [rational_ball(found.numbers["x0"])])
            assert balls is not None
            assert balls[0].overlaps(rational_ball(root))


def test_a_condition_that_depends_on_another_has_to_hold_there_too() -> None:
    """x y = 1/4 and x + y = 1 have the one solution ½, ½, at which x = ½ to any digit."""
    quarter, half = flint.arb(0.25), flint.arb(0.5)
    with working_precision(600):

        def conditions(shift: Ball) -> Conditions:
            return Conditions(
                [Fraction(1, 2) + Fraction(1, 10**8), Fraction(1, 2)],
                [lambda x: x[0] - half, lambda x: x[1] - half,
                 lambda x: x[0] * x[1] - quarter + shift],
                [[lambda _: flint.arb(1), lambda _: flint.arb(0)],
                 [lambda _: flint.arb(0), lambda _: flint.arb(1)],
                 [lambda x: x[1], lambda x: x[0]]],
                [0, 0, 1],
            )  # fmt: skip

        found = nearest(conditions(flint.arb(0)), [0, 1, 2])
        assert found is not None
        assert found.shown_count == 2
        assert found.other_residual < HELD
        assert nearest(conditions(flint.arb(2) ** -190), [0, 1, 2]) is None


def test_how_far_a_solution_is_counts_the_ball_that_it_is_known_in() -> None:
    """The end of the ball that is farther away, of either sign."""
    with working_precision(100):
        for middle in (3, -3):
            assert 0 <= _upper(flint.arb(middle, 0.5)) - Fraction(7, 2) < Fraction(1, 2**25)


@pytest.mark.parametrize(("off", "shown"), [("1/40", True), ("1/20", False), ("1/10", False)])
def test_a_solution_beyond_where_derivatives_are_bounded_is_not_shown(
    off: str, shown: bool
) -> None:
    """Beyond a quarter of the radius of Cauchy's bound nothing is known of the second ones."""
    with working_precision(600):
        conditions = Conditions(
            [Fraction(0)], [lambda x: x[0] - rational_ball(Fraction(off))],
            [[lambda _: flint.arb(1)]], [0],
        )  # fmt: skip
        assert (nearest(conditions, [0]) is not None) is shown
