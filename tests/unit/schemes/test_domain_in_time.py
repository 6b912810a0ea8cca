"""Where H's domain depends on t, a map is smooth where H is so at the times at which it is read."""

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.schemes import get
from verify.schemes.maps.step_map import AT_STAGES

IN_THE_PLANE = "p**2/2 + q**2/(2*(1 - t))"
IN_TWO_DEGREES = "p1**2/2 + p2**2/2 + q1**2*q2/(2*(1 - t)) + q2**2"
OWN_CLOCKS = "kick 1/2 at 1/3; drift 1; kick 1/2 at 1"
STAGED = ("stormer-verlet", "position-verlet", "symplectic-euler", "rk4", "explicit-midpoint",
          "implicit-midpoint", "gauss4", OWN_CLOCKS, "kick 1 at 1/2")  # fmt: skip


def domain(formula: str, scheme: str, **values: str) -> tuple[str, ...]:
    hamiltonian = Hamiltonian.parse(formula).with_values(values)
    if hamiltonian.planar:
        return prove(get(scheme).step_map(hamiltonian)).domain.texts
    return prove(get(scheme).step_map(hamiltonian), get(scheme)).domain.texts


@pytest.mark.parametrize("scheme", STAGED)
@pytest.mark.parametrize("formula", [IN_THE_PLANE, IN_TWO_DEGREES])
def test_a_pole_in_time_alone_is_asked_for_at_the_stages_too(formula: str, scheme: str) -> None:
    texts = domain(formula, scheme)
    assert AT_STAGES in texts
    assert "t - 1 != 0" in texts


@pytest.mark.parametrize("clock", ["frozen", "at the end"])
def test_a_wrong_clock_is_read_at_its_stages_as_well(clock: str) -> None:
    assert AT_STAGES in domain(IN_THE_PLANE, f"stormer-verlet, clock {clock}")
    assert AT_STAGES in domain(IN_THE_PLANE, f"rk4, clock {clock}")


def test_what_is_written_in_time_and_cancels_is_asked_for_at_the_stages() -> None:
    assert domain("p**2/2 + t**2/t*q**2", "stormer-verlet") == ("t != 0", AT_STAGES)


@pytest.mark.parametrize("formula", [IN_THE_PLANE, IN_TWO_DEGREES])
def test_a_map_that_reads_h_at_its_start_alone_has_no_stages(formula: str) -> None:
    assert domain(formula, "lie2") == ("t - 1 != 0",)


def test_formulas_are_held_to_what_they_say_themselves() -> None:
    scheme = "p_next = p - h*q/(1 - t - h); q_next = q + h*p_next"
    assert domain(IN_THE_PLANE, scheme) == ("h + t - 1 != 0", "t - 1 != 0")


@pytest.mark.parametrize("scheme", ["stormer-verlet", "rk4"])
def test_a_condition_on_parameters_alone_holds_at_every_stage(scheme: str) -> None:
    assert AT_STAGES not in domain("p**2/2 + q**4/m + t*q", scheme)
    assert AT_STAGES not in domain("p**2/2 + q**2/(2*(1 + t**2))", scheme)
