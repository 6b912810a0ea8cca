"""The check of a user's step or map: is the step a scheme for H, is the symplectic form Ω kept?

1. Places are chosen: states with a time, a largest step size and units, that suit H or the map.
2. The layout is found in which the function takes its state.
3. Faults are looked for, such as results that change from call to call.
4. The code is traced with symbols and the map proved, else it is measured at the places.
5. The user's claims are judged.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.examination import examine
from verify.integrators.kept_list import add_list
from verify.integrators.measured_finding import finding_from_measurement
from verify.integrators.measures.form_notes import note_constants, note_slopes
from verify.integrators.measures.measurement_notes import masses_of, note_digits, note_masses
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.survey import NO_REQUEST, Request
from verify.integrators.preparation import note_time, prepare_map, prepare_step
from verify.integrators.results import NO_CLAIMS, Claims, Finding
from verify.integrators.trial import Trial, apply_claims, counterexample, counterexample_of_reading
from verify.integrators.user_code.faults import Fault, find_changes, find_faults
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repetition import find_repetition_faults
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import State, UserMap
from verify.prose import prose
from verify.verdict import Verdict

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
    places, notes = prepare_step(callee, hamiltonian, request)
    step = callee.step
    if not places:
        text, degrees = prose(NO_PLACES_TEXT), hamiltonian.degrees
        return Finding(Verdict.UNDECIDED, text, how="calls", degrees=degrees)
    finding = _check_trial(Trial(step, hamiltonian, places, claims, request))
    finding = finding.noting(*notes, *note_time(step))
    return add_list(finding, step, hamiltonian, places)


def check_map(callee: Callee, request: Request = NO_REQUEST) -> Finding:
    """Run the user's code, a map without an H, and decide if it is symplectic.

    Raises InputError if no call returns a state.
    """
    places, notes = prepare_map(callee, request)
    claims = Claims(symplectic=True)
    finding = _check_trial(Trial(callee.step, None, places, claims, request)).noting(*notes)
    return add_list(finding, callee.step, None, places)


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
    """Return notes on likely reasons of a refutation: what is turned, a matrix of few digits, or
    velocities or slopes in the place of momenta."""
    step = trial.step
    evidence = trial.evidence if finding.symplectic is False else None
    # The evidence is a pair: the measurement of the structure, and that of the distances.
    readings = evidence[0].readings if evidence else ()
    constants = note_constants(readings, step.names) if readings else []
    if trial.hamiltonian is None:
        if not readings:
            return []
        slopes = note_slopes(readings, partial(_end_of, step), step.names)
        masses = note_masses(readings, step.names)
        return note_digits(readings) or [*constants, *slopes, *masses]
    if constants:
        return constants
    masses_of_h = masses_of(trial.hamiltonian)
    if (
        finding.verdict is not Verdict.REFUTED
        or not masses_of_h
        or step.masses
        or step.seconds_left <= 0
    ):
        return []
    trial_in_momenta = replace(trial, step=replace(step, masses=masses_of_h), claims=NO_CLAIMS)
    how = step.probe_kinds[0]
    finding_in_momenta = unless_it_fails(
        lambda: finding_from_measurement(trial_in_momenta, *trial_in_momenta.measure(how))
    )
    if finding_in_momenta is None or not finding_in_momenta.scheme:
        return []
    symplectic_text = " and symplectic" if finding_in_momenta.symplectic else ""
    masses_text = ", ".join(map(str, masses_of_h))
    order = finding_in_momenta.convergence_order
    return [f"in momenta p = m·v, m = ({masses_text}), it is of order {order}{symplectic_text}"]


def _end_of(step: UserMap, reading: DefectReading) -> State | None:
    return unless_it_fails(partial(step.at_place, reading.place, reading.h))


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


def _finding_of_fault(trial: Trial, faults: Sequence[Fault]) -> Finding:
    """Build the finding of the first fatal fault: REFUTED, or UNDECIDED if the fault allows it."""
    fault = next(fault for fault in faults if fault.fatal)
    names = tuple(x.name for x in faults)
    # A fault that allows PROVED is fatal only if it ends the examination, before any proof.
    verdict = fault.allows if fault.allows is not Verdict.PROVED else Verdict.UNDECIDED
    degrees = trial.step.degrees
    return Finding(verdict, prose(fault.text), how="calls", degrees=degrees, faults=names)
