"""A map with one term too many is refuted, at the very power of h where the term was planted."""

from fractions import Fraction
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, known, only_if, silent_at
from verify.exploration.sample import Sample
from verify.proof.order import prove
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import StepAlgebra
from verify.verdict import Verdict


def holds(sample: Sample) -> None:
    """With h^order f_k added to the coordinate that z_k is paired with, f_k not 0."""
    order, slopes = sample.scheme.order, sample.field.slopes
    only_if(sample.is_turn(one_in=2) and sample.in_closed_form)
    only_if(sample.proof.verdict is Verdict.PROVED)
    place = next(k for k, x in enumerate(slopes) if sample.field.ring.vanishes(x) is False)
    with silent_at(InputError):  # its closed form is too large to be looked at
        proof = prove(_planted(sample.step_map, order, place), sample.scheme)
    if proof.verdict is not Verdict.REFUTED:
        raise Violation(f"with an error of h^{order} planted it is {proof.verdict.value}")
    if proof.convergence_order != order - 1:
        told = f"agrees with the flow up to h^{proof.convergence_order}"
        raise Violation(f"with an error of h^{order} planted it {told}")


def _planted(true: StepMap, power: int, place: int) -> StepMap:
    """The map with h^power times the slope of one coordinate added to the one it is paired with."""
    paired = (place + true.degrees) % (2 * true.degrees)
    closed = true.closed if true.formulas is not None else None
    if closed is not None:
        wrong = list(closed.elements)
        wrong[paired] += closed.ring.variable("h") ** power * closed.field.slopes[place]
        return StepMap(true.hamiltonian, closed.field, formulas=tuple(wrong))
    step = known(true.step)

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        found, start = step(algebra), [algebra.nothing] * algebra.size
        added = algebra.slopes(start, Fraction(0), [place])
        for _ in range(power):  # each is h times what was added before
            added = [algebra.moved(algebra.nothing, [Fraction(1)], added)]
        found[paired] = algebra.between(found[paired], added[0], Fraction(1))
        return found

    return StepMap(true.hamiltonian, true.field, changes)
