"""Every property of n degrees of freedom: it holds, and a planted error makes it fail."""

from dataclasses import replace
from importlib import import_module

import pytest

from tests.helpers.planted.steps import with_term
from tests.unit.exploration.properties.test_properties import (
    OF_DEGREES_ALONE,
    InPlace,
    Patch,
    must_fail,
    sums_for_products,
    take_every_turn,
)
from verify.exploration import properties
from verify.exploration.sample import Sample
from verify.flows.extrapolation import NumericalFlow
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.scene import scene_from
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap

HENON_HEILES = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"
DRIVEN = f"{HENON_HEILES} + q1*cos(3*t)/5"
THREE = "p1**2/2 + p2**2 + p3**2/2 + q1**4/4 - cos(q2) + q3**2 + q1*q3"
MIXED = "p1**2/2 + p2**2/2 + q1**2/2 + q2**4/4 + p1*q2/3"


def example_of(scheme: str, hamiltonian: str = HENON_HEILES) -> Sample:
    degrees = Hamiltonian.parse(hamiltonian).degrees
    start = {"q": ["0.3", "-0.2", "0.5"][:degrees], "p": ["0.1", "1/3", "-0.4"][:degrees]}
    grid = {"steps": 3, "step_sizes": ["0.05"], "initial_values": [start]}
    data = {"hamiltonian": hamiltonian, "schemes": [scheme], "grid": grid}
    if Hamiltonian.parse(hamiltonian).time_dependent:
        data["t0"] = "0.7"
    return Sample.from_scene(scene_from(data, "scene"))


@pytest.fixture(autouse=True)
def _every_turn(monkeypatch: Patch) -> None:
    take_every_turn(monkeypatch)


def wrong_map(true: StepMap, power: int = 3) -> StepMap:
    """h^power f2/100 added to q1'."""
    return with_term(true, true.degrees, power, lambda _: true.field.slopes[1] / 100)


def another_map(sample: Sample, patch: Patch) -> None:
    patch.setitem(sample.__dict__, "step_map", wrong_map(sample.step_map))


def another_scheme(sample: Sample, patch: Patch) -> Sample:
    """The maps that the property makes of the scheme are others, but in the plane."""
    true = sample.scheme.step_map

    def build(hamiltonian: Hamiltonian) -> StepMap:
        right = true(hamiltonian)
        return right if hamiltonian.planar else wrong_map(right)

    return replace(sample, scheme=replace(sample.scheme, build=build))


def one_more_order(sample: Sample, patch: Patch) -> None:
    order = sample.proof.convergence_order or 0
    patch.setitem(sample.__dict__, "proof", replace(sample.proof, convergence_order=order + 1))


def one_order_less(sample: Sample, patch: Patch) -> None:
    first = replace(sample.proof.first, power=(sample.proof.order or 0) - 1)
    patch.setitem(sample.__dict__, "proof", replace(sample.proof, first=first))


def boasting(sample: Sample, _: Patch) -> Sample:
    return replace(sample, scheme=replace(sample.scheme, order=sample.scheme.order + 1))


def believes_all(_: Sample, patch: Patch) -> None:
    module = import_module("verify.exploration.properties.orders.certificates")
    patch.setattr(module, "check", lambda data: None)


def blind(sample: Sample, patch: Patch) -> None:
    module = import_module("verify.exploration.properties.orders.planted_errors")
    patch.setattr(module, "prove", lambda *_, **__: sample.proof)


def half_a_flow(_: Sample, patch: Patch) -> None:
    """Forwards, by half the time."""
    true = NumericalFlow.follow
    patch.setattr(
        NumericalFlow,
        "follow",
        lambda self, z, time, most: true(self, z, time / 2 if time > 0 else time, most),
    )


def a_lost_step(_: Sample, patch: Patch) -> None:
    module = import_module("verify.exploration.properties.numbers.results_read_back")
    true = module.scene_text
    patch.setattr(module, "scene_text", lambda scene: true(scene).replace("steps = 3", "steps = 2"))


