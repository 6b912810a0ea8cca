"""The names that schemes go by."""

import pytest

from verify import schemes
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.scene import Scene


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ("RK4", "rk4"),
        ("verlet", "stormer-verlet"),
        ("Leap Frog", "stormer-verlet"),
        ("Stormer_Verlet", "stormer-verlet"),
        ("LIE7", "lie7"),
        ("forward euler", "euler"),
        ("gauss2", "implicit-midpoint"),
        ("kick 1; drift 1", "kick 1; drift 1"),
        ("p_next = P; q_next = q", "p_next = P; q_next = q"),
        ("nothing", "nothing"),
        ("lie101", "lie101"),
    ],
)
def test_a_scheme_is_known_in_any_case_and_by_its_other_names(given: str, name: str) -> None:
    assert schemes.canonical(given) == name


def test_no_alias_is_a_scheme_s_own_name_or_stands_for_two() -> None:
    assert not set(schemes.aliases()) & set(schemes.names())
    assert all(schemes.get(alias).name == name for alias, name in schemes.aliases().items())


@pytest.mark.parametrize(
    ("given", "meant"), [("gaus4", "gauss4"), ("velocity-verlett", "stormer-verlet"), ("lie 2", "")]
)
def test_the_nearest_name_is_asked_for(given: str, meant: str) -> None:
    if not meant:
        assert schemes.canonical("lie_2") == "lie_2"
    with pytest.raises(InputError, match=f"is {meant or 'lie2'} meant"):
        schemes.get(given)


def test_systems_are_known_in_any_case() -> None:
    assert systems.get("Double Well").name == "double-well"
    with pytest.raises(
        InputError,
        match=r"dufing: unknown; is duffing meant\? allowed: chirped-oscillator, coupled",
    ):
        systems.get("dufing")


def test_what_is_found_goes_by_the_scheme_s_own_name() -> None:
    at = {"q": 1, "p": 0, "step_size": "0.1", "steps": 2}
    assert run(Hamiltonian.parse("p**2/2 + q**2/2"), "Leapfrog", **at).scheme == "stormer-verlet"
    scene = Scene(system="Pendulum", schemes=("RK4", "verlet"))
    assert (scene.system, scene.schemes) == ("pendulum", ("rk4", "stormer-verlet"))


MINE = "p_half = p - h/2*q; q_next = q + h*p_half; p_next = p_half - h/2*q_next"


@pytest.mark.parametrize("text", [MINE, "kick 1/2; drift 1; kick 1/2; order 2"])
def test_a_scheme_of_ones_own_may_have_a_title(text: str) -> None:
    titled, plain = schemes.get(f"mine-2: {text}"), schemes.get(text)
    assert titled.name == f"mine-2: {plain.name}"
    assert schemes.get(titled.name) == titled
    assert schemes.family(titled.name) == schemes.family(text) == "user"
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2")
    assert titled.step_map(hamiltonian).composed == plain.step_map(hamiltonian).composed


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        (f"RK4: {MINE}", "RK4: is the scheme rk4; give yours another title"),
        (f"lie9: {MINE}", "is the scheme lie9"),
        ("mine: leapfrog", "has the name stormer-verlet; write that"),
        ("mine: ", "has no scheme behind its one title"),
        (f"mine: yours: {MINE}", "has no scheme behind its one title"),
        ("mine: nothing", "scheme=nothing: unknown"),
        (f"my own: {MINE}", "write it as"),
    ],
)
def test_a_title_stands_before_ones_own_scheme_alone(given: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        schemes.get(given)
