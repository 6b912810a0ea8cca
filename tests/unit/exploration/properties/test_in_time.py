"""The properties of H(p, q, t): each holds of a scene, and a wrong clock makes it fail there."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
import sympy

from tests.helpers.maps import by_expressions
from tests.helpers.planted.property_errors import (
    Patch,
    Plant,
    example_of,
    must_fail,
    take_every_turn,
    with_added,
)
from tests.unit.exploration.properties.test_properties import OF_TIME_ALONE, PLANTED
from tests.unit.exploration.properties.test_properties_sharp import moved, tiny, with_power
from verify.algebra.formula import symbol
from verify.exploration import properties
from verify.exploration.sample import Sample
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap

DRIVEN = "p**2/2 + q**2/2 + q**4/4 + q**2*cos(2*t)"
MASS = "p**2/2 + q**2/2 + q**4/4 + p**2/(1 + t**2)"
NOT_IN_TIME = ("orbit-averages",)  # of closed orbits


@pytest.fixture(autouse=True)
def _every_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    take_every_turn(monkeypatch)


def driven(scheme: str, hamiltonian: str = DRIVEN) -> Sample:
    return example_of(scheme, hamiltonian, "1/3")


def without_d_by_t(sample: Sample, patch: Patch) -> Sample:
    """lie2 as it is for an H without t: by X in place of D, with what H is at t."""

    def build(hamiltonian: Hamiltonian) -> StepMap:
        p, q, h = map(symbol, "pqh")
        exact = hamiltonian.exact

        def along(x: sympy.Expr) -> sympy.Expr:
            return exact.diff(p) * x.diff(q) - exact.diff(q) * x.diff(p)

        pair = [x + h * along(x) + h**2 / 2 * along(along(x)) for x in (p, q)]
        return by_expressions(hamiltonian, *pair)

    return replace(sample, scheme=replace(sample.scheme, build=build))


def frozen(sample: Sample, patch: Patch) -> Sample:
    """The scheme, every part of it at the step's beginning."""
    wrong = get(f"{sample.scheme.name}, clock frozen").step_map
    return replace(sample, scheme=replace(sample.scheme, build=wrong))


def with_zero_of_time(power: int) -> Plant:
    """h^… t/1000 added to p': a clock with a zero of its own, and without a period."""
    return lambda sample, _: with_added(sample, power, lambda ring: ring.variable("t") / 1000)


def slow_clock(sample: Sample, patch: Patch) -> Sample:
    """The flow's own clock runs by half: by it the slopes are twice as large for half the time."""
    from verify.flows import extrapolation

    class Slow(extrapolation.ElementCode):
        @classmethod
        def from_elements(cls, arithmetic: Any, slopes: Any, names: Any) -> Any:
            return super().from_elements(arithmetic, [(ring, 2 * x) for ring, x in slopes], names)

        def build_gragg_rule(self) -> Any:
            rule = super().build_gragg_rule()
            return lambda p, q, t, time, count: rule(p, q, t / 2, time / 2, count)

    patch.setattr(extrapolation, "ElementCode", Slow)
    return sample


IN_TIME: list[tuple[str, str, Plant]] = [
    ("claims-of-schemes", "lie2", without_d_by_t),
    ("claims-of-schemes", "stormer-verlet", frozen),
    ("convergence-order", "lie2", slow_clock),
    ("exact-flows", "lie2", slow_clock),
    ("extended-system", "rk4", tiny(1, 0, 3)),
    ("extended-system", "stormer-verlet", frozen),
    ("extended-system", "forest-ruth", with_zero_of_time(5)),
    ("order-by-jets", "lie2", with_power(4)),
    ("periodic-hamiltonians", "lie2", with_zero_of_time(3)),
    ("periodic-hamiltonians", "rk4", with_zero_of_time(6)),
    ("separated-parts-add-up", "lie2", moved("clock", "product")),
    ("separated-parts-add-up", "lie2", moved("truncation", "clock")),
    ("shift-of-time", "lie2", with_zero_of_time(3)),
    ("shift-of-time", "stormer-verlet", with_zero_of_time(6)),
    ("symmetric-schemes", "stormer-verlet", frozen),
    ("time-scaling", "lie2", with_zero_of_time(3)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "scheme", "plant"), IN_TIME)
def test_a_property_sees_a_wrong_clock(
    name: str, scheme: str, plant: Plant, monkeypatch: Patch
) -> None:
    assert properties.get(name).holds(driven(scheme)), "it speaks of the example, and holds"
    must_fail(name, plant, driven(scheme), monkeypatch)


@pytest.mark.parametrize("name", sorted(set(PLANTED) - set(NOT_IN_TIME)))
def test_what_is_seen_without_time_is_seen_with_it(name: str, monkeypatch: Patch) -> None:
    scheme, plant = PLANTED[name]
    assert properties.get(name).holds(driven(scheme)), "it speaks of the example, and holds"
    must_fail(name, plant, driven(scheme), monkeypatch)


def test_every_property_of_time_has_a_planted_error() -> None:
    assert {name for name, _, _ in IN_TIME} >= set(OF_TIME_ALONE)


@pytest.mark.left_to_ci
@pytest.mark.sample(118)
@pytest.mark.parametrize("name", properties.names())
@pytest.mark.parametrize("scheme", ["lie3", "rk4", "ruth3", "gauss4", "implicit-symplectic-euler"])
@pytest.mark.parametrize("hamiltonian", [DRIVEN, MASS])
def test_a_property_holds_in_time_or_does_not_speak(
    name: str, scheme: str, hamiltonian: str
) -> None:
    properties.get(name).holds(driven(scheme, hamiltonian))


@pytest.mark.parametrize("name", OF_TIME_ALONE)
def test_a_property_of_time_does_not_speak_without_it(name: str) -> None:
    assert not properties.get(name).holds(example_of("lie2"))


@pytest.mark.parametrize(
    ("hamiltonian", "speaks"),
    [
        ("p**2/2 + q*cos(2*t + 1)", True),
        ("p**2/2 + q*cos(2*t) - q**2*sin(2*t)", True),
        ("p**2/2 + q*cos(2*t) - q**2*sin(3*t)", True),
        ("p**2/2 + q*cos(2*t) - q**2*sin(sqrt(2)*t)", False),
        ("p**2/2 + q*sin(t**2)", False),
        ("p**2/2 + q*t*sin(t)", False),
        ("p**2/2 + q*exp(t)", False),
    ],
)
def test_of_which_h_a_period_is_known(hamiltonian: str, speaks: bool) -> None:
    assert properties.get("periodic-hamiltonians").holds(driven("lie2", hamiltonian)) is speaks


def test_no_order_is_too_high_at_a_time_at_which_more_vanishes() -> None:
    """Scene 314 of seed 1, shrunk: at t = 0 from p = 0 lie3's error is O(h⁵), and O(h⁴) beside."""
    sample = example_of("lie3", "exp(p) + q*t").with_place((Fraction(0), Fraction(0)))
    assert properties.get("convergence-order").holds(sample)
