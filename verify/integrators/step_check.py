"""The check of a user's step or map: is the step a scheme for H, is the symplectic form Ω kept?

1. Places are chosen: states with a time, a largest step size and units, that suit H or the map.
2. The layout is found in which the function takes its state.
3. Faults are looked for, such as results that change from call to call.
4. The code is traced with symbols and the map proved, else it is measured at the places.
5. The user's claims are judged.

With an H, each layout is tried by a step that is compared with one explicit midpoint step along
Hamilton's equations; the likeliest layout is kept unless another fits far better, and a note
reports an order that the arguments' names do not tell. Without an H, the first layout is kept in
which a call returns a state. If no layout returns a state, the call is in error, and nothing is
refuted.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.examination import examine
from verify.integrators.measured_finding import finding_from_measurement
from verify.integrators.measures.measurement_notes import masses_of, note_digits, note_masses
from verify.integrators.measures.survey import (
    NO_REQUEST,
    Request,
    check_request,
    find_map_unit,
    places_of_field,
    places_of_map,
    shorten_steps,
)
from verify.integrators.places.trial_places import USER, TrialPlace
from verify.integrators.places.units import FloatField
from verify.integrators.results import NO_CLAIMS, Claims, Finding
from verify.integrators.trial import Trial, apply_claims, counterexample, counterexample_of_reading
from verify.integrators.user_code.faults import Fault, find_changes, find_faults
from verify.integrators.user_code.layout import CallLayout
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repetition import find_repetition_faults
from verify.integrators.user_code.step import StepError, last_line, unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.prose import prose
from verify.verdict import Verdict

_STEP_DIVISOR = 64  # a layout is tried with the largest step size divided by this number
_LARGEST_MISFIT = 0.2  # a layout fits H if its step is off by less, relative to the distance moved
_TIMES_BETTER = 10  # the ratio of misfits at which another layout replaces the likeliest
_MAX_LAYOUT_PLACES = 3  # more than one, since a step may be undefined at a place


def settle_layout(
    callee: Callee, places: Sequence[TrialPlace], field: FloatField | None
) -> list[str]:
    """Set the layout, and return notes on how the arguments are understood.

    Raises InputError if no call returns a state.
    """
    step, errors = callee.step, list[Exception]()
    # The misfit of each layout in which a call returns a state, at the first place where one does.
    misfits = dict[CallLayout, float]()
    for layout in callee.layouts:
        step.layout = layout
        for place in places[:_MAX_LAYOUT_PLACES]:
            try:
                misfits[layout] = _measure_misfit(step, place, field)
                break
            except Exception as error:  # the user's code may raise anything
                errors.append(error)
            if step.seconds_left <= 0:
                break
        # Without an H nothing tells the layouts apart, and the first one that works is kept.
        if misfits and field is None:
            break
    if not misfits:
        step.layout = callee.layouts[0]
        raise no_state_error(step, errors[0], places[0])
    # `callee.layouts` begins with the likeliest, and `misfits` keeps that order.
    likeliest, best = next(iter(misfits)), min(misfits, key=lambda layout: misfits[layout])
    # Another layout must fit, and far better: otherwise a bad scheme would be mistaken for one with
    # its arguments exchanged.
    is_far_better = misfits[best] * _TIMES_BETTER < misfits[likeliest]
    replaces = misfits[best] < _LARGEST_MISFIT and is_far_better
    step.layout = best if replaces else likeliest
    return _describe_layout(callee, step, misfits[step.layout])


def _describe_layout(callee: Callee, step: UserMap, misfit: float) -> list[str]:
    """Return a note on how the arguments are understood, unless this is as usual; the misfit is 0
    if the layout was not compared with an H."""
    usual = ("p", "q", "h"), ("p", "q", "t", "h"), ("p", "q"), ("z",)
    layout = step.layout
    if step.foreign or (layout.roles in usual and callee.named):
        return []
    names = ", ".join(callee.arguments)
    reason = "" if callee.named or misfit == 0 else ", the order that fits"
    if not callee.named and misfit >= _LARGEST_MISFIT:
        reason = ", as no order of them fits"
    if layout.roles in usual and not reason:
        return []
    return [f"its arguments ({names}) are taken as ({layout}){reason}"]


def _measure_misfit(step: UserMap, place: TrialPlace, field: FloatField | None) -> float:
    """Return the distance of a small step's end from that of an explicit midpoint step, in parts of
    the distance moved; 0 without a field, and 1 if the field is undefined at the place."""
    h = float(place.step) / _STEP_DIVISOR
    z, t = [float(x) for x in place.z], float(place.t)
    end = step.evaluate(z, h, t)
    if field is None:
        return 0.0
    slopes = field(z, t)
    if slopes is None:
        return 1.0
    units = [float(u) for u in place.units]
    # The distance moved is O(h). The midpoint step is off by O(h³), and a consistent step by O(h²),
    # so that the misfit of a consistent step is O(h), and small for a small step.
    middle = field([x + h / 2 * f for x, f in zip(z, slopes, strict=True)], t + h / 2) or slopes
    moved = max(abs(h * f) / u for f, u in zip(middle, units, strict=True))
    gap = max(abs(y - x - h * f) / u for x, y, f, u in zip(z, end, middle, units, strict=True))
    return gap / moved if moved else gap


def no_state_error(step: UserMap, error: Exception, place: TrialPlace) -> InputError:
    """Return the error of a function that returns no state at any place: what came instead.

    `error`: the first one that was raised, at the first place and in the likeliest layout.
    """
    kind = "integrator" if step.takes_step_size else "map"
    # A step of another language is an object with a program, which has the user's name for it.
    name = getattr(step.function, "__name__", None) or getattr(
        getattr(step.function, "program", None), "display_name", "the program"
    )
    if isinstance(error, StepError):
        return InputError(kind, name, str(error.clause))
    message = f"raises {last_line(error)}{step.describe_call(place.z, place.step / 8)}"
    n = step.degrees
    if n > 1:
        message += f"; it was given p and q as arrays of {n} numbers, and in other shapes"
    return InputError(kind, name, message)


NO_PLACES_TEXT = "H has no exact solution from any of the places that are tried"


def check_integrator(
    callee: Callee,
    hamiltonian: Hamiltonian,
    claims: Claims = NO_CLAIMS,
    request: Request = NO_REQUEST,
) -> Finding:
    """Run the user's code, a step for H, and judge it by what is claimed of it.

    Raises InputError if a parameter of H has no value, if Hamilton's equations are undefined at the
    user's state, or if no call returns a state.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")
    step, field = callee.step, FloatField(hamiltonian)
    check_request(step.names, request)
    step.time_dependent = hamiltonian.time_dependent
    places = places_of_field(field, step.time_dependent, request)
    if request.z is not None and not any(x.source == USER for x in places):
        raise InputError("--q, --p", _format_state(step, request.z), "H has no motion there")
    if not places:
        text, degrees = prose(NO_PLACES_TEXT), hamiltonian.degrees
        return Finding(Verdict.UNDECIDED, text, how="calls", degrees=degrees)
    notes = settle_layout(callee, places, field)
    # The user's step size is kept; steps of our choice that throw the state far away are shortened.
    if request.step_size is None:
        places = shorten_steps(step, places)
    finding = _check_trial(Trial(step, hamiltonian, places, claims, request))
    return finding.noting(*notes, *_note_time(step))


