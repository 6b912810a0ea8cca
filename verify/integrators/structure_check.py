"""The examination of what a user's step or map keeps: each structure that is claimed, no others.

The code is traced with symbols and proved, as far as that decides; what is left is measured at the
places, with dual numbers or floats.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

from verify.integrators.kept_proof import Proofs, prove_map, prove_step
from verify.integrators.kept_structures import combine, judge, leave_open
from verify.integrators.measures.distances import STEP_DIVISORS, find_periods, flow_of
from verify.integrators.measures.float_probe import FloatProbe
from verify.integrators.measures.kept_measurement import KeptSurvey
from verify.integrators.measures.measurement_notes import describe_places
from verify.integrators.measures.way_back import go_back
from verify.integrators.places.units import FloatField
from verify.integrators.places.wrap_periods import Periods
from verify.integrators.preparation import measure_misfit
from verify.integrators.results import Finding, KeptStructure
from verify.integrators.trace_proof import notes_of
from verify.integrators.trial import Trial
from verify.integrators.user_code.step import describe_error, limit_time, unless_it_fails
from verify.prose import Prose, join_prose, prose
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric
from verify.verdict import Verdict, worst_of

_SHARE_FOR_PROOF = 1 / 3  # a part of the time that is left, for the trace and for all proofs
_MAX_PROOF_SECONDS = 6.0
_NO_STEP_MISFIT = 0.5  # a small step that is off by such a part of its length follows another field
_NO_STEP = "it is no step of this system: it does not agree with the flow up to h"


def examine_structures(trial: Trial, try_proof: bool, fault: str) -> Finding:
    """Return the finding on what a step or a map is claimed to keep.

    `try_proof`: False if the function may differ from call to call. `fault`: one that allows no
    verdict but a refutation; "" for none.
    """
    examination = _Examination(trial)
    keeps = examination.measure(examination.prove(try_proof))
    return examination.finding([_limit(x, fault) for x in keeps] if fault else keeps)


@dataclass
class _Examination:
    """The structures of a trial, and what is known of its map."""

    trial: Trial
    notes: list[Prose] = field(default_factory=list)
    order: int | None = None  # of the map, where a proof has it
    follows_flow: bool = True

    def finding(self, keeps: Sequence[KeptStructure]) -> Finding:
        """Return the finding with these verdicts, of which the worst is its own."""
        verdicts = [x.verdict or Verdict.UNDECIDED for x in keeps]
        verdict = worst_of(verdicts)
        reasons = [prose(x.structure.label, ": ", x.reason)
                   for x, y in zip(keeps, verdicts, strict=True) if y is verdict]  # fmt: skip
        no_step = self.order is not None and self.order < 1 and not self._periods
        if not self.follows_flow or no_step:
            # A step that does nothing keeps everything.
            verdict = worst_of([verdict, Verdict.UNDECIDED])
            reasons.append(Prose(_NO_STEP))
        # Where everything is proved nothing was measured, and the domains are those of the proofs.
        how = max((x.how for x in keeps), key=("proof", "duals", "floats", "calls").index)
        step, places = self.trial.step, self.trial.places if how != "proof" else []
        ranges = [str(describe_places(step, places))] if places else [
            text for x in keeps for text in x.domain.texts
        ]  # fmt: skip
        return Finding(
            verdict, join_prose("; ", reasons), how, step.degrees,
            convergence_order=self.order, order_decided=self.order is not None,
            notes=tuple(self.notes), domain=tuple(dict.fromkeys(ranges)), places=tuple(places),
            counterexample=next((x.counterexample for x in keeps if x.counterexample), None),
            keeps=tuple(keeps),
        )  # fmt: skip

    # -- proofs -----------------------------------------------------------------------------------

    def prove(self, try_proof: bool) -> Proofs:
        """Return the proofs, None for each structure of which algebra decides nothing."""
        trial, step, claims = self.trial, self.trial.step, self.trial.keeps
        if step.foreign:
            return [None] * len(claims)
        seconds = min(_MAX_PROOF_SECONDS, max(step.seconds_left, 0.1) * _SHARE_FOR_PROOF)
        try:
            with limit_time(seconds, "its trace takes too long"):
                trace = trial.trace(agrees=try_proof)
            if not try_proof:
                return [None] * len(claims)
            if trial.hamiltonian is None:
                proofs = prove_map(trace, step.names, claims, seconds)
            else:
                proofs, self.order = prove_step(trace, trial.hamiltonian, claims, seconds)
            self.notes += notes_of(trace.tape) if any(proofs) else []
            return proofs
        except Exception as error:  # the user's code may raise anything
            self.notes.append(prose("no proof: ", describe_error(error)))
            return [None] * len(claims)

    # -- measurements -----------------------------------------------------------------------------

    def measure(self, proofs: Proofs) -> list[KeptStructure]:
        """Return the verdicts on all structures; what is proved to be kept is not measured."""
        problems = list[Prose]()
        keeps: list[KeptStructure | None] = [x if x and x.verdict and x.verdict.holds else None
                                             for x in proofs]  # fmt: skip
        if self.order is None and self.trial.hamiltonian is not None:
            self.follows_flow = self._may_follow(FloatField(self.trial.hamiltonian))
        for how in () if all(keeps) else self.trial.step.try_probes():
            problems += self._measure_with(how, keeps, proofs)
            if all(keeps):
                break
        reason = problems[-1] if problems else "it can be neither traced nor measured"
        self.notes += problems[:-1] if not all(keeps) else []
        triples = zip(keeps, proofs, self.trial.keeps, strict=True)
        return [self._with_way_back(x or y or leave_open(claim, reason)) for x, y, claim in triples]

    def _measure_with(
        self, how: str, keeps: list[KeptStructure | None], proofs: Proofs
    ) -> list[Prose]:
        """Add the verdicts that are missing, by measurements of one kind; return problems."""
        problems = list[Prose]()
        try:
            survey = KeptSurvey(self.trial.probe(how), self.trial.places, self._periods)
        except Exception as error:  # the user's code may raise anything
            return [prose(f"not measured with {how}: ", describe_error(error))]
        for k, claim in enumerate(self.trial.keeps):
            if keeps[k] is None:
                try:
                    measurement = survey.measure(claim.structure)
                    kept = judge(self.trial.step, claim, measurement, self.trial.request.within)
                    keeps[k] = combine(proofs[k], kept)
                except Exception as error:  # the user's code may raise anything
                    problems.append(prose(f"not measured with {how}: ", describe_error(error)))
        return problems

    def _with_way_back(self, kept: KeptStructure) -> KeptStructure:
        """Add what is lost on the way back in the code's own numbers."""
        structure = kept.structure
        if not isinstance(structure, Reversible | Symmetric):
            return kept
        way = go_back(self.trial.step, structure, self.trial.places, self._periods)
        if way is not None and way.ignores_sign and kept.verdict is Verdict.REFUTED:
            clause = ": it takes |h|, so that its step of −h is that of h"
            return replace(kept, way_back=way, reason=prose(kept.reason, clause))
        return replace(kept, way_back=way)

    @cached_property
    def _periods(self) -> Periods:
        """The periods by which the step reduces its coordinates, where they are needed."""
        system, step = self.trial.hamiltonian, self.trial.step
        leads_back = any(isinstance(x.structure, Reversible | Symmetric) for x in self.trial.keeps)
        is_needed = leads_back or (self.order is not None and self.order < 1)
        if not is_needed or system is None or system.energy is None:
            return ()
        probe, divisor = FloatProbe(step), STEP_DIVISORS[-1] ** 3
        flow = flow_of(system, probe)
        find = partial(find_periods, step, probe, flow, system, self.trial.places, divisor)
        return unless_it_fails(find) or ()

    def _may_follow(self, field_: FloatField) -> bool:
        """Return False if small steps lead elsewhere than the system's field does."""
        misfits = [unless_it_fails(partial(measure_misfit, self.trial.step, x, field_))
                   for x in self.trial.places]  # fmt: skip
        numbers = [x for x in misfits if x is not None]
        return not numbers or min(numbers) < _NO_STEP_MISFIT


def _limit(kept: KeptStructure, fault: str) -> KeptStructure:
    """Return the verdict as a fault allows it; a refutation stands."""
    if kept.verdict is Verdict.REFUTED:
        return kept
    reason = prose(fault, " (", kept.reason, ")")
    return replace(kept, verdict=Verdict.UNDECIDED, exact=None, reason=reason)
