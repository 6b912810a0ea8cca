"""Whether a component whose slopes have not settled leaves an order open."""

import math
from fractions import Fraction
from types import SimpleNamespace

import pytest

from verify.integrators.measures.order import PlaceOrder, _judged
from verify.integrators.measures.slopes import on_their_way
from verify.integrators.places.place import Place

ONE = Fraction(1)
PLACE = Place((ONE, ONE), Fraction(0), (ONE, ONE), (ONE, ONE), ONE)
STEPS = [k / 32 for k in (*range(32, 16, -2), *range(16, 3, -1))]


def judged(*errors):
    """Of p' and q', each error a function of h."""
    step = SimpleNamespace(names=("p", "q"))
    rows = [[(h, abs(e(h)), 1e-16) for h in STEPS] for e in errors]
    below = [[e(h) < 0 for h in STEPS] for e in errors]
    return _judged(step, PLACE, rows, below, [0] * len(STEPS), STEPS, "floats", 0.0)


def settled(h):
    return h**6 / 20


class TestAComponentThatHasNotSettled:
    @pytest.mark.parametrize("at", [0.1, 0.4, 0.7])
    def test_leaves_an_order_as_it_is_where_its_terms_cancel(self, at):
        assert judged(lambda h: h**6 / 30 * (1 - h / at), settled).power == 6

    def test_leaves_an_order_as_it_is_where_little_is_seen_of_it_beside_others(self):
        assert judged(lambda h: h**6 / 300 * (1 - h / 0.15), settled).power == 6

    @pytest.mark.parametrize("power", [2, 4, 5])
    @pytest.mark.parametrize("at", [0.14, 0.2, 0.4, 0.7])
    def test_leaves_an_order_open_where_it_rises_to_a_lower_power(self, power, at):
        assert judged(lambda h: h**power / 30 * (1 - h / at), settled).power in (None, power)

    def test_leaves_an_order_open_where_it_falls_below_that(self):
        seen = judged(lambda h: h**7 / 30 + 1e-6 * h**2, settled)
        assert seen.power != 6

    def test_is_not_of_the_power_that_it_passes_as_its_slopes_rise(self):
        # Slopes of nearly 6 from 0.27 to 0.4, on the way to 7.
        power = judged(lambda h: h**7 * math.exp(-3 * h) / 3e4, lambda h: h**8 / 1e3).power
        assert power != 6

    def test_is_what_a_loop_leaves_where_its_slopes_do_not_rise_steadily(self):
        noise = dict(zip(STEPS, range(len(STEPS)), strict=True))
        seen = judged(lambda h: h**4 / 30 + 2e-6 * (1.5 + math.sin(7.0 * noise[h])), lambda h: h**9)
        assert seen.tail is not None or seen.power is None


class TestASlopesLimit:
    def test_is_that_of_two_terms(self):
        seen = PlaceOrder(PLACE, None, False, slopes=(3.0, 4.2, 5.0, 5.4), limit=6.9)
        assert not seen.may_fall_below(7)
        assert seen.may_fall_below(8)

    def test_tells_nothing_where_slopes_are_few(self):
        assert not PlaceOrder(PLACE, None, False, slopes=(3.0, 1.0), limit=1.0).may_fall_below(7)


@pytest.mark.parametrize(
    ("slopes", "rise"),
    [
        ((1.0, 2.0, 2.5), True),
        ((9.0, 1.0, 2.0, 2.5), True),  # the last three alone
        ((1.0, 3.0, 2.5), False),
        ((2.0, 1.0, 2.5), False),
        ((2.5, 2.5, 2.5), False),
        ((0.5, 1.0, 1.9), False),  # and to a lower one
        ((2.0, 2.5), False),
    ],
)
def test_slopes_are_on_their_way_to_a_power_where_each_is_larger_than_the_last(slopes, rise):
    assert on_their_way(slopes, 3) is rise
