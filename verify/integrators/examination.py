"""The examination of a user's step or map at its places: proof as far as it goes, else measurement.

Where its code lets symbols through, the map is proved, and what algebra leaves open is measured;
else all is measured, with dual numbers where they go through, or with floats.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.clocks import clock_mistakes, measure_clock_mistakes
from verify.integrators.measured_finding import finding_of
from verify.integrators.measures.agreement import trace_must_agree
from verify.integrators.measures.probes import probe_of
from verify.integrators.measures.structure_measurement import StructureMeasurement
from verify.integrators.results import Finding
from verify.integrators.trace_proof import Trace, prove_map, prove_step, trace_of
from verify.integrators.trial import Trial
from verify.integrators.user_code.step import StepError, describe_error, limit_time
from verify.prose import Prose, join_prose, prose
from verify.verdict import Verdict

_SHARE_FOR_PROOF = 1 / 3  # of the time that is left
_CLOCK_SECONDS = 10.0
_MAX_LISTED = 3  # of what is not pure
_MAX_PROOF_SECONDS = 20.0
# With three degrees of freedom and more algebra seldom ends in time.
_MAX_PROOF_SECONDS_IN_MANY_DEGREES = 6.0
_SHARE_FOR_FLOATS = 0.4  # of the time that is left, for floats after dual numbers, which are slow


def examine(trial: Trial, provable: bool) -> Finding:
    """Return the finding on a step or a map. `provable`: whether a proof may be tried."""
    step, notes = trial.step, list[Prose]()
    if step.foreign:
        return _measure(trial, notes)
    try:
        # In many degrees of freedom algebra seldom ends in time, and the time is needed for
        # measuring.
        time_limit = _MAX_PROOF_SECONDS if step.degrees < 3 else _MAX_PROOF_SECONDS_IN_MANY_DEGREES
        with limit_time(
            min(time_limit, max(step.left, 0.1) * _SHARE_FOR_PROOF), "its proof takes too long"
        ):
            trace = trace_of(step)
            _must_be_pure(trace)
            if provable:
                trace_must_agree(step, trace.roots, trial.places)
                system = trial.hamiltonian
                finding = prove_step(trace, system) if system else prove_map(trace, step.names)
        if not provable:
            return _measure(trial, notes)
        finding = _decide(finding, trial, trace)
        order = finding.convergence_order
        return finding.noting(*_clock(trial, lambda h: clock_mistakes(h, trace.roots, order)))
    except Exception as error:  # the user's code may raise anything
        notes.append(prose("no proof: ", describe_error(error)))
    return _measure(trial, notes)


def _must_be_pure(trace: Trace) -> None:
    """Raise StepError where the code reaches something that may change from call to call."""
    impure = trace.tape.surroundings.texts
    if impure:
        names = join_prose(", ", map(prose, impure[:_MAX_LISTED]))
        raise StepError(prose("what it reaches may change from call to call: ", names))


def _decide(finding: Finding, trial: Trial, trace: Trace) -> Finding:
    """Return the finding of a proof, completed by measurement where the proof leaves something
    open.

    Rounded coefficients stand for others: of a trace that has them no order is proved, and Ω only
    where it is preserved.
    """
    is_rounded, symplectic = bool(trace.tape.rounded), finding.symplectic
    of_map = trial.hamiltonian is None
    open_ = symplectic is None and finding.verdict is not Verdict.REFUTED
    volume_open = symplectic is False and finding.area_preserving is None
    if of_map and symplectic:
        return finding
    if not (is_rounded or open_ or volume_open or of_map):
        return finding
    try:
        structure, distances = trial.measure("duals")
    except Exception as error:  # the user's code may raise anything
        return finding.noting(prose("not measured: ", describe_error(error)))
    measurement = finding_of(trial, structure, distances)
    measured_finding = replace(measurement, notes=(*finding.notes, *measurement.notes))
    if of_map:
        return (
            measured_finding
            if is_rounded or open_
            else _refuted_map(finding, measured_finding, structure)
        )
    if is_rounded:
        return _but_for_rounding(finding, measured_finding)
    if open_:
        return _with_series(finding, measured_finding)
    return replace(finding, area_preserving=structure.volume_kept)


def _but_for_rounding(finding: Finding, measured_finding: Finding) -> Finding:
    """Combine the measured order with what is proved of Ω."""
    order, _, defect = measured_finding.reason.partition("; ")
    exactly = finding.convergence_order
    clause = "but for the rounding of its coefficients"
    if exactly is not None and exactly != measured_finding.convergence_order:
        clause += f" (taken exactly, they make the order {exactly})"
    if not finding.symplectic:
        return replace(measured_finding, reason=prose(order, f", {clause}; ", defect))
    statement = "det J ≡ 1, proved" if finding.degrees == 1 else "S ≡ 0, proved"
    verdict = measured_finding.verdict
    if verdict is Verdict.UNDECIDED and measured_finding.order_decided:
        verdict = Verdict.MEASURED
    return replace(
        measured_finding, verdict=verdict, reason=prose(order, f", {clause}; ", statement),
        order=None, symplectic=True, area_preserving=True,
    )  # fmt: skip


def _with_series(finding: Finding, measured_finding: Finding) -> Finding:
    """Combine what is measured of Ω with the order and the series of a proof that leaves Ω open."""
    order = (
        finding.convergence_order if finding.order_decided else measured_finding.convergence_order
    )
    return replace(
        measured_finding,
        reason=prose(measured_finding.reason, " (what algebra says: ", finding.reason, ")"),
        convergence_order=order,
        order_decided=finding.order_decided or measured_finding.order_decided,
        leading=finding.leading,
        area_at_least=finding.area_at_least,
    )


def _refuted_map(
    finding: Finding, measured_finding: Finding, structure: StructureMeasurement
) -> Finding:
    """Refute a map by algebra, and show it by dual numbers at places where it can be seen."""
    volume = finding.area_preserving
    if volume is None:
        volume = structure.volume_kept
    if measured_finding.symplectic is not False:
        return measured_finding  # algebra says it is not 0; it is too small for doubles to show
    identity = "≡ 1" if finding.area_preserving else "is 1 where it was measured,"
    volume_text = f"; det J {identity} all the same" if volume else ""
    entry = measured_finding.entry or finding.entry
    reason = prose(f"it is not symplectic: the entry {entry} of S is not 0{volume_text}")
    return replace(finding, reason=reason, area_preserving=volume, entry=entry,
                   largest=measured_finding.largest, probe_error=measured_finding.probe_error,
                   against=measured_finding.against, places=measured_finding.places)  # fmt: skip


def _clock(trial: Trial, mistakes: Callable[[Hamiltonian], list[str]]) -> list[str]:
    """Name the mistake that the step's clock looks like; return nothing where none is seen in
    time."""
    if trial.hamiltonian is None or not trial.step.moving or trial.step.degrees > 1:
        return []
    try:
        with limit_time(_CLOCK_SECONDS, "its clock takes too long"):
            return mistakes(trial.hamiltonian)
    except Exception:  # the user's code may raise anything
        return []


def _measure(trial: Trial, notes: list[Prose]) -> Finding:
    step = trial.step
    # Dual numbers are slow: some of the time is held back for floats, and given back before these
    # begin.
    reserve = 0.0 if step.foreign else _SHARE_FOR_FLOATS * max(step.left, 0)
    for how in step.ways:
        step.hold_back(reserve if how == "duals" else -reserve)
        try:
            finding = finding_of(trial, *trial.measure(how))
            finding = replace(finding, notes=(*notes, *finding.notes))
            return finding.noting(*_clock(trial, partial(_find_still_clock, trial, how, finding)))
        except Exception as error:  # as above
            notes.append(prose(f"not measured with {how}: ", describe_error(error)))
    message = prose("it can be neither traced nor measured")
    return Finding(Verdict.UNDECIDED, message, "calls", step.degrees).noting(*notes)


def _find_still_clock(
    trial: Trial, how: str, finding: Finding, hamiltonian: Hamiltonian
) -> list[str]:
    probe = probe_of(trial.step, how)
    return measure_clock_mistakes(probe, hamiltonian, trial.places, finding.convergence_order)
