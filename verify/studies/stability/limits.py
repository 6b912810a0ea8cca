"""The limits of a scheme: its largest step with bounded motion, and its (h, stiffness) map.

Linear theory requires of a step size h that h ω lies in the scheme's interval (see
`verify.studies.stability.linear`), ω being the greatest frequency on the exact orbit, where that is
stiffest. Bounded motion is defined in `verify.studies.stability.run_motion` and
`verify.studies.stability.verdict_on_run`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import sympy

from verify.arithmetic.exact import decimal, text
from verify.errors import InputError
from verify.flows.orbit_search import ExactOrbit
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of, shown_of, start_texts
from verify.prose import Prose, prose
from verify.runs.run import run as run_of
from verify.scenes.results.stability import LargestStepResult, MapCell, StabilityMapResult
from verify.studies.stability.exact_motion import exact_motion
from verify.studies.stability.nearby_linear import linear_stability
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import Run, State
from verify.studies.stability.verdict_on_run import RunJudgement, judge

_FINER = Fraction(1001, 1000)  # how near the largest step is found
_LADDER = Fraction(119, 100)  # about 2^(1/4), the ratio of the step sizes that are tried first
_BELOW, _ABOVE = 8, 8  # they range from so many times below the linear limit to so many above
_MOST_STEPS = 200_000  # of the smallest step size that is tried


@lru_cache(maxsize=256)
def linear_limit(scheme: str) -> Fraction | None:
    """Return the stability interval in hω, to 30 digits.

    None where it has no end or no closed form.
    """
    try:
        stability = linear_stability(scheme)
    except InputError:
        return None
    if stability.interval == sympy.oo:
        return None
    return Fraction(stability.decimal())


def _linear_step(scheme: str, omega: Fraction) -> Fraction | None:
    """Return the step size that linear theory allows at this ω; None where it sets no limit."""
    limit = linear_limit(scheme)
    return limit / omega if limit is not None and omega else None


def round_to_text(x: Fraction | None, digits: int = 4) -> str | None:
    """Round to so many significant digits, as text; None stays None."""
    return None if x is None else decimal(x, digits)


@dataclass(frozen=True)
class _RunsFromState:
    """The exact motion from one state for some time, and the limits that runs from there must keep.

    In n degrees of freedom a bounded motion is followed once, over the whole time, for all runs.
    What a run must not exceed beside the motion's bounds: |H − H(z₀)| in parts of the orbit's
    energy scale, and the greatest |entry| of W, which in the plane is |Λ|.
    """

    hamiltonian: Hamiltonian
    state: State
    time: Fraction
    t0: Fraction
    energy_error: Fraction | None = None
    symplectic_defect: Fraction | None = None

    @property
    def exact(self) -> ExactOrbit:
        return exact_motion(self.hamiltonian, self.state, self.time, self.t0)

    def _motion(self, scheme: str, h: Fraction, steps: int) -> RunMotion:
        run, exact = Run(self.hamiltonian, scheme, h, self.state, steps, self.t0), self.exact
        # A plane orbit is cheap and depends on the run's length, so that each run follows its own.
        serves = exact.has_neighbours and exact.kind in ("bounded", "driven")
        return RunMotion(run, exact if serves else None)

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


def _keeps_form(run: Run, most: Fraction) -> bool:
    hamiltonian, start, name = run.hamiltonian, run.start, run.hamiltonian.structure.of_run
    done = run_of(
        hamiltonian, run.scheme,
        q=shown_of(hamiltonian, start, "q"), p=shown_of(hamiltonian, start, "p"),
        step_size=run.step_size, steps=run.steps, t0=start["t"], observables=(name,),
    )  # fmt: skip
    return name in done.values and abs(done.values[name]) <= most


def largest_step(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    p: Given,
    q: Given,
    time: Fraction,
    t0: Fraction | None = None,
    energy_error: Fraction | None = None,
    symplectic_defect: Fraction | None = None,
) -> LargestStepResult:
    """Find the largest h with bounded motion in float64 from (p, q) for the length `time`.

    Where they are given, the run must also have no greater energy error, in parts of the orbit's
    energy scale, and no greater |entry| of W. The step is found by bisection.

    From small steps upwards until the first that is not bounded; beyond it there may be other
    steps with bounded motion, by resonance, which are not looked for.
    """
    point, begin = point_of(hamiltonian, q, p), t0 or Fraction(0)
    state = tuple(point.values())
    runs = _RunsFromState(hamiltonian, state, time, begin, energy_error, symplectic_defect)
    orbit = runs.exact
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
        which = "bounded with every" if bad is None else "not bounded with any"
        detail = Prose() if good and bad else prose(f"{which} step size looked at")
    # Bisection on rounded step sizes, so that the result is printed exactly as it was tested.
    while good and bad and bad / good > _FINER:
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
    """Return a step size with bounded motion and the next one without, where there are such."""
    # From small steps upwards: beyond the limit a resonance may be bounded again, and is not looked
    # for.
    h = _round_step(middle / _BELOW)
    if not stays(h):
        bad = h
        # Even the smallest step leaves the bounds: halve it, as long as a run is affordable.
        while time / h <= _MOST_STEPS:
            h = _round_step(h / 2)
            if stays(h):
                return h, bad
            bad = h
        return None, bad
    good = h
    while h < min(middle * _ABOVE, time):
        h = _round_step(h * _LADDER)
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
    p: Given,
    q: Given,
    t0: Fraction | None = None,
) -> StabilityMapResult:
    """Return verdicts for each value of the parameter, with the step size of linear theory."""
    cells, linear, begin = [], [], t0 or Fraction(0)
    point = point_of(hamiltonian, q, p)
    for value in values:
        with_value = hamiltonian.with_values({**dict(hamiltonian.values), parameter: value})
        runs = _RunsFromState(with_value, tuple(point.values()), max(step_sizes) * steps, begin)
        row = (runs.judge_run(scheme, h, steps) for h in step_sizes)
        cells.append(tuple(MapCell(kind=judgement.kind, step=judgement.step) for judgement in row))
        linear.append(round_to_text(_linear_step(scheme, runs.exact.frequency)))
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
