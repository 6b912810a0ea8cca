"""The check of a user's step or map by all that is claimed: its order, what it keeps, or both.

1. Places are chosen: states with a time, a largest step size and units, that suit the system.
2. The layout is found in which the function takes its state.
3. Faults are looked for, such as results that change from call to call.
4. The code is traced with symbols and the map proved, else it is measured at the places.
5. The user's claims are judged.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.examination import examine
from verify.integrators.kept_list import add_list
from verify.integrators.kept_structures import leave_open
from verify.integrators.map_claims import check_map_claim
from verify.integrators.measured_finding import finding_from_measurement
from verify.integrators.measures.form_notes import note_constants, note_slopes
from verify.integrators.measures.measurement_notes import masses_of, note_digits, note_masses
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.survey import NO_REQUEST, Request
from verify.integrators.preparation import note_time, prepare_map, prepare_step
from verify.integrators.results import NO_CLAIMS, Claims, Finding
from verify.integrators.structure_check import examine_structures
from verify.integrators.trial import Trial, apply_claims, counterexample, counterexample_of_reading
from verify.integrators.user_code.faults import Fault, find_changes, find_faults
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repetition import find_repetition_faults
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import State, UserMap
from verify.proof.structures.structure_order import check_structure
from verify.prose import join_prose, prose
from verify.structures.reading import ClaimedStructure
from verify.verdict import Verdict, worst_of


def check_step(
    callee: Callee,
    system: Hamiltonian,
    claims: Claims = NO_CLAIMS,
    keeps: Sequence[ClaimedStructure] = (),
    request: Request = NO_REQUEST,
) -> Finding:
    """Run the user's code, a step for H or for equations, and judge it by what is claimed of it.

    With `keeps` and no other claims, only those are judged. Raises InputError if a parameter has no
    value, if the exact flow does not keep a structure, if the equations are undefined at the user's
    state, or if no call returns a state.
    """
    if system.energy is None and replace(claims, order=None) != NO_CLAIMS:
        problem = "has no p and q; claim --keeps volume, or --keeps symplectic with a --form"
        raise InputError("--field", NOT_GIVEN, problem)
    keeps = [replace(x, structure=x.structure.with_values(system.value_substitutions))
             for x in keeps]  # fmt: skip
    for claim in keeps:
        check_structure(system, claim.structure)
    places, notes = prepare_step(callee, system, request)
    trial = Trial(callee.step, system, places, claims, request, keeps)
    if not places:
        subject = "its equations have no" if trial.of_equations or keeps else "H has no exact"
        return _end(trial, f"{subject} solution from any of the places that are tried")
    return _check_trial(trial, [*notes, *note_time(callee.step)])


def check_map(
    callee: Callee, keeps: Sequence[ClaimedStructure] = (), request: Request = NO_REQUEST
) -> Finding:
    """Run the user's code, a map without an H, and decide if it is symplectic, or what it keeps.

    Raises InputError if no call returns a state, or if the formulas make no structure, or one that
    only a step may have.
    """
    for claim in keeps:
        check_map_claim(claim, callee.step.names)
    places, notes = prepare_map(callee, request)
    claims = NO_CLAIMS if keeps else Claims(symplectic=True)
    return _check_trial(Trial(callee.step, None, places, claims, request, keeps), notes)


def _end(trial: Trial, reason: str, verdict: Verdict = Verdict.UNDECIDED) -> Finding:
    """Return the finding that nothing can be examined, for one reason."""
    keeps = tuple(leave_open(x, reason) for x in trial.keeps)
    return Finding(verdict, prose(reason), how="calls", degrees=trial.step.degrees, keeps=keeps)


def _check_trial(trial: Trial, notes: Sequence[str]) -> Finding:
    """Look for faults, examine the step or map, and judge the claims."""
    step, is_other = trial.step, bool(trial.keeps) and trial.claims == NO_CLAIMS
    faults, first_results = find_faults(step, trial.places)
    if not any(fault.fatal for fault in faults):
        faults += find_repetition_faults(step, trial.places)
    if any(fault.fatal for fault in faults):
        return _end_with_fault(trial, faults).noting(*notes)
    # A trace of one call proves nothing if a fault lets the function differ from call to call.
    try_proof = all(fault.allows is Verdict.PROVED for fault in faults)
    limiting = next((x.text for x in faults if x.allows is Verdict.UNDECIDED), "")
    kept = examine_structures(trial, try_proof, limiting) if trial.keeps else None
    finding = kept if kept and is_other else examine(trial, try_proof)
    # The first calls are repeated after all others: a cache that these have filled shows here.
    changes = find_changes(step, first_results)
    if changes:
        return _end_with_fault(trial, [*faults, *changes]).noting(*notes)
    finding = replace(finding, faults=tuple(fault.name for fault in faults))
    finding = finding.noting(*(fault.text for fault in faults))
    if not is_other:
        finding = _judge(_limit_verdict(limiting, finding), trial)
    if not trial.keeps and not trial.of_equations:
        return add_list(finding.noting(*notes), step, trial.hamiltonian, trial.places)
    if kept and not is_other:
        finding = replace(
            finding, verdict=worst_of([finding.verdict, kept.verdict]),
            reason=join_prose("; ", [finding.reason, kept.reason]), keeps=kept.keeps,
            notes=(*finding.notes, *(x for x in kept.notes if x not in finding.notes)),
            counterexample=finding.counterexample or kept.counterexample,
        )  # fmt: skip
    return finding.noting(*notes)


def _judge(finding: Finding, trial: Trial) -> Finding:
    """Return the finding with the verdict on the claims, and notes on likely mistakes."""
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
    structure, _ = (finding.symplectic is False and trial.evidence) or (None, None)
    readings = structure.readings if structure else ()
    constants = note_constants(readings, step.names) if readings else []
    if trial.hamiltonian is None:
        if not readings:
            return []
        slopes = note_slopes(readings, partial(_end_of, step), step.names)
        masses = note_masses(readings, step.names)
        return note_digits(readings) or [*constants, *slopes, *masses]
    if constants or trial.of_equations:
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


def _limit_verdict(fault: str, finding: Finding) -> Finding:
    """Make the finding UNDECIDED if a fault allows no stronger verdict; a refutation stands."""
    if not fault or finding.verdict is Verdict.REFUTED:
        return finding
    reason = prose(fault, " (", finding.reason, ")")
    # `x and None` keeps False, which a fault does not put in doubt, and opens True.
    return replace(finding, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False,
                   symplectic=finding.symplectic and None,
                   area_preserving=finding.area_preserving and None)  # fmt: skip


def _end_with_fault(trial: Trial, faults: Sequence[Fault]) -> Finding:
    """Build the finding of the first fatal fault: REFUTED, or UNDECIDED if the fault allows it; a
    claim on what is kept cannot be checked on such a step."""
    fault = next(fault for fault in faults if fault.fatal)
    # A fault that allows PROVED is fatal only if it ends the examination, before any proof.
    is_open = fault.allows is Verdict.PROVED or (trial.keeps and trial.claims == NO_CLAIMS)
    finding = _end(trial, fault.text, Verdict.UNDECIDED if is_open else fault.allows)
    return replace(finding, faults=tuple(x.name for x in faults))
