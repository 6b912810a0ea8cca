"""Hamiltonians, initial values and scenes in n degrees of freedom: what is drawn is asked for."""

import re

import pytest
from hypothesis import strategies as st

from tests.helpers.sampled.drawing import fuzzed, shrunk
from verify import Hamiltonian, InputError
from verify import strategies as s
from verify.algebra.formula import symbol
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.flow_recognition import uncouple
from verify.scenes.values import InitialState
from verify.strategies.couplings import couplings, number_variables
from verify.strategies.terms import KINDS

every_n = pytest.mark.parametrize("degrees", [2, 3])


@every_n
def test_what_is_drawn_is_of_so_many_degrees_and_reads_back(degrees: int) -> None:
    for h in fuzzed(s.hamiltonians(degrees=degrees, terms=2), 20):
        assert h.degrees == degrees
        assert Hamiltonian.parse(h.formula, dict(h.values)) == h


@every_n
@pytest.mark.parametrize("separable", [True, False])
def test_separable_is_what_was_asked_for(degrees: int, separable: bool) -> None:
    for h in fuzzed(s.hamiltonians(degrees=degrees, terms=2, separable=separable), 10):
        assert canonical_field(h)[0].separable is separable, h


def test_coupled_and_not_is_what_was_asked_for() -> None:
    for h in fuzzed(s.hamiltonians(degrees=2, terms=2, coupled=True), 10):
        assert len(uncouple(h)) == 1, h
    for h in fuzzed(s.hamiltonians(degrees=3, terms=2, coupled=False), 10):
        assert len(uncouple(h)) == 3, h
    either = [len(uncouple(h)) for h in fuzzed(s.hamiltonians(degrees=2, terms=2), 40)]
    assert 8 < either.count(1) < 36


def test_bounded_grows_in_every_direction() -> None:
    """Along the axes and the diagonals, of which couplings are made."""
    rays = [(1, 0, 0, 0), (0, 0, 0, -1), (0, 0, 1, 1), (0, 0, 1, -1), (1, -1, 0, 0), (1, 1, 1, 1)]
    names = [symbol(x) for x in ("p1", "p2", "q1", "q2")]
    for h in fuzzed(s.hamiltonians(degrees=2, terms=3, bounded=True), 10):
        for ray in rays:
            near, far = (
                h.exact.subs(dict(zip(names, (r * x for x in ray), strict=True))).evalf(30)
                for r in (10**3, 10**4)
            )
            assert 0 < 10 * near < far, (h, ray)


@every_n
def test_time_and_parameters_are_drawn_too(degrees: int) -> None:
    drawn = s.hamiltonians(degrees=degrees, terms=2, time_dependent=True, with_parameters=True)
    for h in fuzzed(drawn, 8):
        assert h.time_dependent
        assert h.parameters
        assert not h.symbols


@pytest.mark.left_to_ci
def test_the_simplest_are_oscillators() -> None:
    two = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2"
    assert shrunk(s.hamiltonians(degrees=2)).formula == two
    coupled = shrunk(s.hamiltonians(degrees=2, coupled=True)).formula
    assert coupled == "p1**2/2 + p2**2/2 + q1**2/2 + q1*q2 + q2**2/2"
    scene = shrunk(s.scenes(degrees=2))
    assert scene.exact_hamiltonian().formula == two
    assert scene.schemes == ("lie1",)


@every_n
def test_scenes_have_a_scheme_that_takes_h_and_lists_for_starts(degrees: int) -> None:
    for scene in fuzzed(s.scenes(degrees=degrees), 20):
        (start,) = scene.grid.initial_values
        assert isinstance(start, InitialState)
        assert len(start.q) == len(start.p) == degrees
        (scheme,) = fuzzed(s.schemes(names=scene.schemes), 1)
        assert scheme.step_map(scene.exact_hamiltonian()).degrees == degrees


def test_scenes_take_parts_of_ones_own() -> None:
    mine = st.just(Hamiltonian.parse("p1**2/2 + p2**2/2 + q1*q2"))
    found = fuzzed(s.scenes(hamiltonians=mine, degrees=2), 10)
    assert {scene.hamiltonian for scene in found} == {"p1**2/2 + p2**2/2 + q1*q2"}


@pytest.mark.parametrize(
    ("asked", "problem"),
    [
        ({"degrees": 0}, "degrees=0: must be a whole number, 1 … 8"),
        ({"degrees": 9}, "degrees=9"),
        ({"coupled": True}, "coupled=True: wants two degrees of freedom or more"),
        ({"degrees": 2, "coupled": "yes"}, "coupled=yes"),
        ({"degrees": 2, "coupled": True, "degree": 1, "kinds": ["polynomial"]}, "degree=1: must"),
        ({"degrees": 2, "kinds": ["round"]}, "kinds=round"),
    ],
)
def test_a_bad_argument_is_refused_when_it_is_given(asked: dict[str, object], problem: str) -> None:
    with pytest.raises(InputError, match=re.escape(problem)):
        s.hamiltonians(**asked)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="degrees=0"):
        s.scenes(degrees=0)


def test_a_coupling_has_two_degrees_and_the_asked_properties() -> None:
    every = [x for kind in KINDS for x in couplings(kind, 6, separable=False, bounded=None)]
    assert len(set(every)) == 15
    assert all(x.separable for x in couplings("rational", 6, separable=True, bounded=None))
    assert all(x.confined for x in couplings("exponential", 6, separable=False, bounded=True))
    assert not list(couplings("polynomial", 1, separable=True, bounded=None))


def test_degrees_are_numbered_in_names_alone() -> None:
    assert number_variables("exp(-p**2) + sin(2*q)*P", 3, 12) == "exp(-p3**2) + sin(2*q3)*p12"
