"""`verify.testing`: asserts that pass for what holds, and say what does not, and where."""

from typing import Any

import pytest

from tests.helpers.programs import user_steps as own_steps
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.testing import assert_area_order, assert_area_preserving, assert_convergence_order


def test_what_holds_passes_and_returns_what_was_found() -> None:
    assert assert_area_preserving(own_steps.verlet, "pendulum").verdict == "PROVED"
    found = assert_area_order(own_steps.lie2, "p**2/2 - cos(q)", 3)
    assert found.order == 3
    exact = Hamiltonian.parse("p**2/2 - cos(q)")
    assert assert_convergence_order(own_steps.rk4, exact, 4).convergence_order == 4


def test_what_does_not_hold_fails_with_the_counterexample() -> None:
    with pytest.raises(AssertionError, match=r"(?s)REFUTED: det J ≡ 1 .* h = .*: det J − 1 is"):
        assert_area_preserving(own_steps.lie2, "pendulum")
    with pytest.raises(AssertionError, match=r"(?s)ΔJ = O\(h\^4\) is claimed.*expected about"):
        assert_area_order(own_steps.lie2, "pendulum", 4)
    with pytest.raises(AssertionError, match=r"order 3 is claimed; the map agrees .* h\^2 only"):
        assert_convergence_order(own_steps.verlet, "pendulum", 3)


def test_area_alone_is_not_enough() -> None:
    with pytest.raises(AssertionError, match="frozen"):
        assert_area_preserving(own_steps.frozen, "pendulum")
    with pytest.raises(AssertionError, match="not a scheme"):
        assert_area_preserving(own_steps.flipped, "pendulum")


def test_what_is_not_decided_is_said_to_be_so() -> None:
    def noisy(p: Any, q: Any, h: Any) -> Any:
        p, q = own_steps.euler_a(p, q, h)
        return round(float(p), 6), round(float(q), 6)

    with pytest.raises(AssertionError, match="UNDECIDED, which is neither yes nor no"):
        assert_area_preserving(noisy, "pendulum")


def test_parameters_and_order_of_arguments() -> None:
    def step(a: Any, b: Any, c: Any) -> Any:
        p = b - c * (a + a**3)
        return a + c * p, p

    options: dict[str, Any] = {"parameters": {"delta": 1}, "arguments": "q,p,h"}
    assert_area_preserving(step, "duffing", **options)
    with pytest.raises(AssertionError):
        assert_area_preserving(step, "duffing", parameters={"delta": 2}, arguments="q,p,h")


@pytest.mark.parametrize(
    "options",
    [
        {"parameter": {}},
        {"p": 1},
        {"arguments": "q,p"},
        {"p": "x", "q": 0},
        {"p": "1e400", "q": 0},
        {"time_limit": float("nan")},
        {"time_limit": float("inf")},
        {"time_limit": 0},
    ],
)
def test_bad_options_are_named(options: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        assert_area_preserving(own_steps.euler_a, "pendulum", **options)


@pytest.mark.parametrize("order", [0, 13, True, 2.0])
def test_bad_orders_are_named(order: Any) -> None:
    with pytest.raises(InputError, match="whole number"):
        assert_convergence_order(own_steps.euler_a, "pendulum", order)


@pytest.mark.parametrize("function", [own_steps.of_two, own_steps.with_another])
def test_a_wrong_signature_is_named(function: Any) -> None:
    with pytest.raises(InputError, match=r"wanted: step\(p, q, h\)"):
        assert_area_preserving(function, "pendulum")
