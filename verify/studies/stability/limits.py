"""How far a scheme can be pushed: the largest step with bounded motion, and the (h, stiffness) map.

Linear theory says of a step size h that h ω has to lie in the scheme's interval (see
`verify.studies.stability.linear`), ω being the greatest frequency on the exact orbit, where that is
stiffest. What bounded motion is, is told in
`verify.studies.stability.run_motion` and `verify.studies.stability.verdict_on_run`.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache

import sympy

from verify.arithmetic.exact import decimal, text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of, shown_of
from verify.prose import Prose, prose
from verify.scenes.results.stability import LargestStepResult, MapCell, StabilityMapResult
from verify.studies.stability.held import Within, held
from verify.studies.stability.nearby_linear import linear_stability

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
    point, within = point_of(hamiltonian, q, p), Within(energy_error, symplectic_defect)
    of = held(hamiltonian, point, time, t0 or Fraction(0))
    orbit = of.exact
    omega = orbit.frequency
    linear = _linear_step(scheme, omega)
    good = bad = None

    def stays(h: Fraction) -> bool:
        steps = time // h
        return steps >= 1 and of.keeps(scheme, h, steps, within)

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
        q=shown_of(hamiltonian, point, "q"),
        p=shown_of(hamiltonian, point, "p"),
        t0=None if t0 is None else text(t0),
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
        of = held(own, point, max(step_sizes) * steps, begin)
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
        q=shown_of(hamiltonian, point, "q"),
        p=shown_of(hamiltonian, point, "p"),
        t0=None if t0 is None else text(t0),
        cells=tuple(cells),
        linear=tuple(linear),
    )
