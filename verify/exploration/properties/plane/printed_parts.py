"""The parts of Λ as they are printed add up to its printed value, within their printed bounds.

One sample in a few is looked at.
"""

from fractions import Fraction

from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.scenes.results.separation_parts import PartsOfRun
from verify.studies.separation.truncation_and_rounding import separate

_DIGITS = 6


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=8) and sample.short)
    separation = separate(
        sample.hamiltonian, sample.scheme.name, **sample.run_arguments, digits=_DIGITS
    )
    only_if(separation.status == "finished")
    for evaluation in (separation.plain, separation.closed_form):
        if evaluation is not None:
            rounding = evaluation.parts.of_rounding
            _must_add_up(evaluation.parts, ("truncation", *rounding), "lambda_working")
            _must_add_up(evaluation.parts, rounding, "total")


def _must_add_up(parts: PartsOfRun, names: tuple[str, ...], whole: str) -> None:
    values = [getattr(parts, name) for name in (*names, whole)]
    numbers, bounds = ([Fraction(getattr(v, key)) for v in values] for key in ("value", "bound"))
    gap = abs(sum(numbers[:-1]) - numbers[-1])
    if gap > sum(bounds):
        message = f"{float(gap):.3e} apart, with bounds of {float(sum(bounds)):.3e}"
        raise Violation(f"{' + '.join(names)} and {whole} are {message}")
