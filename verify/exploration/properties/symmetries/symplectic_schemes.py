"""A scheme that claims det J ≡ 1 has it: by the proof, and by J's four entries at a point.

In n degrees of freedom it has S = JᵀΩJ − Ω ≡ 0, and the entries of S are checked. If the step is
implicit, J is that of two steps, by differences of runs; in the plane the product of the
determinants in a kernel is checked, too. The digits may not suffice to solve the equations: a
result that changes with twice as many digits does not count against the scheme.
"""

from fractions import Fraction
from operator import attrgetter

from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration import reference_steps
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.scenes.observables import carries
from verify.structures import AREA, SYMPLECTIC

_APPLIES = {AREA: attrgetter("ordinary"), SYMPLECTIC: attrgetter("brief")}
_BITS_OF_DIFFERENCES = 700
# Of Π det J − 1: if H is steep, the entries of J lose twenty digits in a step.
_PRODUCT_TOLERANCE = Fraction(1, 10**30)


def holds(sample: Sample) -> None:
    """Check the proof and the entries of S."""
    only_if(sample.scheme.area_preserving)
    only_if(_APPLIES[sample.hamiltonian.structure](sample))
    if sample.ordinary and sample.proof.symplectic is False:
        raise Violation(f"the proof says that S has order {sample.proof.order}")
    if sample.step_map.implicit:
        _check_by_runs(sample)
        return
    after = reference_steps.ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    with working_precision(reference_steps.BITS):
        form = reference_steps.defect(after.step_jacobian)
    if not all(x.contains(0) for x in reference_steps.entries(form)):
        raise Violation(
            f"S is not 0; its greatest |entry| is {reference_steps.largest(form).str(6)}"
        )


def _check_by_runs(sample: Sample) -> None:
    only_if(sample.hamiltonian.planar or (sample.is_turn(one_in=8) and sample.short))
    jacobian, error = reference_steps.jacobian_of_run(sample)
    with working_precision(_BITS_OF_DIFFERENCES):
        greatest = reference_steps.largest(reference_steps.defect(jacobian))
        is_wrong = greatest > error
    if is_wrong:
        raise Violation(f"W is {greatest.str(6)} after two steps, by differences of runs")
    if carries(sample.hamiltonian, "lambda_plain"):
        end = reference_steps.end_of(sample, "lambda_plain")
        change = end["lambda_plain"]
        small = _PRODUCT_TOLERANCE * (1 + sum(abs(end[n]) for n in sample.point))
        if abs(change) > small:
            # Twice as many digits decide if the equations were not solved, or if the map is wrong.
            accurate_end = reference_steps.end_of(sample, times=2)
            only_if(all(abs(x - end[name]) <= small for name, x in accurate_end.items()))
            raise Violation(f"Π det J − 1 is {decimal(change, 6)} after two steps")
