"""The check of what a user's step or map keeps: each structure that is claimed, and no others.

The code is traced with symbols and proved, as far as that decides; what is left is measured at the
places, with dual numbers or floats. Faults, such as results that change from call to call, leave
everything undecided, since a claim on such a step cannot be checked.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.kept_proof import Proofs, prove_map, prove_step
from verify.integrators.kept_structures import combine, judge, leave_open
from verify.integrators.map_claims import check_map_claim
from verify.integrators.measures.agreement import must_agree, trace_must_agree
from verify.integrators.measures.distances import STEP_DIVISORS, find_periods, flow_of
from verify.integrators.measures.float_probe import FloatProbe
from verify.integrators.measures.kept_measurement import KeptSurvey
from verify.integrators.measures.measurement_notes import describe_places
from verify.integrators.measures.probes import DualProbe, probe_of
from verify.integrators.measures.survey import NO_REQUEST, Request
from verify.integrators.measures.way_back import go_back
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.units import FloatField
from verify.integrators.places.wrap_periods import Periods
from verify.integrators.preparation import (
    measure_misfit,
    note_time,
    prepare_map,
    prepare_step,
)
from verify.integrators.results import Finding, KeptStructure
from verify.integrators.trace_proof import notes_of, trace_of
from verify.integrators.user_code.faults import Fault, find_changes, find_faults
from verify.integrators.user_code.loading import Callee
from verify.integrators.user_code.repetition import find_repetition_faults
from verify.integrators.user_code.step import describe_error, limit_time, unless_it_fails
from verify.integrators.user_code.user_map import UserMap
from verify.proof.structures.structure_order import check_structure
from verify.prose import Prose, join_prose, prose
from verify.structures.reading import ClaimedStructure
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric
from verify.verdict import Verdict, worst_of

_SHARE_FOR_PROOF = 1 / 3  # a part of the time that is left, for the trace and for all proofs
_MAX_PROOF_SECONDS = 6.0
_SHARE_FOR_FLOATS = 0.4  # a part of the time that is left; dual numbers, which are slow, come first
_NO_STEP_MISFIT = 0.5  # a small step that is off by such a part of its length follows another field
_NO_STEP = "it is no step of this system: it does not agree with the flow up to h"


def check_step_keeps(
    callee: Callee,
    system: Hamiltonian,
    claims: Sequence[ClaimedStructure],
    request: Request = NO_REQUEST,
) -> Finding:
    """Run the user's code, a step for H or for equations, and judge what it is claimed to keep.

    Raises InputError if the exact flow does not keep a structure, and as `prepare_step` does.
    """
    claims = [
        replace(x, structure=x.structure.with_values(system.value_substitutions)) for x in claims
    ]
    for claim in claims:
        check_structure(system, claim.structure)
    places, notes = prepare_step(callee, system, request)
    trial = _Trial(callee.step, system, places, claims, request)
    if not places:
        return trial.end("its equations have no solution from any of the places that are tried")
    return trial.judge().noting(*notes, *note_time(callee.step))


def check_map_keeps(
    callee: Callee, claims: Sequence[ClaimedStructure], request: Request = NO_REQUEST
) -> Finding:
    """Run the user's code, a map, and judge what it is claimed to keep.

    Raises InputError if the formulas make no structure, or one that only a step may have.
    """
    for claim in claims:
        check_map_claim(claim, callee.step.names)
    places, notes = prepare_map(callee, request)
    return _Trial(callee.step, None, places, claims, request).judge().noting(*notes)


@dataclass
class _Trial:
    """A step or a map, with what it is claimed to keep."""

    step: UserMap
    system: Hamiltonian | None
    places: list[TrialPlace]
    claims: Sequence[ClaimedStructure]
    request: Request
    notes: list[Prose] = field(default_factory=list)
    order: int | None = None  # of the map, where a proof has it
    follows_flow: bool = True

    def judge(self) -> Finding:
        """Look for faults, prove and measure, and return the finding."""
        step = self.step
        faults, first_results = find_faults(step, self.places)
        if not any(fault.fatal for fault in faults):
            faults += find_repetition_faults(step, self.places)
        fatal = [fault for fault in faults if fault.fatal]
        if fatal:
            return self.end(fatal[0].text, faults)
        proofs = self._prove(all(fault.allows is Verdict.PROVED for fault in faults))
        keeps = self._measure(proofs)
        changes = find_changes(step, first_results)
        if changes:
            return self.end(changes[0].text, [*faults, *changes])
        limiting = [fault for fault in faults if fault.allows is Verdict.UNDECIDED]
        if limiting:
            keeps = [_limit(x, limiting[0].text) for x in keeps]
        return self._finding(keeps, faults)

    def end(self, reason: str, faults: Sequence[Fault] = ()) -> Finding:
        """Return the finding that nothing is decided, for one reason."""
        return self._finding([leave_open(x, reason) for x in self.claims], faults)

    def _finding(self, keeps: Sequence[KeptStructure], faults: Sequence[Fault]) -> Finding:
        verdicts = [x.verdict or Verdict.UNDECIDED for x in keeps]
        verdict = worst_of(verdicts)
        reasons = [prose(x.structure.label, ": ", x.reason)
                   for x, y in zip(keeps, verdicts, strict=True) if y is verdict]  # fmt: skip
        no_step = self.order is not None and self.order < 1 and not self._periods
        if not self.follows_flow or no_step:
            # A step that does nothing keeps everything.
            verdict = worst_of([verdict, Verdict.UNDECIDED])
            reasons.append(Prose(_NO_STEP))
        if any(fault.fatal for fault in faults):
            reasons = reasons[:1] and [prose(next(x.text for x in faults if x.fatal))]
        example = next((x.counterexample for x in keeps if x.counterexample), None)
        # Where everything is proved nothing was measured, and the domains are those of the proofs.
        how = max((x.how for x in keeps), key=("proof", "duals", "floats", "calls").index)
        places = self.places if how != "proof" else []
        ranges = [str(describe_places(self.step, places))] if places else [
            text for x in keeps for text in x.domain.texts
        ]  # fmt: skip
        return Finding(
            verdict, join_prose("; ", reasons), how, self.step.degrees,
            convergence_order=self.order, order_decided=self.order is not None,
            notes=(*self.notes, *map(prose, (x.text for x in faults if not x.fatal))),
            faults=tuple(x.name for x in faults), counterexample=example,
            domain=tuple(dict.fromkeys(ranges)), places=tuple(places), keeps=tuple(keeps),
        )  # fmt: skip

    # -- proofs -----------------------------------------------------------------------------------

    def _prove(self, try_proof: bool) -> Proofs:
        step, nothing = self.step, [None] * len(self.claims)
        if step.foreign:
            return [*nothing]
        seconds = min(_MAX_PROOF_SECONDS, max(step.seconds_left, 0.1) * _SHARE_FOR_PROOF)
        try:
            with limit_time(seconds, "its trace takes too long"):
                trace = trace_of(step)
                impure = trace.tape.surroundings.texts
                if impure or not try_proof:
                    return [*nothing]
                trace_must_agree(step, trace.outputs, self.places)
            if self.system is None:
                proofs = prove_map(trace, step.names, self.claims, seconds)
            else:
                proofs, self.order = prove_step(trace, self.system, self.claims, seconds)
            self.notes += notes_of(trace.tape) if any(proofs) else []
            return proofs
        except Exception as error:  # the user's code may raise anything
            self.notes.append(prose("no proof: ", describe_error(error)))
            return [*nothing]

    # -- measurements -----------------------------------------------------------------------------

    def _measure(self, proofs: Proofs) -> list[KeptStructure]:
        """Return the verdicts on all structures; what is proved to be kept is not measured."""
        step = self.step
        keeps: list[KeptStructure | None] = [x if x and x.verdict and x.verdict.holds else None
                                             for x in proofs]  # fmt: skip
        if self.order is None and self.system is not None:
            self.follows_flow = self._may_follow(self.system)
        problems, reserve = list[Prose](), _SHARE_FOR_FLOATS * max(step.seconds_left, 0)
        for how in step.probe_kinds:
            if all(keeps):
                break
            if len(step.probe_kinds) > 1:
                step.hold_back(reserve if how == "duals" else -reserve)
            problems += self._measure_with(how, keeps, proofs)
        reason = problems[-1] if problems else "it can be neither traced nor measured"
        self.notes += problems[:-1] if not all(keeps) else []
        return [self._with_way_back(x or proof or leave_open(claim, reason))
                for x, proof, claim in zip(keeps, proofs, self.claims, strict=True)]  # fmt: skip

    def _measure_with(
        self, how: str, keeps: list[KeptStructure | None], proofs: Proofs
    ) -> list[Prose]:
        """Add the verdicts that are missing, by measurements of one kind; return problems."""
        problems = list[Prose]()
        try:
            probe = probe_of(self.step, how)
            if isinstance(probe, DualProbe):
                must_agree(probe, self.places)
            survey = KeptSurvey(probe, self.places, self._periods)
        except Exception as error:  # the user's code may raise anything
            return [prose(f"not measured with {how}: ", describe_error(error))]
        for k, claim in enumerate(self.claims):
            if keeps[k] is None:
                try:
                    measurement = survey.measure(claim.structure)
                    kept = judge(self.step, claim, measurement, self.request.within)
                    keeps[k] = combine(proofs[k], kept)
                except Exception as error:  # the user's code may raise anything
                    problems.append(prose(f"not measured with {how}: ", describe_error(error)))
        return problems

    def _with_way_back(self, kept: KeptStructure) -> KeptStructure:
        """Add what is lost on the way back in the code's own numbers."""
        structure = kept.structure
        if not isinstance(structure, Reversible | Symmetric):
            return kept
        way = go_back(self.step, structure, self.places, self._periods)
        if way is not None and way.ignores_sign and kept.verdict is Verdict.REFUTED:
            clause = ": it takes |h|, so that its step of −h is that of h"
            return replace(kept, way_back=way, reason=prose(kept.reason, clause))
        return replace(kept, way_back=way)

    @cached_property
    def _periods(self) -> Periods:
        """The periods by which the step reduces its coordinates, where they are needed."""
        system, step = self.system, self.step
        leads_back = any(isinstance(x.structure, Reversible | Symmetric) for x in self.claims)
        is_needed = leads_back or (self.order is not None and self.order < 1)
        if not is_needed or system is None or system.energy is None:
            return ()
        probe, divisor = FloatProbe(step), STEP_DIVISORS[-1] ** 3
        flow = flow_of(system, probe)
        find = partial(find_periods, step, probe, flow, system, self.places, divisor)
        return unless_it_fails(find) or ()

    def _may_follow(self, system: Hamiltonian) -> bool:
        """Return False if small steps lead elsewhere than the system's field does."""
        field_ = FloatField(system)
        misfits = [unless_it_fails(partial(measure_misfit, self.step, x, field_))
                   for x in self.places]  # fmt: skip
        numbers = [x for x in misfits if x is not None]
        return not numbers or min(numbers) < _NO_STEP_MISFIT


def _limit(kept: KeptStructure, fault: str) -> KeptStructure:
    """Return the verdict as a fault allows it; a refutation stands."""
    if kept.verdict is Verdict.REFUTED:
        return kept
    reason = prose(fault, " (", kept.reason, ")")
    return replace(kept, verdict=Verdict.UNDECIDED, exact=None, reason=reason)
