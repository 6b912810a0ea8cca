"""The trial of a user's step or map: its measurement, and the judgement of what is claimed of it.

A claim that fails gets a counterexample, a place at which anybody can see it fail. A place is a
state with a time, a largest step size and the units of its coordinates.
"""

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.agreement import must_agree, trace_must_agree
from verify.integrators.measures.distances import Distances, distances_of
from verify.integrators.measures.error_powers import Row
from verify.integrators.measures.measurement import REFUTING_RATIO
from verify.integrators.measures.probes import DualProbe, Probe, probe_of
from verify.integrators.measures.reading import DefectReading, Reading
from verify.integrators.measures.structure_measurement import StructureMeasurement, structure_of
from verify.integrators.measures.survey import NO_REQUEST, Request
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.results import NO_CLAIMS, Claims, Counterexample, Finding, judge_claims
from verify.integrators.trace_proof import Trace, trace_of
from verify.integrators.user_code.step import StepError
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, join_prose, prose
from verify.structures.reading import ClaimedStructure
from verify.verdict import Verdict

# The structure, None for equations; and the distances from the exact flow, None for a map.
Measurement = tuple[StructureMeasurement | None, Distances | None]
# A quantity refutes a power of h if its slope is lower by this number; the higher terms of a
# correct step change a slope by less.
_REFUTING_DEFICIT = 0.4
_CLEAR_SHARE = 0.8  # a deficit is clear if it is this part of the largest deficit
_NOISE_FACTOR = 10  # a value shows a power only if it is larger than its noise by this factor
_MAX_LISTED = 3  # names of impure objects in a message
_MAX_PLACES_SHOWN = 3  # failing places at which a counterexample is looked for
_VERDICTS = {"proof": Verdict.PROVED, "duals": Verdict.MEASURED, "floats": Verdict.MEASURED}


@dataclass
class Trial:
    """A user's step or map, the system that it is for, the places at which it is tried, and what is
    claimed: of the map, and of the structures that it keeps."""

    step: UserMap
    hamiltonian: Hamiltonian | None
    places: list[TrialPlace]
    claims: Claims = NO_CLAIMS
    request: Request = NO_REQUEST
    keeps: Sequence[ClaimedStructure] = ()
    _trace: Trace | None = field(default=None, init=False, repr=False)
    _last: Measurement | None = field(default=None, init=False, repr=False)

    @property
    def of_equations(self) -> bool:
        """True of a step for equations without an H."""
        return self.hamiltonian is not None and self.hamiltonian.energy is None

    def trace(self, *, agrees: bool = True) -> Trace:
        """Call the step with symbols, and return the trace, which `agrees` with the step's floats.

        Raises StepError if the code reaches objects that may change from call to call,
        UntraceableError, and what the user's code raises.
        """
        if self._trace is None:
            trace = trace_of(self.step)
            if impure := trace.tape.surroundings.texts:
                names = join_prose(", ", map(prose, impure[:_MAX_LISTED]))
                raise StepError(prose("what it reaches may change from call to call: ", names))
            if not agrees:
                return trace
            trace_must_agree(self.step, trace.outputs, self.places)
            self._trace = trace
        return self._trace

    def probe(self, how: str) -> Probe:
        """Return the probe called `how`, "duals" or "floats", for this step.

        Raises UntraceableError if dual numbers take another branch of the code than floats do: they
        would then measure another map.
        """
        probe = probe_of(self.step, how)
        if isinstance(probe, DualProbe):
            must_agree(probe, self.places)
        return probe

    def measure(self, how: str, ladder: Sequence[Fraction] = ()) -> Measurement:
        """Measure the structure and the distances, by dual numbers or by floats.

        `how`: the kind of probe, "duals" or "floats". `ladder`: step sizes in place of the usual
        ones. Raises StepError, and what the user's code raises.
        """
        probe, system = self.probe(how), self.hamiltonian
        structure, distances, places = None, None, self.places
        if not self.of_equations:
            structure = structure_of(self.step, probe, places)
            places = list(dict.fromkeys(x.place for x in structure.readings))
        if system is not None:
            distances = distances_of(self.step, probe, system, places, ladder)
        self._last = structure, distances
        return self._last

    @property
    def evidence(self) -> Measurement | None:
        """The measurement in which a claim may be seen to fail: the last one, else a new one, by
        the first kind of probe that succeeds; None if none does."""
        for how in self.step.probe_kinds:
            if self._last is None:
                with suppress(Exception):  # the user's code may raise anything
                    self.measure(how)
        return self._last


# -- the claims -----------------------------------------------------------------------------------


def apply_claims(finding: Finding, trial: Trial) -> Finding:
    """Return the finding with the verdict on the claims.

    - If a claim is false, or the step is no scheme, it is REFUTED, with a counterexample.
    - Otherwise it is UNDECIDED if a claim is undecided.
    - If all claims hold, and the step is shown to be a scheme, it is PROVED or MEASURED, even if
      the finding left another question open.
    """
    judged_claims = judge_claims(trial.claims, finding)
    not_shown = [claim for claim in judged_claims if claim.holds is not True]
    false = [claim for claim in not_shown if claim.holds is False]
    if not not_shown and finding.verdict is not Verdict.REFUTED:
        is_open = finding.verdict is Verdict.UNDECIDED and trial.claims != NO_CLAIMS
        return (
            replace(finding, verdict=_VERDICTS[finding.how])
            if is_open and finding.scheme
            else finding
        )
    if not false and finding.verdict is not Verdict.REFUTED:
        return replace(
            finding,
            verdict=Verdict.UNDECIDED,
            reason=prose(not_shown[0].name, " is claimed and not decided: ", finding.reason),
        )
    if finding.verdict is Verdict.REFUTED:
        claims_that_hold = [claim.name for claim in judged_claims if claim.holds]
        finding = _add_claims_that_hold(finding, claims_that_hold)
    if false:
        name = false[0].name
        reason = prose(name, " is claimed; ", false[0].evidence, " (", finding.reason, ")")
        finding = replace(finding, verdict=Verdict.REFUTED, reason=reason)
    else:
        name = prose("order 1")
    return replace(finding, counterexample=counterexample(str(name), trial))


