"""The step of −h undoes the step of h, for a scheme that claims to be symmetric."""

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Violation, only_if
from verify.exploration.reference_steps import BITS, ball_steps, must_overlap, take_step
from verify.exploration.sample import Sample
from verify.proof.map_symmetry import judge_symmetry
from verify.verdict import Verdict


def holds(sample: Sample) -> None:
    only_if(sample.scheme.symmetric and sample.light)
    # In n degrees of freedom such a series may take a minute.
    if sample.hamiltonian.planar and sample.is_turn(one_in=3) and sample.in_closed_form:
        series = judge_symmetry(sample.step_map, sample.scheme.order + 1)
        if series.verdict is Verdict.REFUTED:
            raise Violation(f"by series it is not symmetric: {series.reason}")
    first, last = ball_steps(sample.step_map, sample.start, 1)
    with working_precision(BITS):
        # Φ_{−h}∘Φ_h = 1, from the end of the first step.
        back = take_step(sample.step_map, last, rational_ball(-sample.step_size)).sharp()
    for name in sample.point:
        must_overlap(f"{name} comes back as", back.point[name], first.point[name])
