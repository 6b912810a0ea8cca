"""The decision if a user's step is a scheme for H, and if a step or a map preserves Ω: by a proof,
else by measurement.

Every answer is reached in the same way: the layout of the function, the places that fit its
Hamiltonian or the map, a trace and a proof where its code lets symbols through, else readings at
the places.

The layout in which a user's function takes its state is found by trial: each is compared with the
exact flow. Where names do not tell p from q, or h from t, the order that fits H is taken, and a
note says so. A function that takes its state in no layout is no step: that is an error of the call,
and nothing is refuted.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.examination import examine
from verify.integrators.measured_finding import finding_of
from verify.integrators.measures.measurement_notes import masses_of, note_digits, note_masses
from verify.integrators.measures.survey import (
    NOWHERE,
    Request,
    check_request,
    places_of_field,
    places_of_map,
    shorten_steps,
    unit_of_map,
)
from verify.integrators.places.trial_places import USER, TrialPlace
from verify.integrators.places.units import FloatField
from verify.integrators.results import NOTHING, Claims, Finding
from verify.integrators.trial import Trial, counterexample, counterexample_of_reading, with_claims
from verify.integrators.user_code.faults import Fault, find_changes, find_faults
from verify.integrators.user_code.layout import CallLayout
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repetition import find_repetition_faults
from verify.integrators.user_code.step import StepError, last_line, unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.prose import prose
from verify.verdict import Verdict

_PART = 64  # of the largest step size
_FITS = 0.2  # of the way that the flow goes
_BETTER = 10  # times as near, another layout has to be


def settle_layout(
    callee: Callee, places: Sequence[TrialPlace], field: FloatField | None
) -> list[str]:
    """Sets the layout, and returns notes on how the arguments are understood.

    Raises InputError where no call returns a state.
    """
    step, lost = callee.step, list[Exception]()
    # The misfit of each layout in which a call returns a state, at the first place where one does.
    misfits = dict[CallLayout, float]()
    for layout in callee.layouts:
        step.layout = layout
        for place in places[:3]:
            try:
                misfits[layout] = _measure_misfit(step, place, field)
                break
            except Exception as error:  # the user's code may raise anything
                lost.append(error)
            if step.left <= 0:
                break
        # Without an H nothing tells the layouts apart, and the first one that works is taken.
        if misfits and field is None:
            break
    if not misfits:
        step.layout = callee.layouts[0]
        raise no_state(step, lost[0], places[0])
    first, best = next(iter(misfits)), min(misfits, key=lambda layout: misfits[layout])
    # Another layout replaces the likeliest only where it fits, and fits far better: a bad scheme
    # must not be mistaken for one with its arguments exchanged.
    fits = misfits[best] < _FITS and misfits[best] * _BETTER < misfits[first]
    step.layout = best if fits else first
    return _describe_layout(callee, step, misfits[step.layout])


def _describe_layout(callee: Callee, step: UserMap, misfit: float) -> list[str]:
    """Return a note on how the arguments are understood, unless they are the usual ones."""
    usual = ("p", "q", "h"), ("p", "q", "t", "h"), ("p", "q"), ("z",)
    layout = step.layout
    if step.foreign or (layout.roles in usual and callee.named):
        return []
    names = ", ".join(callee.arguments)
    reason = "" if callee.named or misfit == 0 else ", the order that fits"
    if not callee.named and misfit >= _FITS:
        reason = ", as no order of them fits"
    if layout.roles in usual and not reason:
        return []
    return [f"its arguments ({names}) are taken as ({layout}){reason}"]


def _measure_misfit(step: UserMap, place: TrialPlace, field: FloatField | None) -> float:
    """Return the distance of a small step's end from where the field leads, in parts of that
    way."""
    h = float(place.step) / _PART
    z, t = [float(x) for x in place.z], float(place.t)
    end = step.evaluate(z, h, t)
    if field is None:
        return 0.0
    slopes = field(z, t)
    if slopes is None:
        return 1.0
    units = [float(u) for u in place.units]
    # The field at the midpoint: the end that it leads to is off by O(h³), so that the misfit of a
    # consistent step is small against the way.
    middle = field([x + h / 2 * f for x, f in zip(z, slopes, strict=True)], t + h / 2) or slopes
    way = max(abs(h * f) / u for f, u in zip(middle, units, strict=True))
    gap = max(abs(y - x - h * f) / u for x, y, f, u in zip(z, end, middle, units, strict=True))
    return gap / way if way else gap


def no_state(step: UserMap, error: Exception, place: TrialPlace) -> InputError:
    """Return the error of a call that returns no state at any place: it says what came and what to
    do."""
    kind = "integrator" if step.takes_step_size else "map"
    name = getattr(step.function, "__name__", None) or getattr(
        getattr(step.function, "program", None), "called", "the program"
    )
    if isinstance(error, StepError):
        return InputError(kind, name, str(error.said))
    message = f"raises {last_line(error)}{step.place(place.z, place.step / 8)}"
    n = step.degrees
    if n > 1:
        message += f"; it was given p and q as arrays of {n} numbers, and in other shapes"
    return InputError(kind, name, message)


UNDEFINED = "H has no exact solution from any of the places that are tried"


def check_integrator(
    callee: Callee, hamiltonian: Hamiltonian, claims: Claims = NOTHING, request: Request = NOWHERE
) -> Finding:
    """Run the user's code, a step for H, and judge it by what is claimed of it.

    Raises InputError where a parameter of H has no value, H has no motion where the user asks, or
    no call returns a state.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")
    step, field = callee.step, FloatField(hamiltonian)
    check_request(step.names, request)
    step.moving = hamiltonian.time_dependent
    places = places_of_field(field, step.moving, request)
    if request.z is not None and not any(x.source == USER for x in places):
        raise InputError("--q, --p", _format_state(step, request.z), "H has no motion there")
    if not places:
        return Finding(Verdict.UNDECIDED, prose(UNDEFINED), "calls", hamiltonian.degrees)
    notes = settle_layout(callee, places, field)
    # A step size that the user names is kept; else steps that throw the state far away are made
    # smaller.
    if request.step_size is None:
        places = shorten_steps(step, places)
    finding = _check_trial(Trial(step, hamiltonian, places, claims, request))
    return finding.noting(*notes, *_note_time(step))


