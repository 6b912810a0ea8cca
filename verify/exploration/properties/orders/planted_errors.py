"""A map with one term too many is refuted, at the very power of h where the term was planted."""

from fractions import Fraction
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, known, only_if, silent_at
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.hamiltonians.canonical_field import CanonicalField
from verify.proof.claimed import Claimed
from verify.proof.order import prove
from verify.proof.proof import Proof
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import State, StepAlgebra
from verify.verdict import Verdict

_IN = 2  # one in so many samples


def holds(sample: Sample) -> None:
    order = sample.scheme.order
    only_if(sample.is_turn(_IN) and sample.ordinary and not sample.step_map.implicit)
    only_if(sample.proof.verdict is Verdict.PROVED)
    with silent_at(InputError):  # its closed form is too large to be looked at
        finding = prove(_planted(sample.step_map, order), sample.scheme)
    _must_be_refuted(finding, order, f"with q'·h^{order} added to p'")


def _must_be_refuted(proof: Proof, order: int, planted: str) -> None:
    if proof.verdict is not Verdict.REFUTED:
        raise Violation(f"{planted} it is {proof.verdict.value}")
    if proof.convergence_order != order - 1:
        told = f"agrees with the flow up to h^{proof.convergence_order}"
        raise Violation(f"{planted} it {told}, and truly up to h^{order - 1}")


def _planted(true: StepMap, power: int) -> StepMap:
    """The map with q'·h^power added to p'; its series has that term, too, where it has one."""
    closed = true.closed if true.formulas is not None else None
    if closed is not None:
        p_next, q_next = closed.elements
        wrong = p_next + q_next * closed.ring.variable("h") ** power
        return StepMap(true.hamiltonian, closed.field, formulas=(wrong, q_next))

    def expand(most: int) -> tuple[CanonicalField, State]:
        field, (p, q) = known(true.series(most))
        return field, (p + q.shifted(power), q)

    return StepMap(true.hamiltonian, true.field, expand=expand)


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """With h^order f1 added to q1', f1 = −∂H/∂q1."""
    order = sample.scheme.order
    only_if(sample.is_turn(_IN) and sample.ordinary and not sample.step_map.implicit)
    only_if(sample.proof.verdict is Verdict.PROVED)
    field = sample.field
    only_if(field.ring.vanishes(field.slopes[0]) is False)
    claimed = Claimed(sample.scheme.name, order, sample.scheme.area_preserving)
    with silent_at(InputError):
        proof = prove(_planted_in_degrees(sample.step_map, order), claimed=claimed)
    _must_be_refuted(proof, order, f"with h^{order} f1 added to q1'")


def _planted_in_degrees(true: StepMap, power: int) -> StepMap:
    """The map with h^power f1 added to q1', f1 the slope of p1."""
    closed = true.closed if true.formulas is not None else None
    if closed is not None:
        slope = closed.ring.variable("h") ** power * closed.field.slopes[0]
        wrong = list(closed.elements)
        wrong[len(wrong) // 2] += slope
        return StepMap(true.hamiltonian, closed.field, formulas=tuple(wrong))
    step, zero = known(true.step), Fraction(0)

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        found, first = step(algebra), algebra.slopes([algebra.nothing] * algebra.size, zero, [0])
        for _ in range(power):  # each is h times what was added before
            first = [algebra.moved(algebra.nothing, [Fraction(1)], first)]
        n = algebra.size // 2
        found[n] = algebra.between(found[n], first[0], Fraction(1))
        return found

    return StepMap(true.hamiltonian, true.field, changes)
