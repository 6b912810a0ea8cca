"""The examination of a user's step or map: by proof if possible, else by measurement at its places.

If the code can be called with symbols, the map is proved, and the questions that algebra leaves
open are measured. Otherwise all is measured, with dual numbers if the code takes them, or else with
floats. S = JᵀΩJ − Ω is the defect of the symplectic form, where J is the Jacobian of the map; in
the plane S is ΔJ = det J − 1 times Ω.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.clocks import clock_mistakes, measure_clock_mistakes
from verify.integrators.measured_finding import ORDER_SEPARATOR, finding_from_measurement
from verify.integrators.measures.probes import probe_of
from verify.integrators.results import Finding
from verify.integrators.trace_proof import Trace, prove_map, prove_order, prove_step
from verify.integrators.trial import Trial
from verify.integrators.user_code.step import describe_error, limit_time
from verify.prose import Prose, prose
from verify.verdict import Verdict

_SHARE_FOR_PROOF = 1 / 3  # a part of the time that is left
_CLOCK_SECONDS = 10.0
_MAX_PROOF_SECONDS = 20.0
# With three degrees of freedom and more algebra seldom ends in time.
_MAX_PROOF_SECONDS_IN_MANY_DEGREES = 6.0


def examine(trial: Trial, try_proof: bool) -> Finding:
    """Return the finding on a step or a map.

    `try_proof`: False if the function may differ from call to call. It is traced even then, since
    the trace may raise, and its error becomes a note.
    """
    step, notes = trial.step, list[Prose]()
    if step.foreign:
        return _measure(trial, notes)
    try:
        limit = _MAX_PROOF_SECONDS if step.degrees < 3 else _MAX_PROOF_SECONDS_IN_MANY_DEGREES
        seconds = min(limit, max(step.seconds_left, 0.1) * _SHARE_FOR_PROOF)
        with limit_time(seconds, "its proof takes too long"):
            trace = trial.trace(agrees=try_proof)
            finding = _prove(trial, trace) if try_proof else None
        if finding is None:
            return _measure(trial, notes)
        if trial.of_equations:
            return finding
        finding = _decide(finding, trial, trace)
        order = finding.convergence_order
        return finding.noting(
            *_note_clock(trial, lambda system: clock_mistakes(system, trace.outputs, order))
        )
    except Exception as error:  # the user's code may raise anything
        notes.append(prose("no proof: ", describe_error(error)))
    return _measure(trial, notes)


def _prove(trial: Trial, trace: Trace) -> Finding:
    if trial.hamiltonian is None:
        return prove_map(trace, trial.step.names)
    return (prove_order if trial.of_equations else prove_step)(trace, trial.hamiltonian)


def _decide(finding: Finding, trial: Trial, trace: Trace) -> Finding:
    """Complete the finding of a proof by measurement if the proof leaves a question open.

    Rounded coefficients, floats that are read as no simple number, approximate the ones that are
    meant. Of a trace with such coefficients no order is proved, and S ≢ 0 is not, as the rounding
    may cause it; S ≡ 0 is proved, as it holds for the coefficients of the code.
    """
    is_rounded, symplectic = bool(trace.tape.rounded), finding.symplectic
    of_map = trial.hamiltonian is None
    # A refuted step is no scheme: nothing more is measured of it.
    symplecticity_open = symplectic is None and finding.verdict is not Verdict.REFUTED
    volume_open = symplectic is False and finding.area_preserving is None
    if of_map and symplectic:
        return finding
    if not (is_rounded or symplecticity_open or volume_open or of_map):
        return finding
    try:
        measurement = finding_from_measurement(trial, *trial.measure("duals"))
    except Exception as error:  # the user's code may raise anything
        return finding.noting(prose("not measured: ", describe_error(error)))
    measured_finding = replace(measurement, notes=(*finding.notes, *measurement.notes))
    if of_map:
        return (
            measured_finding
            if is_rounded or symplecticity_open
            else _refute_map(finding, measured_finding)
        )
    if is_rounded:
        return _combine_despite_rounding(finding, measured_finding)
    if symplecticity_open:
        return _combine_with_series(finding, measured_finding)
    return replace(finding, area_preserving=measured_finding.area_preserving)


def _combine_despite_rounding(finding: Finding, measured_finding: Finding) -> Finding:
    """Combine the measured order with the proof that Ω is preserved, if there is one."""
    order_text, _, defect_text = measured_finding.reason.partition(ORDER_SEPARATOR)
    exact_order = finding.convergence_order
    clause = "but for the rounding of its coefficients"
    if exact_order is not None and exact_order != measured_finding.convergence_order:
        clause += f" (taken exactly, they make the order {exact_order})"
    if not finding.symplectic:
        reason = prose(order_text, f", {clause}; ", defect_text)
        return replace(measured_finding, reason=reason)
    statement = "det J ≡ 1, proved" if finding.degrees == 1 else "S ≡ 0, proved"
    verdict = measured_finding.verdict
    if verdict is Verdict.UNDECIDED and measured_finding.order_decided:
        verdict = Verdict.MEASURED
    return replace(
        measured_finding, verdict=verdict, reason=prose(order_text, f", {clause}; ", statement),
        order=None, symplectic=True, area_preserving=True,
    )  # fmt: skip


def _combine_with_series(finding: Finding, measured_finding: Finding) -> Finding:
    """Combine the measured defect of Ω with the order and the series that a proof has."""
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


def _refute_map(finding: Finding, measured_finding: Finding) -> Finding:
    """Refute a map by algebra if the measurement shows its defect too; else return the measured
    finding, since a refutation needs a place at which anybody can see it."""
    volume = finding.area_preserving
    if volume is None:
        volume = measured_finding.area_preserving
    # By algebra S is not 0, but it is too small for doubles to show.
    if measured_finding.symplectic is not False:
        return measured_finding
    identity = "≡ 1" if finding.area_preserving else "is 1 where it was measured,"
    volume_text = f"; det J {identity} all the same" if volume else ""
    entry = measured_finding.entry or finding.entry
    reason = prose(f"it is not symplectic: the entry {entry} of S is not 0{volume_text}")
    return replace(finding, reason=reason, area_preserving=volume, entry=entry,
                   largest=measured_finding.largest, probe_error=measured_finding.probe_error,
                   against=measured_finding.against, places=measured_finding.places)  # fmt: skip


def _note_clock(trial: Trial, find_mistakes: Callable[[Hamiltonian], list[str]]) -> list[str]:
    """Return notes on the times at which the step reads H, if they look like a mistake.

    The analysis exists in the plane alone, for an H that depends on t.
    """
    step, system = trial.step, trial.hamiltonian
    if system is None or trial.of_equations or not step.time_dependent or step.degrees > 1:
        return []
    try:
        with limit_time(_CLOCK_SECONDS, "its clock takes too long"):
            return find_mistakes(system)
    except Exception:  # the user's code may raise anything
        return []


def _measure(trial: Trial, notes: list[Prose]) -> Finding:
    """Return the finding of the first kind of probe that works; each failure becomes a note."""
    for how in trial.step.try_probes():
        try:
            finding = finding_from_measurement(trial, *trial.measure(how))
            finding = replace(finding, notes=(*notes, *finding.notes))
            find_mistakes = partial(_find_clock_mistakes, trial, how, finding)
            return finding.noting(*_note_clock(trial, find_mistakes))
        except Exception as error:  # the user's code may raise anything
            notes.append(prose(f"not measured with {how}: ", describe_error(error)))
    message = prose("it can be neither traced nor measured")
    finding = Finding(Verdict.UNDECIDED, message, how="calls", degrees=trial.step.degrees)
    return finding.noting(*notes)


def _find_clock_mistakes(
    trial: Trial, how: str, finding: Finding, hamiltonian: Hamiltonian
) -> list[str]:
    """Measure the times at which the step reads H, and describe the mistakes that they show."""
    probe = probe_of(trial.step, how)
    return measure_clock_mistakes(probe, hamiltonian, trial.places, finding.convergence_order)