def check_map(callee: Callee, request: Request = NO_REQUEST) -> Finding:
    """Run the user's code, a map without an H, and decide if it is symplectic.

    Raises InputError if no call returns a state.
    """
    step = callee.step
    check_request(step.names, request)
    # The map's unit of length is measured by calls, which need the layout: here the unit is 1.
    notes = settle_layout(callee, places_of_map(step.names, Fraction(1), request), None)
    places = places_of_map(step.names, find_map_unit(step), request)
    claims = Claims(symplectic=True)
    return _check_trial(Trial(step, None, places, claims, request)).noting(*notes)


def _format_state(step: UserMap, z: Sequence[Fraction]) -> str:
    return ", ".join(f"{name} = {x}" for name, x in zip(step.names, z, strict=True))


def _check_trial(trial: Trial) -> Finding:
    """Look for faults, examine the step or map, and judge the claims."""
    step = trial.step
    faults, first_results = find_faults(step, trial.places)
    if not any(fault.fatal for fault in faults):
        faults += find_repetition_faults(step, trial.places)
    if any(fault.fatal for fault in faults):
        return _finding_of_fault(trial, faults)
    # A trace of one call proves nothing if a fault lets the function differ from call to call.
    try_proof = all(fault.allows is Verdict.PROVED for fault in faults)
    finding = examine(trial, try_proof)
    # The first calls are repeated after all others: a cache that these have filled shows here.
    changes = find_changes(step, first_results)
    if changes:
        return _finding_of_fault(trial, [*faults, *changes])
    finding = replace(finding, faults=tuple(fault.name for fault in faults))
    finding = _limit_verdict(faults, finding.noting(*(fault.text for fault in faults)))
    finding = finding.noting(*_suggest_other_forms(finding, trial))
    if trial.hamiltonian is None:
        return _add_counterexample(finding, trial)
    finding = apply_claims(finding, trial)
    return finding.noting(*_note_other_place(finding, trial.request))


