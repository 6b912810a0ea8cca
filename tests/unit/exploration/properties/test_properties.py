"""Every property of the catalogue: it holds of a scene, and a planted error makes it fail there."""

import pytest

from tests.helpers.planted import property_errors as errors
from tests.helpers.planted.property_errors import (
    DRIVEN,
    HENON_HEILES,
    MIXED,
    QUARTIC,
    THREE,
    InPlace,
    Patch,
    Plant,
    example_of,
    must_fail,
    take_every_turn,
    with_added,
)
from verify.exploration import properties
from verify.schemes import get


@pytest.fixture(autouse=True)
def _every_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    take_every_turn(monkeypatch)


PLANTED: dict[str, tuple[str, Plant]] = {
    "area-errors-compose": ("lie2", errors.sums_for_products),
    "certificates": ("lie2", errors.believes_all),
    "claims-of-schemes": ("lie2", errors.added(0, 1, 2)),
    "convergence-order": ("lie3", errors.one_more_order),
    "every-hamiltonian": ("lie2", errors.an_order_too_high),
    "exact-flows": ("lie2", errors.half_a_flow),
    "exchange-of-p-and-q": ("lie2", errors.added(1, 2, 3)),
    "growth-laws": ("lie2", errors.twice_the_potential),
    "linear-canonical-maps": ("lie2", errors.added(1, 2, 3)),
    "number-systems-agree": ("lie2", errors.off_by_a_digit),
    "orbit-averages": ("lie2", errors.values_too_large),
    "order-by-jets": ("lie2", errors.another_proof),
    "planted-errors": ("lie2", errors.blind),
    "printed-parts": ("lie2", errors.a_part_misprinted),
    "quadratic-hamiltonians": ("lie2", errors.added(1, 0, 4)),
    "results-read-back": ("lie2", errors.a_lost_sign),
    "separated-parts-add-up": ("lie2", errors.a_part_twice),
    "symmetric-schemes": ("stormer-verlet", errors.added(0, 1, 2)),
    "symplectic-schemes": ("stormer-verlet", errors.added(1, 0, 5)),
    "time-scaling": ("lie2", errors.added(0, 1, 2)),
}
PLANTED_IN_DEGREES: dict[str, tuple[str, str, InPlace]] = {
    "area-errors-compose": ("lie2", HENON_HEILES, errors.sums_for_products),
    "certificates": ("lie2", HENON_HEILES, errors.takes_every_certificate),
    "claims-of-schemes": ("lie2", HENON_HEILES, errors.claims_one_more_order),
    "convergence-order": ("lie2", HENON_HEILES, errors.one_more_order),
    "every-hamiltonian": ("lie2", HENON_HEILES, errors.one_order_less),
    "exact-flows": ("lie2", HENON_HEILES, errors.half_the_time),
    "exchange-of-degrees": ("stormer-verlet", HENON_HEILES, errors.another_map),
    "exchange-of-p-and-q": ("rk4", MIXED, errors.another_map),
    "extended-system": ("stormer-verlet", DRIVEN, errors.another_map),
    "linear-canonical-maps": ("lie2", THREE, errors.another_map),
    "number-systems-agree": ("lie2", HENON_HEILES, errors.another_map),
    "periodic-hamiltonians": ("lie2", DRIVEN, errors.a_second_drive),
    "planted-errors": ("lie2", HENON_HEILES, errors.blind),
    "quadratic-hamiltonians": ("lie2", MIXED, errors.another_scheme),
    "results-read-back": ("lie2", HENON_HEILES, errors.a_lost_step),
    "shift-of-time": ("rk4", DRIVEN, errors.another_map),
    "symmetric-schemes": ("stormer-verlet", HENON_HEILES, errors.another_map),
    "symplectic-schemes": ("stormer-verlet", THREE, errors.another_map),
    "time-scaling": ("lie2", HENON_HEILES, errors.another_map),
    "uncoupled-systems": ("lie2", THREE, errors.another_scheme),
}
CASES = [
    *((name, scheme, QUARTIC, plant) for name, (scheme, plant) in sorted(PLANTED.items())),
    *((name, *case) for name, case in sorted(PLANTED_IN_DEGREES.items())),
]


