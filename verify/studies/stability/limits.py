"""How far a scheme can be pushed: the largest step with bounded motion, and the (h, stiffness) map.

Linear theory says of a step size h that h ω has to lie in the scheme's interval (see
`verify.studies.stability.linear`), ω being the greatest frequency on the exact orbit, where that is
stiffest. What bounded motion is, is told in
`verify.studies.stability.run_motion` and `verify.studies.stability.verdict_on_run`.
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
from verify.studies.stability.verdict_on_run import Judgement, judge

_FINER = Fraction(1001, 1000)  # how near the largest step is found
_LADDER = Fraction(119, 100)  # about 2^(1/4), between the step sizes that are looked at first
_BELOW, _ABOVE = 8, 8  # they range from so many times below the linear limit to so many above
_MOST_STEPS = 200_000  # of the smallest step that is looked at


@lru_cache(maxsize=256)
def linear_limit(scheme: str) -> Fraction | None:
    """The stability interval in hω, to 30 digits; None where it has no end or is not known."""
    try:
        found = linear_stability(scheme)
    except InputError:
        return None
    if found.interval == sympy.oo:
        return None
    return Fraction(found.decimal())


def _linear_step(scheme: str, omega: Fraction) -> Fraction | None:
    """The step size that linear theory allows at this ω; None where it does not say."""
    limit = linear_limit(scheme)
    return limit / omega if limit is not None and omega else None


def shortened(x: Fraction | None, digits: int = 4) -> str | None:
    """To so many significant digits, as results show what may not be known."""
    return None if x is None else decimal(x, digits)


@dataclass(frozen=True)
class _Held:
    """The exact motion from one state for some time, and what is asked of runs from there.

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
        serves = exact.has_neighbours and exact.kind in ("bounded", "driven")
        return RunMotion(run, exact if serves else None)

    def keeps(self, scheme: str, h: Fraction, steps: int) -> bool:
        """Whether the float64 run keeps within the bounds, and within what is asked beside them."""
        motion, most = self._motion(scheme, h, steps), self.energy_error
        if not motion.stays(motion.float64):
            return False
        worst = motion.worst(motion.float64)
        if most is not None and (worst is None or worst > most):
            return False
        return self.symplectic_defect is None or _keeps_form(motion.run, self.symplectic_defect)

    def judged(self, scheme: str, h: Fraction, steps: int) -> Judgement:
        """The verdict on the run."""
        return judge(self._motion(scheme, h, steps))


def _keeps_form(run: Run, most: Fraction) -> bool:
    of, start, name = run.hamiltonian, run.start, run.hamiltonian.structure.of_run
    done = run_of(
        of, run.scheme, q=shown_of(of, start, "q"), p=shown_of(of, start, "p"),
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
    """The largest h with bounded motion in float64 from (p, q) for the length `time`, by bisection;
    and, where these are given, with no greater energy error, in parts of the orbit's energy scale,
    and no greater |entry| of W.

    From small steps upwards until the first that is not bounded; beyond it there may be other
    steps with bounded motion, by resonance, which are not looked for.
    """
    point, begin = point_of(hamiltonian, q, p), t0 or Fraction(0)
    state = tuple(point.values())
    of = _Held(hamiltonian, state, time, begin, energy_error, symplectic_defect)
    orbit = of.exact
    omega = orbit.frequency
    linear = _linear_step(scheme, omega)
    good = bad = None

    def stays(h: Fraction) -> bool:
        steps = time // h
        return steps >= 1 and of.keeps(scheme, h, steps)

    if orbit.kind == "escapes":
        detail = prose("the exact solution ", orbit.summary)
    elif orbit.kind == "not followed":
        detail = prose("the exact solution, to be held against, is not known: ", orbit.summary)
    else:
        middle = linear or (1 / omega if omega else time / 100)
        good, bad = _bracket(stays, min(middle, time / 2), time)
        which = "bounded with every" if bad is None else "not bounded with any"
        detail = Prose() if good and bad else prose(f"{which} step size looked at")
    while good and bad and bad / good > _FINER:
        middle = _short((good + bad) / 2)
        good, bad = (middle, bad) if stays(middle) else (good, middle)
    return LargestStepResult(
        **hamiltonian.texts,
        scheme=scheme,
        time=text(time),
        **start_texts(hamiltonian, point, t0),
        bounded=shortened(good),
        unbounded=shortened(bad),
        linear=shortened(linear),
        h_omega=shortened(good * omega) if good else None,
        energy_error=None if energy_error is None else text(energy_error),
        symplectic_defect=None if symplectic_defect is None else text(symplectic_defect),
        exact_orbit=orbit.summary,
        detail=detail,
    )


def _bracket(
    stays: Callable[[Fraction], bool], middle: Fraction, time: Fraction
) -> tuple[Fraction | None, Fraction | None]:
    """A step size with bounded motion and the next one without, where there are such."""
    h = _short(middle / _BELOW)
    if not stays(h):
        bad = h
        while time / h <= _MOST_STEPS:
            h = _short(h / 2)
            if stays(h):
                return h, bad
            bad = h
        return None, bad
    good = h
    while h < min(middle * _ABOVE, time):
        h = _short(h * _LADDER)
        if not stays(h):
            return good, h
        good = h
    return good, None


def _short(h: Fraction) -> Fraction:
    """h to six digits."""
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
    """For each value of the parameter, a row: the verdicts with each step size, and the step size
    of linear theory.
    """
    cells, linear, begin = [], [], t0 or Fraction(0)
    point = point_of(hamiltonian, q, p)
    for value in values:
        own = hamiltonian.with_values({**dict(hamiltonian.values), parameter: value})
        of = _Held(own, tuple(point.values()), max(step_sizes) * steps, begin)
        row = (of.judged(scheme, h, steps) for h in step_sizes)
        cells.append(tuple(MapCell(kind=found.kind, step=found.step) for found in row))
        linear.append(shortened(_linear_step(scheme, of.exact.frequency)))
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