def _add_claims_that_hold(finding: Finding, claims: Sequence[Prose]) -> Finding:
    """Add to the reason of a refuted order the claims that hold nevertheless."""
    area = [prose("det J ≡ 1")] if finding.area_preserving else []
    # det J ≡ 1 implies every claim on the order of ΔJ, so that it stands alone.
    statements = area or claims
    if not statements:
        return finding
    how_shown = "proved" if finding.how == "proof" else "measured"
    claim_names = join_prose(" and ", statements)
    reason = prose(
        "the order is refuted, not ", claim_names, f", which is {how_shown}: ", finding.reason
    )
    return replace(finding, reason=reason)


# -- a counterexample -----------------------------------------------------------------------------


def counterexample(name: str, trial: Trial) -> Counterexample | None:
    """Return a counterexample to the claim of that name; None if no place shows it."""
    (structure, distances), step = trial.evidence or (None, None), trial.step
    if name in ("det J ≡ 1", "that it is symplectic"):
        if structure is None or structure.ratio <= REFUTING_RATIO:
            return None
        # The reading with the largest defect is the easiest to confirm by hand.
        return counterexample_of_reading(step, structure.largest, name)
    if name.startswith("ΔJ"):
        ladder = structure.ladder if structure else ()
        return find_slow_reading(step, ladder, trial.claims.area_order or 1, "|det J − 1|")
    return counterexample_of_order(step, distances, trial.claims.order or 1)


def counterexample_of_order(
    step: UserMap, distances: Distances | None, order: int
) -> Counterexample | None:
    """Return a place at which the distance from the exact flow refutes the order, or None."""
    failing = sorted(
        (x for x in (distances.places if distances else ()) if x.rows),
        # The places of the lowest power come first, those without a power last.
        key=lambda x: x.power if x.power is not None else 99,
    )
    quantity = "the distance of {}' from the exact flow after one step"
    candidates = (
        find_slow_shrinking(step, x.place, x.rows, order + 1, quantity.format(x.component))
        for x in failing[:_MAX_PLACES_SHOWN]
    )
    return next((x for x in candidates if x is not None), None)


def counterexample_of_reading(step: UserMap, reading: DefectReading, name: str) -> Counterexample:
    """Build the counterexample of a reading in which an entry of S, or det J − 1, is not 0."""
    of_volume = name == "det J ≡ 1" and abs(reading.volume) > REFUTING_RATIO * reading.volume_noise
    if step.degrees == 1 or of_volume:
        value = f"{reading.volume:.6e} ± {reading.volume_noise:.1e}"
        return counterexample_at(step, reading.place, reading.h, "det J − 1", value)
    indices, x = reading.largest
    quantity = f"the entry {step.entry_name(indices)} of S"
    return counterexample_at(step, reading.place, reading.h, quantity, str(x))


def counterexample_at(
    step: UserMap, place: TrialPlace, h: Fraction, quantity: str, value: str, expected: str = "0"
) -> Counterexample:
    """Build the counterexample of a quantity at a place."""
    z, t = dict(zip(step.names, place.z, strict=True)), place.t if step.time_dependent else None
    return Counterexample(z, h if step.takes_step_size else None, quantity, value, expected, t)


def find_slow_reading(
    step: UserMap, ladder: Sequence[Sequence[Reading[Any]]], power: int, name: str
) -> Counterexample | None:
    """Return the first counterexample among readings as h falls, of a defect that shrinks more
    slowly than h^power."""
    candidates = (
        find_slow_shrinking(step, readings[0].place, [x.row for x in readings], power, name)
        for readings in ladder
        if readings
    )
    return next((x for x in candidates if x is not None), None)


def find_slow_shrinking(
    step: UserMap, place: TrialPlace, rows: Sequence[Row], power: int, name: str
) -> Counterexample | None:
    """Return the counterexample of a quantity that shrinks more slowly than h^power.

    `rows`: step sizes, falling, each with the value and its noise. Among the pairs of neighbouring
    step sizes that show this clearly, the one with the largest step sizes is taken.
    """
    pairs: list[tuple[float, float, float, float, float]] = []
    for (large, large_value, large_noise), (small, small_value, small_noise) in pairwise(rows):
        # Both values must be well above their noise, else their ratio tells nothing of a power.
        is_clear = large_value > _NOISE_FACTOR * large_noise
        if is_clear and small_value > _NOISE_FACTOR * small_noise:
            bound = large_value * (small / large) ** power
            # If the value is proportional to h^r, this is power − r.
            deficit = math.log(small_value / bound) / math.log(large / small)
            pairs.append((deficit, small, small_value, bound, large))
    largest_deficit = max((deficit for deficit, *_ in pairs), default=0.0)
    if largest_deficit < _REFUTING_DEFICIT:
        return None
    _, h, value, bound, larger_step = next(
        pair for pair in pairs if pair[0] >= _CLEAR_SHARE * largest_deficit
    )
    expected = f"about {bound:.2e} for O(h^{power}), by that at h = {Fraction(larger_step)}"
    return counterexample_at(step, place, Fraction(h), name, f"{value:.6e}", expected)