OF_TIME_ALONE = ("extended-system", "periodic-hamiltonians", "shift-of-time")  # see test_in_time
OF_DEGREES_ALONE = ("exchange-of-degrees", "uncoupled-systems")
OF_THE_PLANE_ALONE = (
    "growth-laws",
    "orbit-averages",
    "order-by-jets",
    "printed-parts",
    "separated-parts-add-up",
)


def test_every_property_has_a_planted_error() -> None:
    every = set(properties.names())
    assert set(PLANTED) == every - set(OF_TIME_ALONE) - set(OF_DEGREES_ALONE)
    assert set(PLANTED_IN_DEGREES) == every - set(OF_THE_PLANE_ALONE)
    assert set(OF_DEGREES_ALONE) <= set(PLANTED_IN_DEGREES)


@pytest.mark.parametrize("name", properties.names())
def test_a_property_is_a_sentence(name: str) -> None:
    sentence = properties.get(name).sentence
    assert sentence.endswith((".", "?")), sentence
    assert 20 < len(sentence) <= 100


@pytest.mark.parametrize(
    ("name", "scheme", "hamiltonian", "plant"), CASES,
    ids=[*sorted(PLANTED), *(f"{name} in degrees" for name in sorted(PLANTED_IN_DEGREES))],
)  # fmt: skip
def test_a_property_holds_and_fails_with_an_error_planted(
    name: str, scheme: str, hamiltonian: str, plant: InPlace, monkeypatch: Patch
) -> None:
    t0 = "0.7" if hamiltonian == DRIVEN else "0"
    asked = properties.get(name)
    assert asked.holds(example_of(scheme, hamiltonian, t0)), "it speaks of the example, and holds"
    must_fail(name, plant, example_of(scheme, hamiltonian, t0), monkeypatch)


@pytest.mark.sample(99)
@pytest.mark.parametrize("name", properties.names())
@pytest.mark.parametrize("scheme", ["lie1", "lie4", "rk4", "gauss4", "implicit-midpoint", "ruth3"])
def test_a_property_holds_or_does_not_speak(name: str, scheme: str) -> None:
    properties.get(name).holds(example_of(scheme))


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", properties.names())
@pytest.mark.parametrize(
    "hamiltonian", ["p", "q**2", "p*q", "-p**2 - cos(q)", "exp(p + q)", "p**2 + 1/(1 + q**2)"]
)
def test_a_property_holds_of_odd_hamiltonians(name: str, hamiltonian: str) -> None:
    properties.get(name).holds(example_of("lie2", hamiltonian))


def test_each_property_speaks_of_some_scheme() -> None:
    shown = {name for name in properties.names() for scheme in ("lie2", "stormer-verlet", "gauss4")
             if properties.get(name).holds(example_of(scheme))}  # fmt: skip
    assert shown == set(PLANTED)


@pytest.mark.parametrize(
    ("names", "hamiltonian"),
    [(OF_THE_PLANE_ALONE, HENON_HEILES), (OF_DEGREES_ALONE, "p**2/2 + q**4")],
    ids=["plane", "degrees"],
)
def test_properties_of_the_plane_do_not_speak_of_degrees_and_the_other_way_round(
    names: tuple[str, ...], hamiltonian: str
) -> None:
    for name in names:
        assert not properties.get(name).holds(example_of("lie2", hamiltonian)), name


@pytest.mark.parametrize("scheme", ["implicit-midpoint", "gauss4"])
def test_steps_that_solve_equations_are_held_by_runs(scheme: str) -> None:
    for name in ("exchange-of-degrees", "uncoupled-systems", "symplectic-schemes"):
        assert properties.get(name).holds(example_of(scheme, THREE)), name


def test_an_unknown_property_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(ValueError, match="time-scaling"):
        properties.get("time")


def test_a_scheme_keeps_its_name_when_planted() -> None:
    """The control of `with_added`: nothing added is the same step."""
    for scheme in ("lie2", "rk4", "stormer-verlet"):
        same = with_added(example_of(scheme), 1, lambda ring: ring.zero)
        assert same.scheme.name == get(scheme).name
        assert properties.get("time-scaling").holds(same)


@pytest.mark.parametrize("hamiltonian", [QUARTIC, HENON_HEILES], ids=["plane", "degrees"])
def test_a_scheme_is_that_of_the_sample(hamiltonian: str) -> None:
    assert example_of("lie2", hamiltonian).scheme is get("lie2")