def _note_other_place(finding: Finding, request: Request) -> list[str]:
    """Return a note if the counterexample lies at another place than the user's."""
    example = finding.counterexample
    if request.z is None or example is None or tuple(example.z.values()) == request.z:
        return []
    return ["it is shown at another place than the one that you gave"]


def _suggest_other_forms(finding: Finding, trial: Trial) -> list[str]:
    """Return notes on likely reasons of a refutation: a matrix of few digits, or velocities in the
    place of momenta."""
    step = trial.step
    if trial.hamiltonian is None:
        evidence = trial.evidence if finding.symplectic is False else None
        # The evidence is a pair: the measurement of the structure, and that of the distances.
        readings = evidence[0].readings if evidence else ()
        return [*note_digits(readings), *note_masses(readings, step.names)] if readings else []
    masses = masses_of(trial.hamiltonian)
    if (
        finding.verdict is not Verdict.REFUTED
        or not masses
        or step.masses
        or step.seconds_left <= 0
    ):
        return []
    trial_in_momenta = replace(trial, step=replace(step, masses=masses), claims=NO_CLAIMS)
    how = step.probe_kinds[0]
    finding_in_momenta = unless_it_fails(
        lambda: finding_from_measurement(trial_in_momenta, *trial_in_momenta.measure(how))
    )
    if finding_in_momenta is None or not finding_in_momenta.scheme:
        return []
    symplectic_text = " and symplectic" if finding_in_momenta.symplectic else ""
    masses_text = ", ".join(map(str, masses))
    order = finding_in_momenta.convergence_order
    return [f"in momenta p = m·v, m = ({masses_text}), it is of order {order}{symplectic_text}"]


def _add_counterexample(finding: Finding, trial: Trial) -> Finding:
    """Add a counterexample if the map is not symplectic."""
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
    """Make the finding UNDECIDED if a fault allows no stronger verdict; a refutation stands."""
    limiting_faults = [fault for fault in faults if fault.allows is Verdict.UNDECIDED]
    if not limiting_faults or finding.verdict is Verdict.REFUTED:
        return finding
    reason = prose(limiting_faults[0].text, " (", finding.reason, ")")
    # `x and None` keeps False, which a fault does not put in doubt, and opens True.
    return replace(finding, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False,
                   symplectic=finding.symplectic and None,
                   area_preserving=finding.area_preserving and None)  # fmt: skip


def _note_time(step: UserMap) -> list[str]:
    """Return a note if H or the step does not depend on time."""
    if step.takes_time and not step.time_dependent:
        return ["H does not depend on time: it is called with t = 0"]
    if step.time_dependent and not step.takes_time:
        return ["it takes no t, and H depends on it: its force stands still"]
    return [] if step.takes_time else ["it takes no t: it is judged for a force without time alone"]


def _finding_of_fault(trial: Trial, faults: Sequence[Fault]) -> Finding:
    """Build the finding of the first fatal fault: REFUTED, or UNDECIDED if the fault allows it."""
    fault = next(fault for fault in faults if fault.fatal)
    names = tuple(x.name for x in faults)
    # A fault that allows PROVED is fatal only if it ends the examination, before any proof.
    verdict = fault.allows if fault.allows is not Verdict.PROVED else Verdict.UNDECIDED
    degrees = trial.step.degrees
    return Finding(verdict, prose(fault.text), how="calls", degrees=degrees, faults=names)