def a_second_drive(sample: Sample, patch: Patch) -> None:
    """Of another H, which is not periodic."""
    other = Hamiltonian.parse(f"{DRIVEN} + q2*t/100")
    patch.setitem(sample.__dict__, "step_map", sample.scheme.step_map(other))


PLANTED_IN_DEGREES: dict[str, tuple[str, str, InPlace]] = {
    "area-errors-compose": ("lie2", HENON_HEILES, sums_for_products),
    "certificates": ("lie2", HENON_HEILES, believes_all),
    "claims-of-schemes": ("lie2", HENON_HEILES, boasting),
    "convergence-order": ("lie2", HENON_HEILES, one_more_order),
    "every-hamiltonian": ("lie2", HENON_HEILES, one_order_less),
    "exact-flows": ("lie2", HENON_HEILES, half_a_flow),
    "exchange-of-degrees": ("stormer-verlet", HENON_HEILES, another_map),
    "exchange-of-p-and-q": ("rk4", MIXED, another_map),
    "extended-system": ("stormer-verlet", DRIVEN, another_map),
    "linear-canonical-maps": ("lie2", THREE, another_map),
    "number-systems-agree": ("lie2", HENON_HEILES, another_map),
    "periodic-hamiltonians": ("lie2", DRIVEN, a_second_drive),
    "planted-errors": ("lie2", HENON_HEILES, blind),
    "quadratic-hamiltonians": ("lie2", MIXED, another_scheme),
    "results-read-back": ("lie2", HENON_HEILES, a_lost_step),
    "shift-of-time": ("rk4", DRIVEN, another_map),
    "symmetric-schemes": ("stormer-verlet", HENON_HEILES, another_map),
    "symplectic-schemes": ("stormer-verlet", THREE, another_map),
    "time-scaling": ("lie2", HENON_HEILES, another_map),
    "uncoupled-systems": ("lie2", THREE, another_scheme),
}


OF_THE_PLANE_ALONE = (
    "growth-laws",
    "orbit-averages",
    "order-by-jets",
    "printed-parts",
    "separated-parts-add-up",
)


def test_every_property_in_degrees_has_a_planted_error() -> None:
    assert set(PLANTED_IN_DEGREES) == set(properties.names()) - set(OF_THE_PLANE_ALONE)
    assert set(OF_DEGREES_ALONE) <= set(PLANTED_IN_DEGREES)


@pytest.mark.parametrize("name", sorted(PLANTED_IN_DEGREES))
def test_it_holds_and_fails_with_an_error_planted(name: str, monkeypatch: Patch) -> None:
    scheme, hamiltonian, plant = PLANTED_IN_DEGREES[name]
    holds = properties.get(name).holds(example_of(scheme, hamiltonian))
    assert holds, "it speaks of the example, and holds"
    must_fail(name, plant, example_of(scheme, hamiltonian), monkeypatch)


@pytest.mark.parametrize("scheme", ["implicit-midpoint", "gauss4"])
def test_steps_that_solve_equations_are_held_by_runs(scheme: str) -> None:
    for name in ("exchange-of-degrees", "uncoupled-systems", "symplectic-schemes"):
        assert properties.get(name).holds(example_of(scheme, THREE)), name


def test_a_property_of_the_plane_speaks_of_no_degrees_and_the_other_way_round() -> None:
    several = example_of("lie2")
    for name in OF_THE_PLANE_ALONE:
        assert not properties.get(name).holds(several), name
    plane = {"hamiltonian": "p**2/2 + q**4", "schemes": ["lie2"],
             "grid": {"steps": 2, "step_sizes": ["0.1"],
                      "initial_values": [{"q": 1, "p": 0}]}}  # fmt: skip
    for name in OF_DEGREES_ALONE:
        assert not properties.get(name).holds(Sample.from_scene(scene_from(plane, "scene"))), name


def test_a_scheme_is_that_of_the_sample() -> None:
    assert example_of("lie2").scheme is get("lie2")
