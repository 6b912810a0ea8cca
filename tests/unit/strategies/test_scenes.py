"""Scenes that are drawn are valid, and have the parts that they are given."""

from fractions import Fraction

import pytest
from hypothesis import strategies as st

from tests.helpers.sampled.drawing import fuzzed
from tests.unit.strategies.test_schemes import TWISTED
from verify import Hamiltonian, Scene
from verify import strategies as s
from verify.scenes.values import InitialState, InitialValue


def valid(scene: Scene) -> Scene:
    """The same, looked at as one that is read from a file."""
    return Scene.model_validate(scene.model_dump(exclude_defaults=True))


def test_scenes_are_valid() -> None:
    drawn = fuzzed(s.scenes(steps=(3, 5)), 40)
    for scene in drawn:
        assert valid(scene) == scene
        assert scene.exact_hamiltonian().symbols == ()
        assert scene.grid is not None
        assert scene.grid.steps in (3, 4, 5)
        assert len(scene.schemes) == len(scene.grid.step_sizes) == 1
    assert any(scene.parameters for scene in drawn)


def test_scenes_of_given_parts_have_them_and_are_valid() -> None:
    verlet = s.schemes(names=["stormer-verlet"])
    duffing = st.just(Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4"))
    both = s.scenes(hamiltonians=s.hamiltonians(separable=True), schemes=verlet)
    for strategy in (s.scenes(schemes=verlet), s.scenes(hamiltonians=duffing), both):
        drawn = fuzzed(strategy, 15)
        assert len(drawn) == 15
        assert all(valid(scene) == scene for scene in drawn)
    own = s.schemes(names=["p_next = p - h*q; q_next = q + h*p_next"])
    starts = st.just(InitialValue(q=1, p=0))
    drawn = fuzzed(s.scenes(schemes=own, initial_values=starts, step_sizes=st.just("1/8")), 8)
    assert {(x.grid.initial_values, x.grid.step_sizes) for x in drawn} == {
        ((InitialValue(q=1, p=0),), (Fraction(1, 8),))
    }
    with_values = fuzzed(s.scenes(hamiltonians=duffing), 5)
    assert all(set(scene.parameters) == {"delta"} for scene in with_values)
    coupled = st.just(Hamiltonian.parse("p1**2/2 + p2**2/2 + q1*q2"))
    drawn = fuzzed(s.scenes(hamiltonians=coupled, degrees=2), 10)
    assert {scene.hamiltonian for scene in drawn} == {"p1**2/2 + p2**2/2 + q1*q2"}


@pytest.mark.parametrize("degrees", [2, 3])
def test_scenes_have_a_scheme_that_takes_h_and_lists_for_starts(degrees: int) -> None:
    for scene in fuzzed(s.scenes(degrees=degrees), 20):
        (start,) = scene.grid.initial_values
        assert isinstance(start, InitialState)
        assert len(start.q) == len(start.p) == degrees
        (scheme,) = fuzzed(s.schemes(names=scene.schemes), 1)
        assert scheme.step_map(scene.exact_hamiltonian()).degrees == degrees


def test_scenes_in_time_are_valid_and_begin_at_drawn_times() -> None:
    own = s.scenes(hamiltonians=s.hamiltonians(time_dependent=True), initial_times=st.just("1/3"))
    lies = s.scenes(schemes=s.schemes(names=["lie2", "ruth3"]), time_dependent=True)
    for strategy in (s.scenes(time_dependent=True), lies, own):
        drawn = fuzzed(strategy, 12)
        assert len(drawn) >= 11
        assert all(valid(scene) == scene for scene in drawn)
        assert all(scene.exact_hamiltonian().time_dependent for scene in drawn)
        assert len({scene.t0 for scene in drawn}) > 5 or {scene.t0 for scene in drawn} == {
            Fraction(1, 3)
        }


def test_a_scene_without_t_draws_no_time() -> None:
    """So that scene K of seed S is what it was before there were any with t."""
    never = st.nothing()
    assert len(fuzzed(s.scenes(initial_times=never), 40)) == 40
    assert not fuzzed(s.scenes(initial_times=never, time_dependent=True), 40)


def test_what_does_not_fit_is_rejected_not_drawn() -> None:
    verlet = s.schemes(names=["stormer-verlet"])
    assert not fuzzed(s.scenes(hamiltonians=st.just(TWISTED), schemes=verlet), 20)
