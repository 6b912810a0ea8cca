"""Schemes that are drawn are those that were asked for, and that take the Hamiltonian."""

from hypothesis import strategies as st

from tests.helpers.sampled.drawing import fuzzed
from verify import Hamiltonian, InputError, Scheme
from verify import schemes as catalogue
from verify import strategies as s

TWISTED = Hamiltonian.parse("p**2/2 + q**2/2 + p*q**2")


def names(strategy: st.SearchStrategy[Scheme]) -> set[str]:
    return {scheme.name for scheme in fuzzed(strategy, 400)}


def test_every_scheme_is_drawn_and_lie_more_often() -> None:
    drawn = [scheme.name for scheme in fuzzed(s.schemes(), 900)]
    assert set(drawn) == set(catalogue.names())
    assert drawn.count("lie2") > 1.5 * drawn.count("rk4")


def test_schemes_are_those_that_take_the_hamiltonian() -> None:
    taken = set()
    for name in catalogue.names():
        try:
            catalogue.get(name).step_map(TWISTED)
        except InputError:
            continue
        taken.add(name)
    assert names(s.schemes(hamiltonian=TWISTED)) == taken
    assert taken < set(catalogue.names())


def test_what_only_looks_mixed_is_seen_to_be_separable() -> None:
    square = Hamiltonian.parse("(p + q)**2/2 - p*q")
    assert "stormer-verlet" in names(s.schemes(hamiltonian=square))


def test_schemes_by_what_they_claim() -> None:
    found = [catalogue.get(name) for name in catalogue.names()]
    drawn = names(s.schemes(order=4, explicit=True, symmetric=True, area_preserving=True))
    of_order_4 = [x for x in found if x.order == 4 and x.explicit and x.symmetric]
    assert drawn == {x.name for x in of_order_4 if x.area_preserving}
    assert drawn
    assert names(s.schemes(names=["lie7", "kick 1; drift 1"])) == {"lie7", "kick 1; drift 1"}
    own = "p_next = p - h*a*q; q_next = q + h*p_next"
    assert names(s.schemes(names=["lie2", own], hamiltonian=TWISTED)) == {"lie2"}
