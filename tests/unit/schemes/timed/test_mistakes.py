"""Wrong clocks are named, right ones and others are not."""

from fractions import Fraction

import pytest
import sympy

from verify.schemes import get
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.scheme_clocks import ClockReading, find_mistakes, mistake_of_clock
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.words.words import Kinetic

R, ZERO, ONE, HALF = sympy.Rational, sympy.S.Zero, sympy.S.One, sympy.S.Half
PARTS = get("yoshida4").every_h.parts


def clocks(wanted):
    """Times of kicks by (kicks before, drifts before, its own size), of drifts right."""
    sums, found = {"kick": ZERO, "drift": ZERO}, []
    for kind, size in PARTS:
        other = "drift" if kind == "kick" else "kick"
        found.append(wanted(sums["kick"], sums["drift"], size) if kind == "kick" else sums[other])
        sums[kind] += size
    return tuple(found)


def named(times, kinetic=Kinetic.AUTONOMOUS, within=Fraction(0)):
    return find_mistakes(Splitting(PARTS, times, kinetic), within)


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        (lambda own, other, size: ZERO, "as if the force were read at t in every kick"),
        (lambda own, other, size: ONE, "as if the force were read at the step's end in every kick"),
        (lambda own, other, size: HALF, "at the step's middle in every kick"),
        (lambda own, other, size: own, "kick and drift exchanged"),
        (lambda own, other, size: own + size, "after it: kick and drift exchanged"),
        (lambda own, other, size: 1 - other, "as if time ran backwards in the step"),
    ],
)
def test_a_wrong_clock_of_kicks_is_named(wanted, words: str) -> None:
    (found,) = named(clocks(wanted))
    assert words in found
    assert named(clocks(wanted), Kinetic.GENERAL) == [found], "the drifts' are right"


def test_right_clocks_and_others_have_no_name() -> None:
    assert named((None,) * len(PARTS)) == []
    assert named(clocks(lambda own, other, size: other)) == []
    assert named(clocks(lambda own, other, size: other + R(1, 7))) == []
    assert named(clocks(lambda own, other, size: R(1, 10**9))) == [], "not quite frozen"


def test_measured_clocks_are_named_within_what_they_may_differ() -> None:
    almost = clocks(lambda own, other, size: R(1, 10**9))
    assert "at t in every kick" in named(almost, within=Fraction(1, 10**6))[0]
    assert named(almost, within=Fraction(1, 10**12)) == []


def test_kicks_and_drifts_have_each_their_own_name() -> None:
    found = named((ZERO,) * len(PARTS), Kinetic.GENERAL)
    assert found == ["as if the force were read at t in every kick",
                     "as if the velocity were read at t in every drift"]  # fmt: skip
    assert named((ZERO,) * len(PARTS), Kinetic.QUADRATIC) == found[:1]


RK4 = ImplicitTableau.from_numbers(
    [[0] * 4, [HALF, 0, 0, 0], [0, HALF, 0, 0], [0, 0, 1, 0]], [R(1, 6), R(1, 3), R(1, 3), R(1, 6)]
)


def named_stages(clock=None):
    numbers = RK4.with_times(clock).numbers
    ring, weights = numbers.ring, numbers.b
    right = [ring.reduce(sum(row, ring.zero)) for row in numbers.a]
    before = [sum(weights[:k], ring.zero) for k in range(4)]
    stages = ClockReading(ring, "force", "stage", numbers.clock, right, before, [ring.one] * 4)
    return mistake_of_clock(stages, Fraction(0))


@pytest.mark.parametrize(
    ("clock", "words"),
    [
        ([0, 0, 0, 0], "as if the force were read at t in every stage"),
        ([1, 1, 1, 1], "at the step's end in every stage"),
        ([0, 1, 1, 1], "the force in the step's middle is read at its end"),
        ([0, 0, 0, 1], "the force in the step's middle is read at its start"),
        ([0, 0, HALF, HALF], "every stage reads the time of the one before it"),
        ([HALF, HALF, 1, 1], "every stage reads the time of the one after it"),
    ],
)
def test_a_wrong_clock_of_stages_is_named(clock, words: str) -> None:
    assert words in named_stages(clock)


def test_stages_of_right_times_have_no_name() -> None:
    assert named_stages() is None
    assert named_stages([0, HALF, HALF, 1]) is None
    assert named_stages([0, HALF, HALF, R(3, 4)]) is None
