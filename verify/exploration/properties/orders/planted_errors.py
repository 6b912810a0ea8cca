"""A map with one term too many is refuted, at the very power of h where the term was planted."""

from fractions import Fraction
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, only_if, require_value, silent_at
from verify.exploration.sample import Sample
from verify.proof.order_for_one_h import prove
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import StepAlgebra
from verify.verdict import Verdict


def holds(sample: Sample) -> None:
    """Add h^order f_k, f_k not 0, to the coordinate conjugate to z_k, and check the refutation."""
    order, slopes = sample.scheme.order, sample.field.slopes
    only_if(sample.is_turn(one_in=2) and sample.in_closed_form)
    only_if(sample.proof.verdict is Verdict.PROVED)
    place = next(k for k, x in enumerate(slopes) if sample.field.ring.vanishes(x) is False)
    with silent_at(InputError):  # its closed form is too large to be looked at
        proof = prove(_plant_error(sample.step_map, order, place), sample.scheme)
    if proof.verdict is not Verdict.REFUTED:
        raise Violation(f"with an error of h^{order} planted it is {proof.verdict.value}")
    # The planted error changes the order of convergence from `order` to `order` − 1.
    if proof.convergence_order != order - 1:
        message = f"agrees with the flow up to h^{proof.convergence_order}"
        raise Violation(f"with an error of h^{order} planted it {message}")


def _plant_error(true: StepMap, power: int, place: int) -> StepMap:
    """Return the map with h^power times the slope of one coordinate added to its conjugate."""
    paired = (place + true.degrees) % (2 * true.degrees)
    closed = true.closed if true.formulas is not None else None
    if closed is not None:
        elements = list(closed.elements)
        elements[paired] += closed.ring.variable("h") ** power * closed.field.slopes[place]
        return StepMap(true.hamiltonian, closed.field, formulas=tuple(elements))
    step = require_value(true.step)

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        increments, start = step(algebra), [algebra.nothing] * algebra.size
        added = algebra.slopes(start, Fraction(0), [place])
        for _ in range(power):  # each is h times what was added before
            added = [algebra.move(algebra.nothing, [Fraction(1)], added)]
        increments[paired] = algebra.add_share(increments[paired], added[0], Fraction(1))
        return increments

    return StepMap(true.hamiltonian, true.field, changes)
