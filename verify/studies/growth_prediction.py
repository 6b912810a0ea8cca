"""The growth law of Λ compared with runs: ⟨g⟩ of an orbit, and each run's Λ as the law predicts it.

The law predicts S = log(1 + Λ) up to the remainder that `verify.proof.plane.growth_law` states,
and Λ = e^S − 1. The bounds printed are of the prediction's own numbers, not of that remainder. [B]
is taken on the orbit of z₀, at the point nearest to z_N: that changes it by O(H(z_N) − H(z₀)),
which is O(h^η T), and the prediction by less than the remainder.
"""

import time
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

from verify.algebra.enclosure import enclose_over
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic import arb
from verify.arithmetic.exact import Number, rational, text, whole
from verify.flows.closed_orbit import Start
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit_average import MOST_DIGITS, Average, average, bounded_part
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane.growth_law import Element, GrowthLaw, NoLawError, growth_law
from verify.prose import Prose
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.growth import AverageResult, PredictionResult
from verify.scenes.results.run import RunResult

ENCLOSED = "ball arithmetic at the equilibrium"
ESTIMATED = "computed again with ten digits more and other points"
_SHOWN = 17  # digits of a prediction
_PHASE_DIGITS = 15  # of the orbit on which a run's end point is placed
_ROUNDED = Fraction(1, 10**10)  # of the bounded part, which is summed in float64


def compute_average(
    hamiltonian: Hamiltonian, scheme: str, *, q: Number, p: Number, digits: int
) -> AverageResult:
    """Compute ⟨g⟩ of the scheme's growth law along the exact orbit through (q, p).

    Where there is no law, or no closed orbit is found, `orbit` is "undecided" and `reason` says
    why. Raises InputError for a parameter without a value, and for digits beyond 200.
    """
    start_time = time.perf_counter()
    whole("digits", digits, 1, MOST_DIGITS)
    start = rational(p, "p"), rational(q, "q")
    law: GrowthLaw | None = None
    orbit_average: Average | None = None
    reason = Prose()
    try:
        law = growth_law(hamiltonian, scheme)
        orbit_average = average(hamiltonian, law.g, start, digits)
    except (NoLawError, NoFlowError) as error:
        reason = error.reason
    period = orbit_average.period if orbit_average else None
    potential = (law.potential or law.telescoping.element) if law else None
    at_rest = orbit_average is not None and period is None
    return AverageResult(
        **hamiltonian.texts,
        scheme=scheme,
        digits=digits,
        q=text(start[1]),
        p=text(start[0]),
        power=law.power if law else 0,
        g=_format_element(law.g) if law else "",
        potential=_format_element(potential) if potential else "",
        telescopes=law.telescoping.holds if law else None,
        by_potential=law is not None and law.potential is not None,
        orbit=orbit_average.orbit.kind if orbit_average else "undecided",
        reason=reason,
        average=Value.from_bound(orbit_average.value, orbit_average.bound, digits)
        if orbit_average
        else None,
        period=Value.from_bound(*period, digits) if period else None,
        error_kind="enclosed" if at_rest else "estimated",
        error_method=ENCLOSED if at_rest else ESTIMATED,
        seconds=time.perf_counter() - start_time,
    )


def predict_runs(
    hamiltonian: Hamiltonian, average_result: AverageResult, runs: Sequence[RunResult]
) -> tuple[PredictionResult, ...]:
    """Predict Λ of each run from the initial value of `average_result`.

    Runs that give no p, q or Λ, too few digits of p and q for G, or a Λ beyond any range are left
    out; and all of them where ⟨g⟩ is not known.
    """
    complete_runs = [run for run in runs if {"lambda", "p", "q"} <= set(run.values)]
    if average_result.average is None or not complete_runs:
        return ()
    law = growth_law(hamiltonian, average_result.scheme)
    orbit_average = _place_orbit(
        hamiltonian, average_result.scheme, (Fraction(average_result.p), Fraction(average_result.q))
    )
    oscillation, number = bounded_part(orbit_average), orbit_average.orbit.flow.number
    results = []
    for run in complete_runs:
        end = number(Fraction(run.values["p"].value)), number(Fraction(run.values["q"].value))
        with arb.precision():
            results.append(_predict(law, average_result.average, run, Fraction(oscillation(end))))
    return tuple(prediction for prediction in results if prediction)


@lru_cache(maxsize=16)
def _place_orbit(hamiltonian: Hamiltonian, scheme: str, start: Start) -> Average:
    # A scene's page needs its orbit, and so does each claim about it.
    return average(hamiltonian, growth_law(hamiltonian, scheme).g, start, _PHASE_DIGITS)


def _predict(
    law: GrowthLaw, mean: Value, run: RunResult, oscillation: Fraction
) -> PredictionResult | None:
    h, measured_lambda = arb.rational_ball(Fraction(run.step_size)), arb.ball(run.values["lambda"])
    secular = h ** (law.power + 1) * run.steps * arb.ball(mean)
    # S is h^r times the bounded part along the orbit, and h^(r+1) N ⟨g⟩, the secular one.
    boundary = h**law.power * arb.make_ball(oscillation, abs(oscillation) * _ROUNDED)
    if law.potential and law.leading:
        boundary += h ** (law.power - 1) * _difference_along(law.potential, run)
        boundary -= h**law.power * _difference_along(law.leading, run) / 2
    # Λ = e^S − 1.
    prediction = (boundary + secular).expm1()
    if not arb.is_representable(prediction):
        return None
    relative_difference = (prediction - measured_lambda) / abs(measured_lambda)
    return PredictionResult(
        step_size=run.step_size,
        steps=run.steps,
        boundary=_value(boundary),
        secular=_value(secular),
        predicted=_value(prediction),
        measured=run.values["lambda"],
        difference=_value(relative_difference)
        if arb.is_representable(relative_difference)
        else None,
    )


def _difference_along(f: Element, run: RunResult) -> arb.Ball:
    """Return [f] = f(z_N) − f(z₀), not finite where f may be undefined."""
    ring, x = f
    q, p = map(Fraction, run.plane_start)
    ends = (
        {name: arb.ball(run.values[name]) for name in ("p", "q")},
        {"p": arb.rational_ball(p), "q": arb.rational_ball(q)},
    )
    last, first = (enclose_over(ring, x, end) for end in ends)
    return arb.UNKNOWN if last is None or first is None else last - first


def _value(x: arb.Ball) -> Value:
    return Value.from_bound(*arb.midpoint_and_radius(x), _SHOWN)


def _format_element(x: Element) -> str:
    ring, element = x
    return to_text(ring.as_product(element))
