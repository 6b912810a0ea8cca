"""The finding on a step in floats, by the probe of `verify check-integrator`."""

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

from verify.audits.methods.driver import POINTS
from verify.audits.methods.integrator import NOT_CLAIMED, FloatStep
from verify.errors import InputError
from verify.integrators.clocks import measure_clock_mistakes
from verify.integrators.measured_finding import finding_from_measurement
from verify.integrators.measures.distances import Distances
from verify.integrators.measures.float_probe import FloatProbe
from verify.integrators.measures.survey import NO_REQUEST, places_of_field
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.units import FloatField
from verify.integrators.results import Finding
from verify.integrators.trial import Trial
from verify.integrators.user_code.faults import find_faults
from verify.integrators.user_code.loading import callee_from
from verify.integrators.user_code.step import StepError, last_line
from verify.prose import Prose, join_prose, prose, read_prose
from verify.schemes.printed.sentences import Ruling
from verify.verdict import Verdict

# A library may raise anything, and leave the program too.
FAILURES = (Exception, SystemExit)
_STEP_SECONDS = 60.0
# A power counts if it is seen on a stretch whose largest step size is the smallest times this.
_MIN_STRETCH_RATIO = 1.9


def _mark_undecided(finding: Finding, first: float, last: float) -> Finding:
    """Return the finding without its order, which is seen on too short a stretch of step sizes."""
    text = f"a power of h is seen from h = `{first:.2g}` to `{last:.2g}` only, too short a stretch"
    reason = prose(read_prose(text), "; ", finding.reason.partition("; ")[2])
    return replace(
        finding, verdict=Verdict.UNDECIDED, reason=reason, convergence_order=None,
        order_decided=False,
    )  # fmt: skip


def _choose_places(method: FloatStep) -> list[TrialPlace]:
    """Return the method's own places, or else those that fit its H; the largest step size is 1."""
    hamiltonian = method.hamiltonian
    usual = places_of_field(FloatField(hamiltonian), hamiltonian.time_dependent, NO_REQUEST)
    points = method.points or (POINTS if hamiltonian.degrees == 1 else ())
    if not points:
        return [replace(x, step=Fraction(1)) for x in usual[:6]]
    places = []
    for z in points:
        t = (1 + 2 * z[0] + z[1]) / 4 if hamiltonian.time_dependent else Fraction(0)
        places.append(replace(usual[0], z=tuple(z), t=t, step=Fraction(1)))
    return places


@lru_cache(maxsize=256)
def finding(method: FloatStep) -> Finding:
    """Measure the order of a step, and its area defect.

    The finding is UNDECIDED, with the reason, if it cannot be measured.
    """
    hamiltonian = method.hamiltonian
    time_dependent = hamiltonian.time_dependent
    try:
        callee = callee_from(
            method.make(), hamiltonian.coordinates, time_limit=_STEP_SECONDS,
            arguments="p,q,t,h" if time_dependent else "p,q,h",
        )  # fmt: skip
        step = callee.step
        step.time_dependent = time_dependent
        step.foreign = True  # libraries take floats alone
        trial = Trial(step, hamiltonian, _choose_places(method))
        faults, first = find_faults(step, trial.places)
        fatal = next((fault for fault in faults if fault.fatal), None)
        if fatal is not None:
            return Finding(fatal.allows, prose(fatal.text), "calls")
        if not first:
            step.evaluate([float(x) for x in trial.places[0].z], 0.125, float(trial.places[0].t))
        structure, distances = trial.measure("floats", [1 / h for h in method.ladder])
        assert distances is not None  # noqa: S101 - there is an H
        result = finding_from_measurement(trial, structure, distances)
        run = _longest_stretch(distances, result.convergence_order)
        # Between the ranges of two powers of h a third may be seen: only a long stretch counts.
        if run is not None and run[0] < _MIN_STRETCH_RATIO * run[1]:
            return _mark_undecided(result, *run)
        mistakes = []
        if time_dependent and hamiltonian.degrees == 1:
            order = result.convergence_order
            mistakes = measure_clock_mistakes(FloatProbe(step), hamiltonian, trial.places, order)
        return replace(result, reason=join_prose("; ", (result.reason, *mistakes)))
    except FAILURES as error:
        problem = error.clause if isinstance(error, StepError) else last_line(error)
        if isinstance(error, InputError):
            problem = str(error)
        return Finding(Verdict.UNDECIDED, prose("it cannot be measured: ", problem), "calls")


def _longest_stretch(distances: Distances, order: int | None) -> tuple[float, float] | None:
    """Return the largest and the smallest step size of the longest stretch that shows the order;
    None if there is none."""
    runs = [x.run for x in distances.places if x.run is not None and x.power == (order or 0) + 1]
    if order is None or not runs:
        return None
    longest = max(runs, key=lambda run: run.first / run.last)
    return longest.first, longest.last


# -- verdicts on what is claimed ------------------------------------------------------------------


def judge_measured_order(claimed: int, measured: Finding, area_claimed: bool | None) -> Ruling:
    """Judge a measured order against the claimed one; an undecided order refutes nothing."""
    order, is_decided = measured.convergence_order, measured.order_decided
    remark = ""
    if area_claimed is None and measured.area_preserving is False:
        remark = f". {NOT_CLAIMED}, and area is not preserved"
    notes = join_prose("", (prose(". ", _capital(note)) for note in measured.notes[:1]))
    if is_decided and (order is None or order >= claimed):
        return Verdict.MEASURED, prose(measured.reason, remark, notes), ()
    # With an order below 1 it would be no scheme. It is more likely that we drive the library
    # wrongly, so that nothing is refuted.
    if is_decided and order is not None and order < 1:
        prefix = "nothing of H's flow is seen in it, as where it is driven in a wrong way; "
        return Verdict.UNDECIDED, prose(prefix, measured.reason), ()
    if is_decided and order is not None:
        return Verdict.REFUTED, prose(measured.reason, notes), ()
    return Verdict.UNDECIDED, prose(measured.reason, notes), ()


def report_unclaimed(measured: Finding) -> Ruling:
    """Report a measurement for which nothing is claimed: it refutes nothing."""
    verdict = Verdict.MEASURED if measured.order_decided else Verdict.UNDECIDED
    return verdict, measured.reason, ()


def _capital(note: Prose) -> Prose:
    """Return the note with a capital, if it begins with a text."""
    first, *further_parts = note.parts
    return prose(f"{first[0].upper()}{first[1:]}" if type(first) is str else first, *further_parts)


def judge_measured_area(measured: Finding) -> Ruling:
    """Refute for an area defect above the probe's own error; if none is seen, return MEASURED."""
    error = "unknown" if measured.probe_error is None else f"`{measured.probe_error:.1e}`"
    if measured.area_preserving:
        return Verdict.MEASURED, read_prose(f"no area defect above the probe's error {error}"), ()
    if measured.area_preserving is False and measured.largest is not None:
        text = f"|det J − 1| is up to `{measured.largest:.3g}`, where the probe's error is {error}"
        return Verdict.REFUTED, prose(read_prose(text), "; ", measured.reason), ()
    return Verdict.UNDECIDED, measured.reason, ()
