"""Verdicts as results: on one run, the largest step with bounded motion, the (h, stiffness) map.

Linear theory requires of a step size h that h ω lies in the scheme's interval (see
`verify.studies.stability.linear_stability`), ω being the greatest frequency on the exact orbit,
where that is stiffest. Bounded motion is defined in `verify.studies.stability.run_motion` and
`verify.studies.stability.verdict_on_run`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import sympy

from verify.arithmetic.exact import NumberOrList, decimal, plain, text
from verify.errors import InputError
from verify.flows.orbit_search import ExactOrbit
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import coordinate_texts, point_of, start_texts
from verify.prose import Number, Prose, prose
from verify.runs.requested_run import run as run_of
from verify.scenes.results.stability import (
    LargestStepResult,
    MapCell,
    StabilityMapResult,
    StabilityResult,
)
from verify.studies.stability.exact_motion import ExactMotion, exact_motion
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.scheme_interval import linear_stability
from verify.studies.stability.trail import StabilityRun, State
from verify.studies.stability.verdict_on_run import RunJudgement, judge

_FINAL_RATIO = Fraction(1001, 1000)  # bisection ends at this ratio of the two step sizes
# The step sizes tried first are a ladder from an 8th of the linear limit to 8 times that.
_LADDER_RATIO = Fraction(119, 100)  # about 2^(1/4)
_DIVISOR_BELOW, _FACTOR_ABOVE = 8, 8
_MAX_STEPS = 200_000  # below the ladder, step sizes are tried that need no more steps


@lru_cache(maxsize=256)
def linear_limit(scheme: str) -> Fraction | None:
    """Return the stability interval in hω, to 30 digits; None if it has no end or closed form."""
    try:
        stability = linear_stability(scheme)
    except InputError:
        return None
    if stability.interval == sympy.oo:
        return None
    return Fraction(stability.decimal())


def round_to_text(x: Fraction | None, digits: int = 4) -> str | None:
    """Round to so many significant digits, as text; None stays None."""
    return None if x is None else decimal(x, digits)


def run_result(run: StabilityRun) -> StabilityResult:
    """Return the verdict on one run as a result."""
    hamiltonian = run.hamiltonian
    point = dict(zip(hamiltonian.coordinates, run.state, strict=True))
    motion = RunMotion(run)
    judgement = judge(motion)
    return StabilityResult(
        **hamiltonian.texts,
        scheme=run.scheme,
        step_size=text(run.step_size),
        steps=run.steps,
        **start_texts(hamiltonian, point, run.t0 if hamiltonian.time_dependent else None),
        kind=judgement.kind,
        step=judgement.step,
        rate=round_to_text(judgement.rate, 3),
        energy_error=round_to_text(judgement.energy_error, 3),
        exact_orbit=motion.orbit.summary,
        **_theory_fields(motion, judgement),
    )


def _theory_fields(motion: RunMotion, judgement: RunJudgement) -> dict[str, Any]:
    """Return the fields of linear theory; in n degrees the rate at which neighbours part."""
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
    """Return the sentence that compares hω with linear theory, of a scheme that is to blame."""
    if judgement.kind != "unstable: scheme" or limit is None or not h_omega:
        return Prose()
    if limit == 0:
        return prose("; in linear theory it is stable for no step size")
    side = "beyond" if h_omega > limit else "within"
    sizes = Number(plain(h_omega, 3)), Number(plain(limit, 3))
    return prose("; hω = ", sizes[0], f" is {side} its linear limit ", sizes[1])


def _linear_step(scheme: str, omega: Fraction) -> Fraction | None:
    """Return the step size that linear theory allows at this ω; None if it sets no limit."""
    limit = linear_limit(scheme)
    return limit / omega if limit is not None and omega else None


@dataclass(frozen=True)
class _RunsFromState:
    """The exact motion from one state for some time, and the limits that runs from there must keep.

    In n degrees of freedom a bounded motion is followed once, over the whole time, for all runs. A
    run must keep within the motion's bounds, and not exceed `energy_error`, of |H − H(z₀)| relative
    to the orbit's energy scale, or `symplectic_defect`, of the greatest |entry| of W, in the plane
    |Λ|.
    """

    hamiltonian: Hamiltonian
    state: State
    time: Fraction
    t0: Fraction
    energy_error: Fraction | None = None
    symplectic_defect: Fraction | None = None

    @property
    def orbit(self) -> ExactOrbit:
        """The exact motion from the state."""
        return exact_motion(self.hamiltonian, self.state, self.time, self.t0)

    def _motion(self, scheme: str, h: Fraction, steps: int) -> RunMotion:
        run = StabilityRun(self.hamiltonian, scheme, h, self.state, steps, self.t0)
        orbit = self.orbit
        # A plane orbit is cheap and depends on the run's length, so that each run follows its own.
        serves = orbit.has_neighbours and orbit.kind in ("bounded", "driven")
        return RunMotion(run, orbit if serves else None)

    def keeps(self, scheme: str, h: Fraction, steps: int) -> bool:
        """Return True if the float64 run keeps within the bounds and the other limits."""
        motion, most = self._motion(scheme, h, steps), self.energy_error
        if not motion.stays(motion.float64):
            return False
        worst = motion.worst(motion.float64)
        if most is not None and (worst is None or worst > most):
            return False
        return self.symplectic_defect is None or _keeps_form(motion.run, self.symplectic_defect)

    def judge_run(self, scheme: str, h: Fraction, steps: int) -> RunJudgement:
        """Return the verdict on the run."""
        return judge(self._motion(scheme, h, steps))


def _keeps_form(run: StabilityRun, most: Fraction) -> bool:
    hamiltonian, start, name = run.hamiltonian, run.start, run.hamiltonian.structure.of_run
    done = run_of(
        hamiltonian, run.scheme,
        q=coordinate_texts(hamiltonian, start, "q"), p=coordinate_texts(hamiltonian, start, "p"),
        step_size=run.step_size, steps=run.steps, t0=start["t"], observables=(name,),
    )  # fmt: skip
    return name in done.values and abs(done.values[name]) <= most


def largest_step(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    p: NumberOrList,
    q: NumberOrList,
    time: Fraction,
    t0: Fraction | None = None,
    energy_error: Fraction | None = None,
    symplectic_defect: Fraction | None = None,
) -> LargestStepResult:
    """Find the largest h with bounded motion in float64 from (p, q) for the length `time`.

    Unless they are None, the run must also have no greater `energy_error`, relative to the orbit's
    energy scale, and no greater |entry| of W than `symplectic_defect`. If H depends on time the run
    starts at t0.

    Step sizes are tried from small ones upwards until the first that is not bounded, and the gap
    before it is bisected to a thousandth; beyond it there may be other steps with bounded motion,
    by resonance, which are not looked for. In the result `bounded` and `unbounded` are the two ends
    of the gap, `linear` is the step size of linear theory, and `detail` says why an end is missing.
    """
    point, begin = point_of(hamiltonian, q, p), t0 or Fraction(0)
    state = tuple(point.values())
    runs = _RunsFromState(hamiltonian, state, time, begin, energy_error, symplectic_defect)
    orbit = runs.orbit
    omega = orbit.frequency
    linear = _linear_step(scheme, omega)
    good = bad = None

    def stays(h: Fraction) -> bool:
        steps = time // h
        return steps >= 1 and runs.keeps(scheme, h, steps)

    if orbit.kind == "escapes":
        detail = prose("the exact solution ", orbit.summary)
    elif orbit.kind == "not followed":
        detail = prose("the exact solution, to be held against, is not known: ", orbit.summary)
    else:
        # The linear limit is the best guess; without one, a step of one radian of the fastest
        # oscillation, or a hundredth of the time.
        middle = linear or (1 / omega if omega else time / 100)
        good, bad = _find_bracket(stays, min(middle, time / 2), time)
        outcome = "bounded with every" if bad is None else "not bounded with any"
        detail = Prose() if good and bad else prose(f"{outcome} step size looked at")
    # Bisection on rounded step sizes, so that the result is printed exactly as it was tested.
    while good and bad and bad / good > _FINAL_RATIO:
        middle = _round_step((good + bad) / 2)
        good, bad = (middle, bad) if stays(middle) else (good, middle)
    return LargestStepResult(
        **hamiltonian.texts,
        scheme=scheme,
        time=text(time),
        **start_texts(hamiltonian, point, t0),
        bounded=round_to_text(good),
        unbounded=round_to_text(bad),
        linear=round_to_text(linear),
        h_omega=round_to_text(good * omega) if good else None,
        energy_error=None if energy_error is None else text(energy_error),
        symplectic_defect=None if symplectic_defect is None else text(symplectic_defect),
        exact_orbit=orbit.summary,
        detail=detail,
    )


def _find_bracket(
    stays: Callable[[Fraction], bool], middle: Fraction, time: Fraction
) -> tuple[Fraction | None, Fraction | None]:
    """Return a step size with bounded motion and the next one tried, without; None for either."""
    # From small steps upwards: beyond the limit a resonance may have bounded motion again.
    h = _round_step(middle / _DIVISOR_BELOW)
    if not stays(h):
        bad = h
        # Even the smallest step leaves the bounds: halve it, as long as a run is affordable.
        while time / h <= _MAX_STEPS:
            h = _round_step(h / 2)
            if stays(h):
                return h, bad
            bad = h
        return None, bad
    good = h
    while h < min(middle * _FACTOR_ABOVE, time):
        h = _round_step(h * _LADDER_RATIO)
        if not stays(h):
            return good, h
        good = h
    return good, None


def _round_step(h: Fraction) -> Fraction:
    """Round h to six digits."""
    return Fraction(decimal(h, 6))


def stability_map(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    parameter: str,
    values: Sequence[Fraction],
    step_sizes: Sequence[Fraction],
    steps: int,
    p: NumberOrList,
    q: NumberOrList,
    t0: Fraction | None = None,
) -> StabilityMapResult:
    """Return the verdicts on the runs of `steps` steps from (p, q), over a parameter and h.

    There is a row for each of the parameter's `values`, a cell in it for each of `step_sizes`; with
    each row comes the step size that linear theory allows, None if it sets no limit. Other
    parameters keep their values in `hamiltonian`. Where H depends on time the runs start at t0.
    """
    cells, linear, begin = [], [], t0 or Fraction(0)
    point = point_of(hamiltonian, q, p)
    for value in values:
        with_value = hamiltonian.with_values({**dict(hamiltonian.values), parameter: value})
        runs = _RunsFromState(with_value, tuple(point.values()), max(step_sizes) * steps, begin)
        row = (runs.judge_run(scheme, h, steps) for h in step_sizes)
        cells.append(tuple(MapCell(kind=judgement.kind, step=judgement.step) for judgement in row))
        linear.append(round_to_text(_linear_step(scheme, runs.orbit.frequency)))
    return StabilityMapResult(
        **hamiltonian.texts,
        scheme=scheme,
        parameter=parameter,
        values=tuple(map(text, values)),
        step_sizes=tuple(map(text, step_sizes)),
        steps=steps,
        **start_texts(hamiltonian, point, t0),
        cells=tuple(cells),
        linear=tuple(linear),
    )
