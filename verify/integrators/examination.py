"""What is known of a user's step or map at its places: proved, else measured.

Where its code lets symbols through its map is proved, and what algebra leaves open is measured;
else all is, with dual numbers where they go through, or with floats.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measured import finding_of
from verify.integrators.measures.order import probe_of
from verify.integrators.measures.still_clock import measured_mistakes
from verify.integrators.measures.structure import Structure
from verify.integrators.probes.agreement import trace_must_agree
from verify.integrators.results import Finding
from verify.integrators.traced import (
    Trace,
    proved_of_map,
    proved_step,
    trace_of,
)
from verify.integrators.tracing.clocks import clock_mistakes
from verify.integrators.trial import Trial
from verify.integrators.user_code.step import StepError, why, within
from verify.prose import Prose, joined, prose
from verify.verdict import Verdict

_PROOF, _CLOCK_SECONDS = 1 / 3, 10.0  # of the time that is left; seconds
_LISTED = 3  # of what is not pure
_MOST_PROOF, _MOST_OF_MANY = 20.0, 6.0  # seconds; and of three degrees of freedom and more
_KEPT = 0.4  # of the time that is left, for floats after dual numbers, which are slow


def examine(trial: Trial, provable: bool) -> Finding:
    step, notes = trial.step, list[Prose]()
    if step.foreign:
        return _measured(trial, notes)
    try:
        most = _MOST_PROOF if step.degrees < 3 else _MOST_OF_MANY
        with within(min(most, max(step.left, 0.1) * _PROOF), "its proof takes too long"):
            trace = trace_of(step)
            _must_be_pure(trace)
            if provable:
                trace_must_agree(step, trace.roots, trial.places)
                exact = trial.hamiltonian
                finding = proved_step(trace, exact) if exact else proved_of_map(trace, step.names)
        if not provable:
            return _measured(trial, notes)
        finding = _decided(finding, trial, trace)
        order = finding.convergence_order
        return finding.noting(*_clock(trial, lambda h: clock_mistakes(h, trace.roots, order)))
    except Exception as error:  # the user's code may raise anything
        notes.append(prose("no proof: ", why(error)))
    return _measured(trial, notes)


def _must_be_pure(trace: Trace) -> None:
    """StepError where it reaches what is not known to stay the same from call to call."""
    impure = trace.tape.outside.texts
    if impure:
        listed = joined(", ", map(prose, impure[:_LISTED]))
        raise StepError(prose("what it reaches may change from call to call: ", listed))


def _decided(finding: Finding, trial: Trial, trace: Trace) -> Finding:
    """What a proof says, where it says it; else with what is measured of that.

    Rounded coefficients stand for others: of a trace that has them no order is proved, and Ω only
    where it is kept.
    """
    rounded, kept = bool(trace.tape.rounded), finding.symplectic
    of_map = trial.hamiltonian is None
    open_ = kept is None and finding.verdict is not Verdict.REFUTED
    volume_open = kept is False and finding.area_preserving is None
    if of_map and kept:
        return finding
    if not (rounded or open_ or volume_open or of_map):
        return finding
    try:
        structure, distances = trial.measure("duals")
    except Exception as error:  # the user's code may raise anything
        return finding.noting(prose("not measured: ", why(error)))
    alone = finding_of(trial, structure, distances)
    seen = replace(alone, notes=(*finding.notes, *alone.notes))
    if of_map:
        return seen if rounded or open_ else _refuted_map(finding, seen, structure)
    if rounded:
        return _but_for_rounding(finding, seen)
    if open_:
        return _with_series(finding, seen)
    return replace(finding, area_preserving=structure.volume_kept)


def _but_for_rounding(finding: Finding, seen: Finding) -> Finding:
    """What is measured, with what is proved of Ω."""
    order, _, defect = seen.reason.partition("; ")
    exactly = finding.convergence_order
    said = "but for the rounding of its coefficients"
    if exactly is not None and exactly != seen.convergence_order:
        said += f" (taken exactly, they make the order {exactly})"
    if not finding.symplectic:
        return replace(seen, reason=prose(order, f", {said}; ", defect))
    kept = "det J ≡ 1, proved" if finding.degrees == 1 else "S ≡ 0, proved"
    verdict = seen.verdict
    if verdict is Verdict.UNDECIDED and seen.order_decided:
        verdict = Verdict.MEASURED
    return replace(
        seen, verdict=verdict, reason=prose(order, f", {said}; ", kept), order=None,
        symplectic=True, area_preserving=True,
    )  # fmt: skip


def _with_series(finding: Finding, seen: Finding) -> Finding:
    """What is measured of Ω, with the order and the series of a proof that leaves it open."""
    order = finding.convergence_order if finding.order_decided else seen.convergence_order
    return replace(
        seen,
        reason=prose(seen.reason, " (what algebra says: ", finding.reason, ")"),
        convergence_order=order,
        order_decided=finding.order_decided or seen.order_decided,
        leading=finding.leading,
        area_at_least=finding.area_at_least,
    )


def _refuted_map(finding: Finding, seen: Finding, structure: Structure) -> Finding:
    """By algebra, and by dual numbers at places where it shows."""
    volume = finding.area_preserving
    if volume is None:
        volume = structure.volume_kept
    if seen.symplectic is not False:
        return seen  # algebra says it is not 0; it is too small for doubles to show
    where = "≡ 1" if finding.area_preserving else "is 1 where it was measured,"
    kept = f"; det J {where} all the same" if volume else ""
    entry = seen.entry or finding.entry
    reason = prose(f"it is not symplectic: the entry {entry} of S is not 0{kept}")
    return replace(finding, reason=reason, area_preserving=volume, entry=entry,
                   largest=seen.largest, probe_error=seen.probe_error, against=seen.against,
                   places=seen.places)  # fmt: skip


def _clock(trial: Trial, mistakes: Callable[[Hamiltonian], list[str]]) -> list[str]:
    """Which mistake its clock looks like; nothing where that is not seen in time."""
    if trial.hamiltonian is None or not trial.step.moving or trial.step.degrees > 1:
        return []
    try:
        with within(_CLOCK_SECONDS, "its clock takes too long"):
            return mistakes(trial.hamiltonian)
    except Exception:  # the user's code may raise anything
        return []


def _measured(trial: Trial, notes: list[Prose]) -> Finding:
    step = trial.step
    kept = 0.0 if step.foreign else _KEPT * max(step.left, 0)
    for how in step.ways:
        step.hold_back(kept if how == "duals" else -kept)
        try:
            finding = finding_of(trial, *trial.measure(how))
            finding = replace(finding, notes=(*notes, *finding.notes))
            return finding.noting(*_clock(trial, partial(_still, trial, how, finding)))
        except Exception as error:  # as above
            notes.append(prose(f"not measured with {how}: ", why(error)))
    neither = prose("it can be neither traced nor measured")
    return Finding(Verdict.UNDECIDED, neither, "calls", step.degrees).noting(*notes)


def _still(trial: Trial, how: str, finding: Finding, hamiltonian: Hamiltonian) -> list[str]:
    probe = probe_of(trial.step, how)
    return measured_mistakes(probe, hamiltonian, trial.places, finding.convergence_order)
