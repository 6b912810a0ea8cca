"""Every property of the catalogue: it holds of a scene, and a planted error makes it fail there."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.planted.steps import Term, with_term
from verify.arithmetic.exact import decimal
from verify.exploration import properties
from verify.exploration.property import Violation
from verify.exploration.sample import Sample
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.proof.order_for_one_h import prove
from verify.proof.plane import growth_law as growth
from verify.scenes.scene import scene_from
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.two_form import TwoForm

Patch = pytest.MonkeyPatch
Plant = Callable[[Sample, Patch], Sample]
InPlace = Callable[[Sample, Patch], Sample | None]  # None: planted in the sample itself


def example_of(scheme: str, hamiltonian: str = "p**2/2 + q**2/2 + q**4/4", t0: str = "0") -> Sample:
    data = {
        "hamiltonian": hamiltonian,
        "t0": t0,
        "schemes": [scheme],
        "grid": {
            "steps": 6,
            "step_sizes": ["0.01"],
            "initial_values": [{"q": "1.1", "p": "-0.3"}],
        },
    }
    return Sample.from_scene(scene_from(data, "scene"))


@pytest.fixture(autouse=True)
def _every_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    take_every_turn(monkeypatch)


def take_every_turn(patch: Patch) -> None:
    """What looks at one example in a few looks at these."""
    patch.setattr(Sample, "turn", 0)
    patch.setattr(Sample, "is_turn", lambda self, one_in, after=0: True)


def with_added(sample: Sample, h_power: int, term: Term, part: str = "p") -> Sample:
    """The example, its scheme's p' or q' changed for every H by h^… times the term."""
    true = sample.scheme.step_map

    def build(hamiltonian: Hamiltonian) -> StepMap:
        return with_term(true(hamiltonian), "pq".index(part), h_power, term)

    return replace(sample, scheme=replace(sample.scheme, build=build))


def added(p_power: int, q_power: int, h_power: int, part: str = "p") -> Plant:
    """h^… p^… q^…/1000 added to p' or q'."""
    return lambda sample, _: with_added(sample, h_power, monomial(p_power, q_power, 1000), part)


def monomial(p_power: int, q_power: int, divisor: int) -> Term:
    return lambda ring: ring.variable("p") ** p_power * ring.variable("q") ** q_power / divisor


def wrong_order(sample: Sample, patch: Patch) -> Sample:
    """A proof that says one order more."""
    proof = sample.proof
    assert proof.convergence_order is not None
    wrong = replace(proof, convergence_order=proof.convergence_order + 1)
    patch.setitem(sample.__dict__, "proof", wrong)
    return sample


def another_proof(sample: Sample, patch: Patch) -> Sample:
    """The proof of another map: an h³ term of the wrong sign."""
    twisted = added(1, 1, 3)(sample, patch)
    patch.setitem(sample.__dict__, "proof", prove(twisted.step_map, sample.scheme))
    return sample


def sums_for_products(sample: Sample, patch: Patch) -> Sample:
    """Λ as the sum of the ΔJ."""
    from verify.kernels.statements import Statements

    kernel_for.cache_clear()
    patch.setattr(Statements, "product", lambda self: self.sum_up("lam", "dj"))
    return sample


def off_by_a_digit(sample: Sample, patch: Patch) -> Sample:
    from verify.exploration.properties.numbers import number_systems_agree as module

    true = module.run

    def wrong(*args: Any, **named: Any) -> Any:
        found = true(*args, **named)
        last = found.values["q"]
        moved = Fraction(last.value) + 4 * Fraction(last.bound)
        value = last.model_copy(update={"value": decimal(moved, 60)})
        return found.model_copy(update={"values": found.values | {"q": value}})

    patch.setattr(module, "run", wrong)
    return sample


def a_part_twice(sample: Sample, patch: Patch) -> Sample:
    from verify.studies.separation.chain import Chain

    true = Chain.trail

    def wrong(self: Chain, name: str) -> Any:
        trail, bound = true(self, name)
        return (tuple(2 * x for x in trail) if name == "product" else trail), bound

    patch.setattr(Chain, "trail", wrong)
    return sample


def twice_the_potential(sample: Sample, patch: Patch) -> Sample:
    growth.growth_law.cache_clear()
    true = growth.potential_of_lie

    def twice(flow: Any, eta: int) -> TwoForm:
        form = true(flow, eta)
        return TwoForm.from_entries(form.ring, form.names, lambda a, b: 2 * form.entry(a, b))

    patch.setattr(growth, "potential_of_lie", twice)
    return sample


def blind(sample: Sample, patch: Patch) -> Sample:
    """A proof that never sees that an order is missed."""
    from verify.proof.proof_for_one_h import Convergence

    assert sample.proof
    patch.setattr(Convergence, "misses", lambda self, claimed: False)
    return sample


def a_lost_sign(sample: Sample, patch: Patch) -> Sample:
    from verify.exploration.properties.numbers import results_read_back as module

    true = module.scene_text
    patch.setattr(module, "scene_text", lambda scene: true(scene).replace('"-', '"'))
    return sample


