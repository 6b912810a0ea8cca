"""The verdict on one run as a result, with numbers as decimals."""

from fractions import Fraction

from verify.arithmetic.exact import plain, text
from verify.hamiltonians.start import shown_of
from verify.prose import Number, Prose, prose
from verify.scenes.results.stability import StabilityResult
from verify.studies.stability.frequency import frequency
from verify.studies.stability.limits import linear_limit, shortened
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import Run, RunInDegrees
from verify.studies.stability.verdict_in_degrees import MotionInDegrees, judge_in_degrees
from verify.studies.stability.verdict_on_run import Judgement, judge


def result_in_degrees(run: RunInDegrees) -> StabilityResult:
    """The verdict on one run in n degrees of freedom."""
    motion = MotionInDegrees(run)
    found, orbit, exact = judge_in_degrees(motion), motion.orbit, run.hamiltonian
    point, seen = dict(zip(exact.coordinates, run.state, strict=True)), orbit.sensitivity
    return StabilityResult(
        **exact.texts,
        scheme=run.scheme,
        step_size=text(run.step_size),
        steps=run.steps,
        q=shown_of(exact, point, "q"),
        p=shown_of(exact, point, "p"),
        t0=text(run.t0) if exact.time_dependent else None,
        kind=found.kind,
        step=found.step,
        rate=shortened(found.rate, 3),
        energy_error=shortened(found.energy_error, 3),
        lyapunov=None if seen is None else f"{seen.exponent:.2g}",
        exact_orbit=orbit.summary,
        detail=found.detail,
    )


def run_result(run: Run) -> StabilityResult:
    """The verdict on one run."""
    motion = RunMotion(run)
    found, orbit = judge(motion), motion.orbit
    limit, h_omega = linear_limit(run.scheme), run.step_size * frequency(orbit)
    return StabilityResult(
        **run.hamiltonian.texts,
        scheme=run.scheme,
        step_size=text(run.step_size),
        steps=run.steps,
        q=text(run.q),
        p=text(run.p),
        t0=text(run.t0) if run.hamiltonian.time_dependent else None,
        kind=found.kind,
        step=found.step,
        rate=shortened(found.rate, 3),
        energy_error=shortened(found.energy_error, 3),
        h_omega=shortened(h_omega, 3) if h_omega else None,
        linear_limit=shortened(limit, 6),
        exact_orbit=orbit.summary,
        detail=found.detail + _against_theory(found, h_omega, limit),
    )


def _against_theory(found: Judgement, h_omega: Fraction, limit: Fraction | None) -> Prose:
    """What linear theory says of a scheme that is to blame."""
    if found.kind != "unstable: scheme" or limit is None or not h_omega:
        return Prose()
    if limit == 0:
        return prose("; in linear theory it is stable for no step size")
    side = "beyond" if h_omega > limit else "within"
    sizes = Number(plain(h_omega, 3)), Number(plain(limit, 3))
    return prose("; hω = ", sizes[0], f" is {side} its linear limit ", sizes[1])
