"""`verify.testing`: asserts that pass for what holds, and say what does not, and where."""

from typing import Any

import pytest

import verify
from tests.helpers.programs import kept_steps
from tests.helpers.programs import user_steps as own_steps
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.testing import (
    assert_area_order,
    assert_area_preserving,
    assert_convergence_order,
    assert_keeps,
    assert_symplectic,
)


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


HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"


def force(q: Any) -> Any:
    return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]


def euler_b(p: Any, q: Any, h: Any) -> Any:
    p = [x + h * f for x, f in zip(p, force(q), strict=True)]
    return p, [x + h * v for x, v in zip(q, p, strict=True)]


def euler(p: Any, q: Any, h: Any) -> Any:
    moved = [x + h * v for x, v in zip(q, p, strict=True)]
    return [x + h * f for x, f in zip(p, force(q), strict=True)], moved


def stretched(p: Any, q: Any, h: Any) -> Any:
    """It preserves volume, and no more: h² of p1 is gained, and of p2 lost."""
    p, q = euler_b(p, q, h)
    return [p[0] * (1 + h * h), p[1] / (1 + h * h)], q


def test_a_step_in_several_degrees_is_symplectic_or_not() -> None:
    found = assert_symplectic(euler_b, HENON)
    assert (found.verdict, found.symplectic) == ("PROVED", True)
    for step in (euler, stretched):
        with pytest.raises(AssertionError, match="REFUTED: that it is symplectic is claimed"):
            assert_symplectic(step, HENON)
    assert assert_area_preserving(stretched, HENON).area_preserving is True
    assert assert_symplectic(own_steps.verlet, "pendulum").verdict == "PROVED"
    with pytest.raises(AssertionError, match="REFUTED: det J ≡ 1"):
        assert_symplectic(own_steps.lie2, "pendulum")


def test_a_scheme_in_several_degrees_is_held_to_what_it_claims() -> None:
    for scheme, holds in (("stormer-verlet", True), ("lie2", False)):
        found = verify.check(HENON, scheme, symplectic=True)
        assert found.verdict == ("PROVED" if holds else "REFUTED")
        assert found.area_preserving is holds
    with pytest.raises(InputError, match="symplectic=True is claimed"):
        verify.check(HENON, "lie2", area_preserving=True)
    with pytest.raises(InputError, match="symplectic=1: must be True or False"):
        verify.check(HENON, "lie2", symplectic=1)  # type: ignore[arg-type]


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


def test_a_step_or_a_map_keeps_what_is_claimed_of_it() -> None:
    found = assert_keeps(own_steps.verlet, "area", "reversible", "energy: 3", system="pendulum")
    assert [str(x.verdict) for x in found.keeps] == ["PROVED", "MEASURED", "PROVED"]
    lotka = {"system": kept_steps.LOTKA, "form": kept_steps.LOTKA_FORM}
    assert_keeps(kept_steps.lotka, **lotka)
    with pytest.raises(AssertionError, match=r"(?s)REFUTED: du\^dv/\(u\*v\): .*at u = "):
        assert_keeps(kept_steps.lotka_wrong, **lotka)
    assert_keeps(kept_steps.two, "volume", coordinates="v1,v2,x1,x2")
    with pytest.raises(AssertionError, match="UNDECIDED, which is neither"):
        assert_keeps(kept_steps.midpoint, "area", system="pendulum")


def test_bad_arguments_of_what_is_kept_are_told() -> None:
    with pytest.raises(InputError, match="name one at least"):
        assert_keeps(own_steps.verlet, system="pendulum")
    with pytest.raises(InputError, match="unknown"):
        assert_keeps(own_steps.verlet, "area", system="pendulum", order=2)
    with pytest.raises(InputError, match="is no function"):
        assert_keeps("lie2", "area", system="pendulum")  # type: ignore[arg-type]
