"""What a measured step's clock looks like: numbers that are just near, and noise that hides."""

from fractions import Fraction

import pytest

from tests.helpers.programs.blind import blind
from tests.unit.integrators.test_in_time import DRIVEN, verlet_at
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.clocks import _note_mean, _order_at
from verify.integrators.measures.probes import probe_of
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.user_code.loading import callee_from

EXACT = Hamiltonian.parse(DRIVEN)
ONE, THIRD = Fraction(1), Fraction(1, 3)
PLACES = [
    TrialPlace((Fraction(p, 5), Fraction(q, 7)), THIRD, (ONE, ONE), (THIRD, THIRD), Fraction(1, 4))
    for p, q in ((3, 5), (-2, 4))
]


def probe(moment, how):
    """Of Störmer–Verlet that reads its force at that part of h."""
    step = verlet_at(moment, moment)
    callee = callee_from(step if how == "duals" else blind(step), ("p", "q"))
    callee.step.time_dependent = True
    return probe_of(callee.step, how)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("how", "near"), [("duals", 1e-6), ("floats", 5e-3)])
def test_a_mean_as_near_to_the_middle_as_is_seen_is_no_mistake(how, near, sign):
    """And one twice as far is: it is told with three places."""
    assert _note_mean(probe(0.5 + sign * 0.8 * near, how), EXACT, PLACES) == []
    off = sign * 1.6 * near
    assert _note_mean(probe(0.5 + off, how), EXACT, PLACES) == [
        f"H is read at about t {0.5 + off:+.3f} h in the mean: it can be of order 2 where that is "
        "t + h/2"
    ]


@pytest.mark.parametrize("moment", [0, 0.25])
@pytest.mark.parametrize("how", ["duals", "floats"])
def test_a_mean_that_is_a_simple_part_of_the_step_is_told_as_one(how, moment):
    (said,) = _note_mean(probe(moment, how), EXACT, PLACES)
    assert said.startswith(f"H is read at {'t + h/4' if moment else 't'} in the mean: ")


@pytest.mark.parametrize("noisy", [(0.0, 1.0), (1.0, 0.0), (0.0, 0.0)])
def test_an_order_with_the_force_held_still_is_seen_beyond_the_noise_of_both_coordinates(noisy):
    seen = probe(0, "duals")
    own = seen.noise
    seen.noise = lambda place, ended: [x + y for x, y in zip(own(place, ended), noisy, strict=True)]
    for part, order in ((0, 2), (Fraction(1, 2), 1)):
        found = _order_at(seen, EXACT, PLACES[0], Fraction(part))
        assert found == (None if any(noisy) else order)