def believes_all(sample: Sample, patch: Patch) -> Sample:
    """A checker for which every polynomial is zero."""
    from verify.proof.certificates.checker import Identities

    patch.setattr(Identities, "residuals", lambda _: iter(()))
    return sample


def an_order_too_high(sample: Sample, patch: Patch) -> Sample:
    from verify.exploration.properties.orders import every_hamiltonian as module

    true = module._prove_every
    patch.setattr(module, "_prove_every", lambda *asked: replace(true(*asked), order=4))
    return sample


def half_a_flow(sample: Sample, patch: Patch) -> Sample:
    """q moves with the flow of H, and p by half of it."""
    from verify.flows import extrapolation

    class Halved(extrapolation.ElementCode):
        @classmethod
        def from_elements(cls, arithmetic: Any, slopes: Any, names: Any) -> Any:
            (ring, dp), of_q = slopes
            return super().from_elements(arithmetic, [(ring, dp / 2), of_q], names)

    patch.setattr(extrapolation, "ElementCode", Halved)
    return sample


def values_too_large(sample: Sample, patch: Patch) -> Sample:
    """The averaged function by a thousandth larger along the orbit."""
    from verify.flows.closed_orbit import ClosedOrbit

    true = ClosedOrbit.values

    def wrong(self: ClosedOrbit, g: Any) -> Any:
        with self.flow.arithmetic.context():
            return [x + x / 1000 for x in true(self, g)]

    patch.setattr(ClosedOrbit, "values", wrong)
    return sample


def a_part_misprinted(sample: Sample, patch: Patch) -> Sample:
    from verify.studies.separation.chain import Chain

    true = Chain.final

    def wrong(self: Chain, name: str) -> Any:
        value, bound = true(self, name)
        return (2 * value if name == "trajectory" else value), bound

    patch.setattr(Chain, "final", wrong)
    return sample


PLANTED: dict[str, tuple[str, Plant]] = {
    "area-errors-compose": ("lie2", sums_for_products),
    "certificates": ("lie2", believes_all),
    "claims-of-schemes": ("lie2", added(0, 1, 2)),
    "convergence-order": ("lie3", wrong_order),
    "every-hamiltonian": ("lie2", an_order_too_high),
    "exact-flows": ("lie2", half_a_flow),
    "exchange-of-p-and-q": ("lie2", added(1, 2, 3)),
    "growth-laws": ("lie2", twice_the_potential),
    "linear-canonical-maps": ("lie2", added(1, 2, 3)),
    "number-systems-agree": ("lie2", off_by_a_digit),
    "orbit-averages": ("lie2", values_too_large),
    "order-by-jets": ("lie2", another_proof),
    "planted-errors": ("lie2", blind),
    "printed-parts": ("lie2", a_part_misprinted),
    "quadratic-hamiltonians": ("lie2", added(1, 0, 4)),
    "results-read-back": ("lie2", a_lost_sign),
    "separated-parts-add-up": ("lie2", a_part_twice),
    "symmetric-schemes": ("stormer-verlet", added(0, 1, 2)),
    "symplectic-schemes": ("stormer-verlet", added(1, 0, 5)),
    "time-scaling": ("lie2", added(0, 1, 2)),
}


OF_TIME_ALONE = ("extended-system", "periodic-hamiltonians", "shift-of-time")  # see test_in_time
OF_DEGREES_ALONE = ("exchange-of-degrees", "uncoupled-systems")  # see test_in_degrees


def must_fail(name: str, plant: InPlace, sample: Sample, patch: Patch) -> None:
    """With the error planted the property is violated, and says so in one line."""
    kernel_for.cache_clear()
    growth.growth_law.cache_clear()
    planted = plant(sample, patch) or sample
    try:
        with pytest.raises(Violation) as found:
            properties.get(name).holds(planted)
    finally:
        patch.undo()
        kernel_for.cache_clear()
        growth.growth_law.cache_clear()
    assert "\n" not in str(found.value)


def test_every_property_has_a_planted_error() -> None:
    assert set(PLANTED) == set(properties.names()) - set(OF_TIME_ALONE) - set(OF_DEGREES_ALONE)


@pytest.mark.parametrize("name", properties.names())
def test_a_property_is_a_sentence(name: str) -> None:
    sentence = properties.get(name).sentence
    assert sentence.endswith((".", "?")), sentence
    assert 20 < len(sentence) <= 100


@pytest.mark.parametrize("name", sorted(PLANTED))
def test_a_property_holds_and_fails_with_an_error_planted(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scheme, plant = PLANTED[name]
    asked = properties.get(name)
    assert asked.holds(example_of(scheme)), "it speaks of the example, and holds"
    must_fail(name, plant, example_of(scheme), monkeypatch)


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


def test_an_unknown_property_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(ValueError, match="time-scaling"):
        properties.get("time")


def test_a_scheme_keeps_its_name_when_planted() -> None:
    """The control of `with_added`: nothing added is the same step."""
    for scheme in ("lie2", "rk4", "stormer-verlet"):
        same = with_added(example_of(scheme), 1, lambda ring: ring.zero)
        assert same.scheme.name == get(scheme).name
        assert properties.get("time-scaling").holds(same)
