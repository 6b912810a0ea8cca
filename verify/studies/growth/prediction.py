"""The growth law of Λ held against runs: ⟨g⟩ of an orbit, and Λ of each run as it predicts it.

What is predicted is S = log(1 + Λ) up to the remainder that `verify.proof.plane.growth_law` states,
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
from verify.arithmetic.arb import (
    UNKNOWN,
    Ball,
    around,
    ball,
    in_reach,
    middle_and_radius,
    precision,
    rational_ball,
)
from verify.arithmetic.exact import Exact, rational, text, whole
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


def average_of(
    hamiltonian: Hamiltonian, scheme: str, *, q: Exact, p: Exact, digits: int
) -> AverageResult:
    """⟨g⟩ of the scheme's growth law along the exact orbit through (q, p), to so many digits.

    Where there is no law, or no closed orbit is found, `orbit` is "undecided" and `reason` says
    why. Raises InputError for a parameter without a value, and for digits beyond 200.
    """
    begun = time.perf_counter()
    whole("digits", digits, 1, MOST_DIGITS)
    start = rational(p, "p"), rational(q, "q")
    law: GrowthLaw | None = None
    found: Average | None = None
    reason = Prose()
    try:
        law = growth_law(hamiltonian, scheme)
        found = average(hamiltonian, law.g, start, digits)
    except (NoLawError, NoFlowError) as error:
        reason = error.said
    period = found.period if found else None
    potential = (law.potential or law.telescoping.element) if law else None
    at_rest = found is not None and period is None
    return AverageResult(
        **hamiltonian.texts,
        scheme=scheme,
        digits=digits,
        q=text(start[1]),
        p=text(start[0]),
        power=law.power if law else 0,
        g=_shown(law.g) if law else "",
        potential=_shown(potential) if potential else "",
        telescopes=law.telescoping.holds if law else None,
        by_potential=law is not None and law.potential is not None,
        orbit=found.orbit.kind if found else "undecided",
        reason=reason,
        average=Value.of(found.value, found.bound, digits) if found else None,
        period=Value.of(*period, digits) if period else None,
        error_kind="enclosed" if at_rest else "estimated",
        error_method=ENCLOSED if at_rest else ESTIMATED,
        seconds=time.perf_counter() - begun,
    )


def predictions(
    hamiltonian: Hamiltonian, of: AverageResult, runs: Sequence[RunResult]
) -> tuple[PredictionResult, ...]:
    """Λ of each run from the initial value of `of`, as predicted.

    Left out are runs that give no p, q or Λ, or too little of p and q for G, or a Λ beyond any
    range; and all of them where ⟨g⟩ is not known.
    """
    finished = [run for run in runs if {"lambda", "p", "q"} <= set(run.values)]
    if of.average is None or not finished:
        return ()
    law = growth_law(hamiltonian, of.scheme)
    placed = _placing(hamiltonian, of.scheme, (Fraction(of.p), Fraction(of.q)))
    oscillation, number = bounded_part(placed), placed.orbit.flow.number
    found = []
    for run in finished:
        end = number(Fraction(run.values["p"].value)), number(Fraction(run.values["q"].value))
        with precision():
            found.append(_prediction(law, of.average, run, Fraction(oscillation(end))))
    return tuple(each for each in found if each)


@lru_cache(maxsize=16)
def _placing(hamiltonian: Hamiltonian, scheme: str, start: Start) -> Average:
    # The orbit of a scene is asked for by its page, and by each claim that is made of it.
    return average(hamiltonian, growth_law(hamiltonian, scheme).g, start, _PHASE_DIGITS)


def _prediction(
    law: GrowthLaw, mean: Value, run: RunResult, oscillation: Fraction
) -> PredictionResult | None:
    h, measured = rational_ball(Fraction(run.step_size)), ball(run.values["lambda"])
    secular = h ** (law.power + 1) * run.steps * ball(mean)
    boundary = h**law.power * around(oscillation, abs(oscillation) * _ROUNDED)
    if law.potential and law.leading:
        boundary += h ** (law.power - 1) * _between(law.potential, run)
        boundary -= h**law.power * _between(law.leading, run) / 2
    predicted = (boundary + secular).expm1()
    if not in_reach(predicted):
        return None
    gap = (predicted - measured) / abs(measured)
    return PredictionResult(
        step_size=run.step_size,
        steps=run.steps,
        boundary=_value(boundary),
        secular=_value(secular),
        predicted=_value(predicted),
        measured=run.values["lambda"],
        difference=_value(gap) if in_reach(gap) else None,
    )


def _between(f: Element, run: RunResult) -> Ball:
    """[f] = f(z_N) − f(z₀), not finite where f may be undefined."""
    ring, x = f
    q, p = map(Fraction, run.plane_start)
    ends = (
        {name: ball(run.values[name]) for name in ("p", "q")},
        {"p": rational_ball(p), "q": rational_ball(q)},
    )
    last, first = (enclose_over(ring, x, end) for end in ends)
    return UNKNOWN if last is None or first is None else last - first


def _value(x: Ball) -> Value:
    return Value.of(*middle_and_radius(x), _SHOWN)


def _shown(x: Element) -> str:
    ring, element = x
    return to_text(ring.factored(element))