def check_map(callee: Callee, request: Request = NOWHERE) -> Finding:
    """Run the user's code, a map without an H, and decide if it is symplectic.

    Raises InputError where no call returns a state.
    """
    step = callee.step
    check_request(step.names, request)
    notes = settle_layout(callee, places_of_map(step.names, Fraction(1), request), None)
    places = places_of_map(step.names, unit_of_map(step), request)
    claims = Claims(symplectic=True)
    return _check_trial(Trial(step, None, places, claims, request)).noting(*notes)


def _format_state(step: UserMap, z: Sequence[Fraction]) -> str:
    return ", ".join(f"{name} = {x}" for name, x in zip(step.names, z, strict=True))


def _check_trial(trial: Trial) -> Finding:
    step = trial.step
    faults, first = find_faults(step, trial.places)
    if not any(fault.fatal for fault in faults):
        faults += find_repetition_faults(step, trial.places)
    if any(fault.fatal for fault in faults):
        return _finding_of_fault(trial, faults)
    # A trace sees one call. Where a fault lets the function differ from call to call it is no
    # proof.
    provable = all(fault.allows is Verdict.PROVED for fault in faults)
    finding = examine(trial, provable)
    # The first calls are repeated after all others: a cache that the probes have filled shows here.
    later = find_changes(step, first)
    if later:
        return _finding_of_fault(trial, [*faults, *later])
    finding = replace(finding, faults=tuple(fault.name for fault in faults))
    finding = _limit_verdict(faults, finding.noting(*(fault.text for fault in faults)))
    finding = finding.noting(*_suggest_other_forms(finding, trial))
    if trial.hamiltonian is None:
        return _add_counterexample(finding, trial)
    finding = with_claims(finding, trial)
    return finding.noting(*_note_other_place(finding, trial.request))


def _note_other_place(finding: Finding, request: Request) -> list[str]:
    """Return a note where a verdict rests on another place than the user's."""
    example = finding.counterexample
    if request.z is None or example is None or tuple(example.z.values()) == request.z:
        return []
    return ["it is shown at another place than the one that you gave"]


def _suggest_other_forms(finding: Finding, trial: Trial) -> list[str]:
    """Return notes on what a refuted map may be all the same."""
    step = trial.step
    if trial.hamiltonian is None:
        evidence = trial.evidence if finding.symplectic is False else None
        readings = evidence[0].readings if evidence else ()
        return [*note_digits(readings), *note_masses(readings, step.names)] if readings else []
    masses = masses_of(trial.hamiltonian)
    if finding.verdict is not Verdict.REFUTED or not masses or step.masses or step.left <= 0:
        return []
    in_momenta = replace(trial, step=replace(step, masses=masses), claims=NOTHING)
    finding_in_momenta = unless_it_fails(
        lambda: finding_of(in_momenta, *in_momenta.measure(step.ways[0]))
    )
    if finding_in_momenta is None or not finding_in_momenta.scheme:
        return []
    symplectic_text = " and symplectic" if finding_in_momenta.symplectic else ""
    masses_text = ", ".join(map(str, masses))
    order = finding_in_momenta.convergence_order
    return [f"in momenta p = m·v, m = ({masses_text}), it is of order {order}{symplectic_text}"]


def _add_counterexample(finding: Finding, trial: Trial) -> Finding:
    """Add a counterexample to a map that is not symplectic."""
    if finding.symplectic is not False:
        return finding
    claim, reading = "that it is symplectic", finding.against
    example = (
        counterexample_of_reading(trial.step, reading, claim)
        if reading
        else counterexample(claim, trial)
    )
    return replace(finding, counterexample=example)


def _limit_verdict(faults: Sequence[Fault], finding: Finding) -> Finding:
    """Leave the finding UNDECIDED where a fault allows no more; what is refuted stays so."""
    in_the_way = [fault for fault in faults if fault.allows is Verdict.UNDECIDED]
    if not in_the_way or finding.verdict is Verdict.REFUTED:
        return finding
    reason = prose(in_the_way[0].text, " (", finding.reason, ")")
    return replace(finding, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False,
                   symplectic=finding.symplectic and None,
                   area_preserving=finding.area_preserving and None)  # fmt: skip


def _note_time(step: UserMap) -> list[str]:
    """Return a note where H or the step does not depend on time."""
    if step.takes_time and not step.moving:
        return ["H does not depend on time: it is called with t = 0"]
    if step.moving and not step.takes_time:
        return ["it takes no t, and H depends on it: its force stands still"]
    return [] if step.takes_time else ["it takes no t: it is judged for a force without time alone"]


def _finding_of_fault(trial: Trial, faults: Sequence[Fault]) -> Finding:
    """Build the finding for what is no scheme, or no map, because of a fatal fault."""
    fault = next(fault for fault in faults if fault.fatal)
    names = tuple(x.name for x in faults)
    return Finding(fault.allows if fault.allows is not Verdict.PROVED else Verdict.UNDECIDED,
                   prose(fault.text), "calls", trial.step.degrees, faults=names)  # fmt: skip
