"""A map with one term too many is refuted, at the very power of h where the term was planted."""

from fractions import Fraction
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.proof.claimed import Claimed
from verify.proof.order import prove
from verify.proof.order_proof import Proof
from verify.proof.symplectic.order import prove_map
from verify.proof.symplectic.proof import SymplecticProof
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.step_algebra import StepAlgebra
from verify.schemes.step_map import Expanded, StepMap
from verify.schemes.substep import Substep
from verify.verdict import Verdict

_IN = 2  # one in so many samples


def holds(sample: Sample) -> None:
    order, parts = sample.scheme.order, sample.step_map.substeps
    only_if(sample.is_turn(_IN) and sample.ordinary)
    only_if(not any(part.implicit or part.staged for part in parts))
    only_if(sample.proof.verdict is Verdict.PROVED)
    with silent_at(InputError):  # its closed form is too large to be looked at
        found = prove(_planted(sample, order), sample.scheme)
    _must_be_refuted(found, order, f"with q'·h^{order} added to p'")


def _must_be_refuted(found: Proof | SymplecticProof, order: int, planted: str) -> None:
    if found.verdict is not Verdict.REFUTED:
        raise Violation(f"{planted} it is {found.verdict.value}")
    if found.convergence_order != order - 1:
        told = f"agrees with the flow up to h^{found.convergence_order}"
        raise Violation(f"{planted} it {told}, and truly up to h^{order - 1}")


def _planted(sample: Sample, power: int) -> StepMap:
    """The map with q'·h^power added to p'; its series has that term, too, where it has one."""
    true = sample.step_map
    *before, last = true.substeps
    wrong = last.p_next + last.q_next * last.ring.variable("h") ** power
    parts = (*before, Substep(last.field, wrong, last.q_next))
    known = true.expansion
    if known is None:
        return StepMap(sample.hamiltonian, parts)

    def expansion(most: int) -> Expanded:
        field, p, q = known(most)
        return field, p + q.shifted(power), q

    return StepMap(sample.hamiltonian, parts, expansion)


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """With h^order f1 added to q1', f1 = −∂H/∂q1."""
    order = sample.scheme.order
    only_if(sample.is_turn(_IN) and sample.ordinary and not sample.step_map.implicit)
    only_if(sample.proof.verdict is Verdict.PROVED)
    field = sample.field
    only_if(field.ring.vanishes(field.slopes[0]) is False)
    claimed = Claimed(sample.scheme.name, order, sample.scheme.area_preserving)
    with silent_at(InputError):
        found = prove_map(_planted_in_degrees(sample.step_map, order), claimed)
    _must_be_refuted(found, order, f"with h^{order} f1 added to q1'")


def _planted_in_degrees(true: CanonicalMap, power: int) -> CanonicalMap:
    """The map with h^power f1 added to q1', f1 the slope of p1."""
    step = true.step
    assert step is not None  # noqa: S101 - the schemes of the catalogue have one
    zero = Fraction(0)

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        found, first = step(algebra), algebra.slopes([algebra.nothing] * algebra.size, zero, [0])
        for _ in range(power):  # each is h times what was added before
            first = [algebra.moved(algebra.nothing, [Fraction(1)], first)]
        n = algebra.size // 2
        found[n] = algebra.between(found[n], first[0], Fraction(1))
        return found

    return CanonicalMap(true.hamiltonian, true.field, changes)
