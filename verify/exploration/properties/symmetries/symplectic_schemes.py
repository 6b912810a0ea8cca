"""A scheme that claims det J ≡ 1 has it: by the proof, and by J's four entries at a point.

In n degrees of freedom S ≡ 0, and its entries. Where the step solves equations J is that of two
steps, by differences of runs; in the plane the determinants that a kernel multiplies are looked at,
too. Digits may not do to solve the equations: what twice as many find elsewhere, or not at all, is
not held against the scheme.
"""

from fractions import Fraction
from operator import attrgetter

from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import BITS, ball_steps, defect, entries, largest
from verify.exploration.oracles.mpfr_runs import end_of, jacobian_of_run
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.scenes.observables import carries
from verify.structures import AREA, SYMPLECTIC

_LOOKED_AT = {AREA: attrgetter("ordinary"), SYMPLECTIC: attrgetter("brief")}
_BITS_OF_DIFFERENCES = 700
_SMALL = Fraction(1, 10**30)  # where H is steep, the entries lose twenty digits in a step


def holds(sample: Sample) -> None:
    only_if(sample.scheme.area_preserving)
    only_if(_LOOKED_AT[sample.hamiltonian.structure](sample))
    if sample.ordinary and sample.proof.symplectic is False:
        raise Violation(f"the proof says that S has order {sample.proof.order}")
    if sample.step_map.implicit:
        _by_runs(sample)
        return
    after = ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    with working_precision(BITS):
        form = defect(after.own)
    if not all(x.contains(0) for x in entries(form)):
        raise Violation(f"S is not 0; its greatest |entry| is {largest(form).str(6)}")


def _by_runs(sample: Sample) -> None:
    only_if(sample.hamiltonian.planar or (sample.is_turn(one_in=8) and sample.short))
    jacobian, error = jacobian_of_run(sample)
    with working_precision(_BITS_OF_DIFFERENCES):
        seen = largest(defect(jacobian))
        wrong = seen > error
    if wrong:
        raise Violation(f"W is {seen.str(6)} after two steps, by differences of runs")
    if carries(sample.hamiltonian, "lambda_plain"):
        end = end_of(sample, "lambda_plain")
        change, small = end["lambda_plain"], _SMALL * (1 + sum(abs(end[n]) for n in sample.point))
        if abs(change) > small:
            again = end_of(sample, times=2)
            only_if(all(abs(x - end[name]) <= small for name, x in again.items()))
            raise Violation(f"Π det J − 1 is {decimal(change, 6)} after two steps")
