"""Examples for the catalogue's properties, and errors of all sorts planted for them to find.

An error may be planted in the scheme, in what is proved of it, or in what a property calls.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from importlib import import_module
from typing import Any

import pytest

from tests.helpers.planted.steps import Term, with_term
from verify.arithmetic.exact import decimal
from verify.exploration import properties
from verify.exploration.property import Violation
from verify.exploration.sample import Sample
from verify.flows.extrapolation import NumericalFlow
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.proof.order_for_one_h import prove
from verify.proof.plane import growth_law as growth
from verify.scenes.scene import scene_from
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.two_form import TwoForm

Patch = pytest.MonkeyPatch
Plant = Callable[[Sample, Patch], Sample]
InPlace = Callable[[Sample, Patch], Sample | None]  # None: planted in the sample itself
QUARTIC = "p**2/2 + q**2/2 + q**4/4"
HENON_HEILES = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"
DRIVEN = f"{HENON_HEILES} + q1*cos(3*t)/5"
THREE = "p1**2/2 + p2**2 + p3**2/2 + q1**4/4 - cos(q2) + q3**2 + q1*q3"
MIXED = "p1**2/2 + p2**2/2 + q1**2/2 + q2**4/4 + p1*q2/3"


def example_of(scheme: str, hamiltonian: str = QUARTIC, t0: str = "0") -> Sample:
    """A short run of the scheme, with one start for each number of degrees of freedom."""
    degrees = Hamiltonian.parse(hamiltonian).degrees
    steps, step_size, start = 6, "0.01", {"q": "1.1", "p": "-0.3"}
    if degrees > 1:
        steps, step_size = 3, "0.05"
        start = {"q": ["0.3", "-0.2", "0.5"][:degrees], "p": ["0.1", "1/3", "-0.4"][:degrees]}
    data = {
        "hamiltonian": hamiltonian,
        "t0": t0,
        "schemes": [scheme],
        "grid": {"steps": steps, "step_sizes": [step_size], "initial_values": [start]},
    }
    return Sample.from_scene(scene_from(data, "scene"))


def take_every_turn(patch: Patch) -> None:
    """What looks at one example in a few looks at these."""
    patch.setattr(Sample, "turn", 0)
    patch.setattr(Sample, "is_turn", lambda self, one_in, after=0: True)


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


# -- in the plane, and some in any number of degrees of freedom -----------------------------------


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


def one_more_order(sample: Sample, patch: Patch) -> Sample:
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


# -- in n degrees of freedom -----------------------------------------------------------------------


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


def one_order_less(sample: Sample, patch: Patch) -> None:
    first = replace(sample.proof.first, power=(sample.proof.order or 0) - 1)
    patch.setitem(sample.__dict__, "proof", replace(sample.proof, first=first))


def claims_one_more_order(sample: Sample, _: Patch) -> Sample:
    return replace(sample, scheme=replace(sample.scheme, order=sample.scheme.order + 1))


def takes_every_certificate(_: Sample, patch: Patch) -> None:
    module = import_module("verify.exploration.properties.orders.certificates")
    patch.setattr(module, "check", lambda data: None)


def half_the_time(_: Sample, patch: Patch) -> None:
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
