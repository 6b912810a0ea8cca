"""A closed orbit that is taken over from a search over another time is the one that this finds."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.flows import exact_orbit as module
from verify.flows.exact_orbit import ExactOrbit, exact_orbit
from verify.flows.orbit_search import OrbitSearch
from verify.hamiltonians.hamiltonian import Hamiltonian

FORMULAS = [
    "p**2/2 + 9*q**2/2", "p**2/2 - cos(q)", "p**2/2 + q**2/2 + q**4/4", "p**2/2 + q**2/2 - q**3/3",
    "(p**2 + q**2)**2/4",
]  # fmt: skip
times = st.builds(lambda n, k: Fraction(n, 10**k), st.integers(1, 400), st.integers(0, 2))


def forget() -> None:
    exact_orbit.cache_clear()
    module._orbit_cache.cache_clear()


def alone(hamiltonian: Hamiltonian, p: Fraction, q: Fraction, time: Fraction) -> ExactOrbit:
    forget()
    return exact_orbit(hamiltonian, p, q, time)


@drawn(25)
@given(
    st.sampled_from(FORMULAS),
    st.fractions(-3, 3, max_denominator=7),
    st.fractions(-2, 2, max_denominator=5),
    st.lists(times, min_size=2, max_size=5),
)
def test_over_several_times_each_orbit_is_what_it_is_alone(
    formula: str, p: Fraction, q: Fraction, given_: list[Fraction]
) -> None:
    hamiltonian = Hamiltonian.parse(formula)
    expected = [alone(hamiltonian, p, q, time) for time in given_]
    forget()
    assert [exact_orbit(hamiltonian, p, q, time) for time in given_] == expected


@pytest.mark.parametrize("down", [False, True])
@pytest.mark.parametrize(
    ("formula", "p", "q"),
    [
        ("p**2/2 + q**4/4", 1, 0),  # of which the search knows no step at q = 0: the time's part
        ("p**2/2 + q**4/4", 1, Fraction(1, 9)),
        ("p**2/2 + 9*q**2/2", 0, 1),
        ("p**2/2 - cos(q)", 0, 1),
    ],
)
def test_nor_does_a_time_matter_that_is_hardly_a_period_or_cuts_a_step(
    formula: str, p: int, q: Fraction, down: bool
) -> None:
    hamiltonian, start = Hamiltonian.parse(formula), (Fraction(p), Fraction(q))
    period = alone(hamiltonian, *start, Fraction(50)).period
    assert period is not None
    near = [period * Fraction(k, 40) for k in range(36, 60)]
    given_ = sorted([*near, *map(Fraction, (9, 17, 23, 50, 71, 90))], reverse=down)
    expected = [alone(hamiltonian, *start, time) for time in given_]
    forget()
    assert [exact_orbit(hamiltonian, *start, time) for time in given_] == expected


def test_a_closed_one_is_searched_once_and_others_each_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen: list[Fraction] = []
    search = OrbitSearch.integrate

    def noting(self: OrbitSearch) -> ExactOrbit:
        seen.append(self.arithmetic.exact(self.time))
        return search(self)

    monkeypatch.setattr(OrbitSearch, "integrate", noting)
    pendulum, zero = Hamiltonian.parse("p**2/2 - cos(q)"), Fraction(0)
    forget()
    for time in (3, 100, 50, 200, 4, 7):  # a period is 6.7: some are too short for it
        found = exact_orbit(pendulum, zero, Fraction(1), Fraction(time))
        assert (found.kind == "closed") is (time >= 7)
    assert seen == [3, 100, 4, 7][: len(seen)]
    assert len(seen) in (3, 4)  # 7 is hardly a period, of steps that may be cut
    forget()
    seen.clear()
    for time in (10, 20, 30):  # on the separatrix
        assert exact_orbit(pendulum, Fraction(2), zero, Fraction(time)).kind == "open"
    assert seen == [10, 20, 30]
