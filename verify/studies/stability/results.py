"""The verdict on one run as a result, with numbers as decimals."""

from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import plain, text
from verify.hamiltonians.start import start_texts
from verify.prose import Number, Prose, prose
from verify.scenes.results.stability import StabilityResult
from verify.studies.stability.exact_motion import ExactMotion
from verify.studies.stability.limits import linear_limit, round_to_text
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import Run
from verify.studies.stability.verdict_on_run import RunJudgement, judge


def run_result(run: Run) -> StabilityResult:
    """Return the verdict on one run as a result."""
    exact = run.hamiltonian
    point = dict(zip(exact.coordinates, run.state, strict=True))
    motion = RunMotion(run)
    judgement = judge(motion)
    return StabilityResult(
        **exact.texts,
        scheme=run.scheme,
        step_size=text(run.step_size),
        steps=run.steps,
        **start_texts(exact, point, run.t0 if exact.time_dependent else None),
        kind=judgement.kind,
        step=judgement.step,
        rate=round_to_text(judgement.rate, 3),
        energy_error=round_to_text(judgement.energy_error, 3),
        exact_orbit=motion.orbit.summary,
        **_theory_fields(motion, judgement),
    )


def _theory_fields(motion: RunMotion, judgement: RunJudgement) -> dict[str, Any]:
    """Return the fields of linear theory.

    In n degrees of freedom the rate at which neighbours part.
    """
    if isinstance(motion.orbit, ExactMotion):
        sensitivity = motion.orbit.sensitivity
        rate = None if sensitivity is None else f"{sensitivity.exponent:.2g}"
        return {"lyapunov": rate, "detail": judgement.detail}
    limit, h_omega = linear_limit(motion.run.scheme), motion.run.step_size * motion.orbit.frequency
    return {
        "h_omega": round_to_text(h_omega, 3) if h_omega else None,
        "linear_limit": round_to_text(limit, 6),
        "detail": judgement.detail + _compare_with_theory(judgement, h_omega, limit),
    }


def _compare_with_theory(
    judgement: RunJudgement, h_omega: Fraction, limit: Fraction | None
) -> Prose:
    """Compare a scheme that is to blame with its linear theory."""
    if judgement.kind != "unstable: scheme" or limit is None or not h_omega:
        return Prose()
    if limit == 0:
        return prose("; in linear theory it is stable for no step size")
    side = "beyond" if h_omega > limit else "within"
    sizes = Number(plain(h_omega, 3)), Number(plain(limit, 3))
    return prose("; hω = ", sizes[0], f" is {side} its linear limit ", sizes[1])
