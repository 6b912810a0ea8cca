"""Whether a component whose slopes have not settled leaves an order open."""

import math
from fractions import Fraction
from types import SimpleNamespace

import pytest

from verify.integrators.measures.distances import (
    ErrorTail,
    PlaceOrder,
    _errors_and_noise,
    _select_slowest,
    settle_power,
)
from verify.integrators.measures.error_powers import PowerStretch, PowerStretches, rises_to_power
from verify.integrators.measures.probes import DualProbe
from verify.integrators.places.trial_places import TrialPlace

ONE = Fraction(1)
PLACE = TrialPlace((ONE, ONE), Fraction(0), (ONE, ONE), (ONE, ONE), ONE)
STEPS = [k / 32 for k in (*range(32, 16, -2), *range(16, 3, -1))]


def judged(*errors):
    """Of p' and q', each error a function of h."""
    step = SimpleNamespace(names=("p", "q"))
    rows = [[(h, abs(e(h)), 1e-16) for h in STEPS] for e in errors]
    below = [[e(h) < 0 for h in STEPS] for e in errors]
    return _select_slowest(step, PLACE, rows, below, [0] * len(STEPS), STEPS, "floats", 0.0)


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
    assert rises_to_power(slopes, 3) is rise


SIZES = (1.0, 0.75, 0.5, 0.25, 0.1875, 0.125)
ROWS = [(h, h**6 + 1e-9 * h, 1e-18) for h in SIZES]
ABOVE, BELOW = PowerStretch(6, 1.0, 0.5, 5), PowerStretch(1, 0.25, 0.125, 3)


def left(slopes, rows=ROWS, counts=(0,) * 6):
    """The power and the tail, of floats at a place of two units."""
    power, _, tail = settle_power(slopes, rows, counts, (1.0,) * 6, "floats", 2.0)
    return power, tail


def test_what_a_loop_leaves_is_told_from_the_step_size_at_which_it_begins():
    small = [(h, error * 1e-6 if h < 0.5 else error, noise) for h, error, noise in ROWS]
    both, loose = (
        PowerStretches((ABOVE, BELOW), True),
        PowerStretches((ABOVE,), True, (3.0, 1.0, 2.0)),
    )
    assert left(both, small) == (6, ErrorTail(1, 0.25, small[3][1] / 2))
    assert left(loose, small) == (6, ErrorTail(None, 0.5, small[3][1] / 2))
    assert left(PowerStretches((ABOVE,), True), small) == (6, None)
    fewer = (9, 9, 9, 8, 8, 8)  # turns; and the error grows as one is left out
    rows = [*ROWS[:2], (0.5, 1e-10, 1e-18), *ROWS[3:]]
    smallest = (None, ErrorTail(1, 0.25, ROWS[3][1] / 2))
    assert left(PowerStretches((BELOW,), True), rows, fewer) == smallest


def test_a_rounded_coefficient_moves_a_step_by_an_ulp_of_its_length_or_of_its_unit():
    """At least: q, which hardly moves here, has an eighth of what p does, in its own units."""

    class Exact(DualProbe):
        def __init__(self):
            pass

        def noise(self, place, state):
            return [1e-30, 3e-30]

    place = TrialPlace((ONE, ONE), Fraction(0), (4 * ONE, ONE), (ONE, ONE), ONE)
    ended, exact = [Fraction(5, 2), Fraction(9, 8)], [3 * ONE, ONE]
    step = SimpleNamespace(periods=())
    errors, noise, moved = _errors_and_noise(step, Exact(), place, ONE, [ONE, ONE], ended, exact)
    assert (errors, moved) == ([-0.5, 0.125], 0.5)
    assert noise == pytest.approx([2.0**-52 * (2 + 4 / 16), 2.0**-52 / 16], rel=1e-12, abs=0)
