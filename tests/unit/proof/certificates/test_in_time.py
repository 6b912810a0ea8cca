"""Certificates of H(p, q, t): D for X, t as time and nothing else, and the times of stages."""

from dataclasses import asdict
from typing import Any

import pytest

from tests.helpers.sampled.certificates import of_every_in_time, of_text
from tests.oracle.printed_certificates import is_true
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import state_theorem

DRIVEN = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"
FROZEN = DRIVEN.replace("t)/2", "d)/2")


def refused(data: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        check(data)


def renamed(data: Any, names: dict[str, str]) -> Any:
    if isinstance(data, dict):
        return {names.get(key, key): renamed(x, names) for key, x in data.items()}
    if isinstance(data, list):
        return [renamed(x, names) for x in data]
    return names.get(data, data) if isinstance(data, str) else data


def test_a_frozen_clock_is_no_flow_in_time() -> None:
    """The map of X in the place of D, as of an H with a parameter, said to be one in time."""
    data = renamed(of_text(FROZEN, "lie2"), {"d": "t"}) | {"parameters": [], "time_dependent": True}
    refused(data, "p 2 is not zero")
    refused(data | {"convergence_order": 1}, "potential is not zero")
    del data["potential"]
    said = state_theorem(check(data | {"convergence_order": 1}))  # which is true of that map
    assert (said.order, said.convergence_order, said.potential) == (3, 1, None)
    assert is_true(asdict(said))
    assert not is_true(asdict(said) | {"convergence_order": 2})


def test_time_is_no_parameter() -> None:
    """The formulas would be read as those of an H in time, of which the certificate is false."""
    data = renamed(of_text(FROZEN, "lie2"), {"d": "t"})
    refused(data, "'t' is no new name")
    refused(of_text(DRIVEN, "lie2") | {"parameters": ["t"]}, "'t' is no new name")


@pytest.mark.parametrize(
    "made", [lambda: of_text(DRIVEN, "lie2"), lambda: of_every_in_time("lie2")]
)
def test_without_its_mark_time_stands_for_nothing(made: Any) -> None:
    data = made()
    check(data)
    refused(data | {"time_dependent": False}, "stands for nothing")
    refused(data | {"time_dependent": 1}, "time_dependent: 1 is not true or false")
    del data["time_dependent"]
    refused(data, "stands for nothing")


def test_an_autonomous_certificate_has_no_mark_and_holds_with_one() -> None:
    data = of_text("p**2/2 - cos(q)", "lie2")
    assert "time_dependent" not in data
    data["witness"]["t"] = "1/3"
    assert state_theorem(check(data | {"time_dependent": True})).order == 3
    refused(data, "gives values to p, q")


def test_what_depends_on_t_alone_is_no_constant_of_the_motion() -> None:
    data = of_text(DRIVEN, "lie2")
    check(data | {"potential": [*data["potential"], ["5"]]})
    refused(data | {"potential": [*data["potential"], ["5", "t"]]}, "potential is not zero")
    check(data | {"hamiltonian": [*data["hamiltonian"], ["5", "t"]]})  # of the force it is none


def test_what_h_has_of_t_alone_is_left_out() -> None:
    assert of_text(f"{DRIVEN} + t**2 - 5*t", "lie2") == of_text(DRIVEN, "lie2")


def test_a_derivative_by_t_comes_last_in_a_name() -> None:
    data = of_every_in_time("lie2")
    gap = [["1", "H_pt"], ["-1", "H_tp"]]
    refused(data | {"leading": data["leading"] + gap}, "'H_tp' stands for nothing")


def test_a_witness_has_a_time() -> None:
    data = of_text(DRIVEN, "lie2")
    refused(data | {"witness": {"p": "1", "q": "1"}}, "gives values to p, q .*: p, q, t")


def test_a_stage_in_time_has_a_time_and_no_other_has() -> None:
    data = of_every_in_time("stormer-verlet")
    assert [row[4] for row in data["stages"]] == ["0", "1/2", "1"]
    check(data)
    refused(data | {"stages": [row[:4] for row in data["stages"]]}, "a row has 5 numbers")
    refused(data | {"time_dependent": False}, "a row has 4 numbers")


@pytest.mark.left_to_ci
def test_what_is_printed_names_time_and_says_the_truth() -> None:
    said = state_theorem(check(of_every_in_time("stormer-verlet")))
    assert said.hamiltonian == "every smooth H = T(p, t) + V(q, t)"
    assert said.p_next.startswith("p1 = p - h*(1/2)*H_q(p, q, t); ")
    assert said.q_next == "q1 = q; q2 = q1 + h*(1)*H_p(p1, q1, t + (1/2)*h); q3 = q2"
    assert is_true(asdict(said))
    assert not is_true(asdict(said) | {"p_next": said.p_next.replace("h*(1/2)", "h*(1/2)*p", 1)})
    said = state_theorem(check(of_every_in_time("implicit-midpoint")))
    assert said.p_next == (
        "p1 = p - h*(1)*H_q(p + (1/2)*(p1 - p), q + (1/2)*(q1 - q), t + (1/2)*h)"
    )
    assert is_true(asdict(said))
    said = state_theorem(check(of_every_in_time("lie2")))
    assert said.statement == (
        "det J − 1 = L h^3 + O(h^4), L not zero for some H, for every smooth H(p, q, t) and this "
        "map, which agrees with the flow up to h^2, and L = D·G, D = ∂/∂t + X"
    )
    assert is_true(asdict(said))
    assert not is_true(asdict(said) | {"p_next": said.p_next.replace(" - H_qt/2", "")})
    assert not is_true(asdict(said) | {"potential": f"{said.potential} + t"})


def test_a_splitting_with_times_of_its_own() -> None:
    name = "kick 1/3 at 0; drift 1/2; kick 2/3 at 1/2; drift 1/2; order 1"
    said = state_theorem(check(of_every_in_time(name)))
    assert "H_q(p2, q2, t + (1/2)*h)" in said.p_next
    assert is_true(asdict(said))
