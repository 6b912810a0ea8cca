"""The verdict on one run as a result, with numbers as decimals."""

from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import plain, text
from verify.hamiltonians.start import start_texts
from verify.prose import Number, Prose, prose
from verify.scenes.results.stability import StabilityResult
from verify.studies.stability.exact_motion import ExactMotion
from verify.studies.stability.limits import linear_limit, shortened
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import Run
from verify.studies.stability.verdict_on_run import Judgement, judge


def run_result(run: Run) -> StabilityResult:
    """The verdict on one run."""
    exact = run.hamiltonian
    point = dict(zip(exact.coordinates, run.state, strict=True))
    motion = RunMotion(run)
    judged = judge(motion)
    return StabilityResult(
        **exact.texts,
        scheme=run.scheme,
        step_size=text(run.step_size),
        steps=run.steps,
        **start_texts(exact, point, run.t0 if exact.time_dependent else None),
        kind=judged.kind,
        step=judged.step,
        rate=shortened(judged.rate, 3),
        energy_error=shortened(judged.energy_error, 3),
        exact_orbit=motion.orbit.summary,
        **_beside(motion, judged),
    )


def _beside(motion: RunMotion, judged: Judgement) -> dict[str, Any]:
    """What linear theory says beside the verdict; in n degrees of freedom how fast neighbours
    part."""
    if isinstance(motion.orbit, ExactMotion):
        seen = motion.orbit.sensitivity
        rate = None if seen is None else f"{seen.exponent:.2g}"
        return {"lyapunov": rate, "detail": judged.detail}
    limit, h_omega = linear_limit(motion.run.scheme), motion.run.step_size * motion.orbit.frequency
    return {
        "h_omega": shortened(h_omega, 3) if h_omega else None,
        "linear_limit": shortened(limit, 6),
        "detail": judged.detail + _against_theory(judged, h_omega, limit),
    }


def _against_theory(found: Judgement, h_omega: Fraction, limit: Fraction | None) -> Prose:
    """What linear theory says of a scheme that is to blame."""
    if found.kind != "unstable: scheme" or limit is None or not h_omega:
        return Prose()
    if limit == 0:
        return prose("; in linear theory it is stable for no step size")
    side = "beyond" if h_omega > limit else "within"
    sizes = Number(plain(h_omega, 3)), Number(plain(limit, 3))
    return prose("; hω = ", sizes[0], f" is {side} its linear limit ", sizes[1])
