"""The check of a step by all that is claimed: its order, what it keeps, or both.

The order of a step of equations is that of its trace, or is measured by its distances from the
exact flow, as with an H.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.kept_proof import prove_step
from verify.integrators.measured_finding import judge_order
from verify.integrators.measures.agreement import must_agree, trace_must_agree
from verify.integrators.measures.distances import Distances, distances_of
from verify.integrators.measures.measurement_notes import describe_places
from verify.integrators.measures.probes import DualProbe, probe_of
from verify.integrators.measures.sides import Sides
from verify.integrators.measures.survey import NO_REQUEST, Request
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.preparation import note_time, prepare_step
from verify.integrators.results import NO_CLAIMS, Claims, Finding, judge_claims
from verify.integrators.step_check import check_integrator
from verify.integrators.structure_check import check_step_keeps
from verify.integrators.trace_proof import trace_of
from verify.integrators.trial import counterexample_of_order
from verify.integrators.user_code.faults import find_changes, find_faults
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repetition import find_repetition_faults
from verify.integrators.user_code.step import describe_error, limit_time, unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, join_prose, prose, read_prose
from verify.structures.reading import ClaimedStructure
from verify.verdict import Verdict, worst_of

_SHARE_FOR_PROOF = 1 / 3  # a part of the time that is left


def check_system(
    callee: Callee,
    system: Hamiltonian,
    claims: Claims = NO_CLAIMS,
    keeps: Sequence[ClaimedStructure] = (),
    request: Request = NO_REQUEST,
) -> Finding:
    """Run the user's code, a step for H or for equations, and judge it by what is claimed of it.

    With `keeps` and no other claims, only those are judged. Raises InputError as `check_integrator`
    and `check_step_keeps` do.
    """
    kept = check_step_keeps(callee, system, keeps, request) if keeps else None
    if kept is not None and claims == NO_CLAIMS:
        return kept
    if system.energy is None:
        finding = check_equations(callee, system, claims, request)
    else:
        finding = check_integrator(callee, system, claims, request)
    if kept is None:
        return finding
    return replace(
        finding, verdict=worst_of([finding.verdict, kept.verdict]),
        reason=join_prose("; ", [finding.reason, kept.reason]), keeps=kept.keeps,
        notes=(*finding.notes, *(x for x in kept.notes if x not in finding.notes)),
        counterexample=finding.counterexample or kept.counterexample,
    )  # fmt: skip


def check_equations(
    callee: Callee, system: Hamiltonian, claims: Claims, request: Request = NO_REQUEST
) -> Finding:
    """Run the user's code, a step of equations without an H, and judge its order."""
    if replace(claims, order=None) != NO_CLAIMS:
        problem = "has no p and q; claim --keeps volume, or --keeps symplectic with a --form"
        raise InputError("--field", NOT_GIVEN, problem)
    places, notes = prepare_step(callee, system, request)
    step = callee.step
    undecided = Finding(Verdict.UNDECIDED, Prose(), "calls", step.degrees, places=tuple(places))
    if not places:
        text = "its equations have no solution from any of the places that are tried"
        return replace(undecided, reason=prose(text))
    faults, first_results = find_faults(step, places)
    if not any(fault.fatal for fault in faults):
        faults += find_repetition_faults(step, places)
    try_proof = all(fault.allows is Verdict.PROVED for fault in faults)
    finding = undecided
    if not any(fault.fatal for fault in faults):
        finding = _order_of_step(step, system, claims, places, try_proof)
        faults += find_changes(step, first_results)
    fatal = next((fault for fault in faults if fault.fatal), None)
    if fatal is not None:
        verdict = fatal.allows if fatal.allows is not Verdict.PROVED else Verdict.UNDECIDED
        finding = replace(undecided, verdict=verdict, reason=prose(fatal.text))
    texts = [fault.text for fault in faults if fault is not fatal]
    names = tuple(fault.name for fault in faults)
    return replace(finding, faults=names).noting(*texts, *notes, *note_time(step))


def _order_of_step(
    step: UserMap, system: Hamiltonian, claims: Claims, places: list[TrialPlace], try_proof: bool
) -> Finding:
    """Return the finding on the order, by proof or by measurement."""
    domain = (str(describe_places(step, places)),)
    finding = Finding(
        Verdict.UNDECIDED, Prose(), "calls", step.degrees, domain=domain, places=tuple(places)
    )
    notes, distances = list[Prose](), None
    order = _prove_order(step, system, places) if try_proof and not step.foreign else None
    if order is not None:
        text = read_prose(f"the map agrees with the exact flow up to `h^{order}`")
        finding = replace(finding, verdict=Verdict.PROVED, reason=text, how="proof",
                          convergence_order=order, order_decided=True)  # fmt: skip
    else:
        for how in step.probe_kinds:
            try:
                distances = _measure(step, system, places, how)
                break
            except Exception as error:  # the user's code may raise anything
                notes.append(prose(f"not measured with {how}: ", describe_error(error)))
        if distances is None:
            return replace(finding, reason=prose("it cannot be measured"), notes=tuple(notes))
        judged = judge_order(distances, Sides(step.names), claims)
        verdict = Verdict.MEASURED if judged.decided else Verdict.UNDECIDED
        finding = replace(finding, verdict=verdict, reason=read_prose(judged.text),
                          how=distances.how, convergence_order=judged.order,
                          order_decided=judged.decided, notes=tuple(notes))  # fmt: skip
    finding = _judge(finding, claims)
    if finding.verdict is not Verdict.REFUTED:
        return finding
    if distances is None:  # the proof has no place at which the claim is seen to fail
        distances = unless_it_fails(partial(_measure, step, system, places, step.probe_kinds[0]))
    example = counterexample_of_order(step, distances, claims.order or 1)
    return replace(finding, counterexample=example)


def _judge(finding: Finding, claims: Claims) -> Finding:
    """Return the finding with the verdict on the claimed order."""
    order = finding.convergence_order
    claimed = judge_claims(claims, finding)
    is_step = order is None or order >= 1 or not finding.order_decided
    if is_step and all(x.holds is True for x in claimed):
        return finding
    if is_step and all(x.holds is not False for x in claimed):
        reason = prose(claimed[0].name, " is claimed and not decided: ", finding.reason)
        return replace(finding, verdict=Verdict.UNDECIDED, reason=reason)
    lead = f"{claimed[0].name} is claimed; " if claimed else "not a scheme for these equations: "
    return replace(finding, verdict=Verdict.REFUTED, reason=prose(lead, finding.reason))


def _prove_order(step: UserMap, system: Hamiltonian, places: list[TrialPlace]) -> int | None:
    """Return the order by the trace of the code; None if that does not show it."""
    seconds = max(step.seconds_left, 0.1) * _SHARE_FOR_PROOF
    try:
        with limit_time(seconds, "its trace takes too long"):
            trace = trace_of(step)
            if trace.tape.surroundings.texts:
                return None
            trace_must_agree(step, trace.outputs, places)
        return prove_step(trace, system, (), seconds)[1]
    except Exception:  # the user's code may raise anything
        return None


def _measure(step: UserMap, system: Hamiltonian, places: list[TrialPlace], how: str) -> Distances:
    probe = probe_of(step, how)
    if isinstance(probe, DualProbe):
        must_agree(probe, places)
    return distances_of(step, probe, system, places)
