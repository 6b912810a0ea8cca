"""The trial of a user's step or map: what is measured of it, beside what is claimed.

A claim that fails gets a counterexample, a place at which anybody can see it fail.
"""

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.agreement import must_agree
from verify.integrators.measures.distances import Distances, PlaceOrder, distances_of
from verify.integrators.measures.probes import DualProbe, probe_of
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.structure_measurement import (
    REFUTES,
    StructureMeasurement,
    structure_of,
)
from verify.integrators.measures.survey import NOWHERE, Request
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.results import NOTHING, Claims, Counterexample, Finding, judge_claims
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, join_prose, prose
from verify.verdict import Verdict

# There are no distances of a map, which is for no H.
Measurement = tuple[StructureMeasurement, Distances | None]
_LACKING = 0.4  # of a power of h: a step's other terms make less of it
_PLAINLY = 0.8  # of what is lacking at most
_VERDICTS = {"proof": Verdict.PROVED, "duals": Verdict.MEASURED, "floats": Verdict.MEASURED}


@dataclass
class Trial:
    """A user's step or map, the H that it is for, and the places at which it is tried."""

    step: UserMap
    hamiltonian: Hamiltonian | None
    places: list[TrialPlace]
    claims: Claims = NOTHING
    request: Request = NOWHERE
    _last: Measurement | None = field(default=None, init=False, repr=False)

    def measure(self, how: str, ladder: Sequence[Fraction] = ()) -> Measurement:
        """Measure the structure and the distances, by dual numbers or by floats. Raises StepError,
        and what the user's code raises."""
        probe = probe_of(self.step, how)
        if isinstance(probe, DualProbe):
            # Dual numbers may take another branch than floats do: what they measure would then be
            # of another map.
            must_agree(probe, self.places)
        structure, distances = structure_of(self.step, probe, self.places), None
        if self.hamiltonian is not None:
            places = list(dict.fromkeys(x.place for x in structure.readings))
            distances = distances_of(self.step, probe, self.hamiltonian, places, ladder)
        self._last = structure, distances
        return self._last

    @property
    def evidence(self) -> Measurement | None:
        """The measurement in which a claim may be seen to fail: the last one, or a new one; None
        where none succeeds."""
        for how in self.step.ways:
            if self._last is None:
                with suppress(Exception):  # the user's code may raise anything
                    self.measure(how)
        return self._last


# -- the claims -----------------------------------------------------------------------------------


def with_claims(finding: Finding, trial: Trial) -> Finding:
    """Refute the finding where a claim fails, with a counterexample; leave it undecided where a
    claim is not decided.

    Where all that is claimed is shown, and that it is a scheme, nothing else that is undecided
    counts.
    """
    judged_claims = judge_claims(trial.claims, finding)
    failed = [claim for claim in judged_claims if claim.holds is not True]
    false = [claim for claim in failed if claim.holds is False]
    if not failed and finding.verdict is not Verdict.REFUTED:
        waits = finding.verdict is Verdict.UNDECIDED and trial.claims != NOTHING
        return (
            replace(finding, verdict=_VERDICTS[finding.how])
            if waits and finding.scheme
            else finding
        )
    if not false and finding.verdict is not Verdict.REFUTED:
        return replace(
            finding,
            verdict=Verdict.UNDECIDED,
            reason=prose(failed[0].name, " is claimed and not decided: ", finding.reason),
        )
    if finding.verdict is Verdict.REFUTED:
        finding = _but_for_area(finding, [claim.name for claim in judged_claims if claim.holds])
    if false:
        name = false[0].name
        reason = prose(name, " is claimed; ", false[0].evidence, " (", finding.reason, ")")
        finding = replace(finding, verdict=Verdict.REFUTED, reason=reason)
    else:
        name = prose("order 1")
    return replace(finding, counterexample=counterexample(str(name), trial))


def _but_for_area(finding: Finding, other_claims: Sequence[Prose]) -> Finding:
    """Add to a refuted order which other claims hold all the same."""
    area = [prose("det J ≡ 1")] if finding.area_preserving else []
    stands = area or other_claims  # which is more than an order of ΔJ
    if not stands:
        return finding
    how_shown = "proved" if finding.how == "proof" else "measured"
    claim_names = join_prose(" and ", stands)
    reason = prose(
        "the order is refuted, not ", claim_names, f", which is {how_shown}: ", finding.reason
    )
    return replace(finding, reason=reason)


# -- a counterexample -----------------------------------------------------------------------------


def counterexample(name: str, trial: Trial) -> Counterexample | None:
    """Find a place at which the claim of that name is seen to fail; None where there is none."""
    (structure, distances), step = trial.evidence or (None, None), trial.step
    if name in ("det J ≡ 1", "that it is symplectic"):
        if structure is None or structure.worst.beyond <= REFUTES:
            return None
        # Of the readings that refute the one of the largest defect is shown: it is the easiest to
        # confirm by hand.
        clear = [x for x in structure.readings if x.beyond > REFUTES]
        return counterexample_of_reading(step, max(clear, key=lambda x: x.defect), name)
    if name.startswith("ΔJ"):
        power = trial.claims.area_order or 1
        ladders = zip(structure.ladder, structure.rows, strict=True) if structure else ()
        candidates = [
            _find_slow_shrinking(step, place, list(rows), power, "|det J − 1|")
            for place, rows in ladders
        ]
        return next((x for x in candidates if x is not None), None)
    power = (trial.claims.order or 1) + 1
    failing = sorted(
        (x for x in (distances.places if distances else ()) if x.rows),
        # The places of the lowest power come first, those that have not settled last.
        key=lambda x: x.power if x.power is not None else 99,
    )
    candidates = [_counterexample_of_place(step, x, power) for x in failing[:3]]
    return next((x for x in candidates if x is not None), None)


def counterexample_of_reading(step: UserMap, reading: DefectReading, name: str) -> Counterexample:
    """Build the counterexample of an entry of S, or of det J − 1, that is not 0."""
    z = dict(zip(step.names, reading.place.z, strict=True))
    h = reading.h if step.takes_step_size else None
    t = reading.place.t if step.moving else None
    if step.degrees == 1 or (
        name == "det J ≡ 1" and abs(reading.volume) > REFUTES * reading.volume_noise
    ):
        value = f"{reading.volume:.6e} ± {reading.volume_noise:.1e}"
        return Counterexample(z, h, "det J − 1", value, "0", t)
    indices = reading.largest_entry
    value = f"{reading.entries[indices]:.6e} ± {reading.noise[indices]:.1e}"
    return Counterexample(z, h, f"the entry {step.entry(indices)} of S", value, "0", t)


def _counterexample_of_place(
    step: UserMap, place_order: PlaceOrder, power: int
) -> Counterexample | None:
    quantity = f"the distance of {place_order.component}' from the exact flow after one step"
    return _find_slow_shrinking(step, place_order.place, list(place_order.rows), power, quantity)


def _find_slow_shrinking(
    step: UserMap, place: TrialPlace, rows: list[tuple[float, float, float]], power: int, name: str
) -> Counterexample | None:
    """Find two step sizes between which a quantity shrinks by less than its power says.

    The larger ones are preferred, of those at which that shows as plainly as it does anywhere.
    """
    pairs: list[tuple[float, float, float, float, float]] = []
    for (large, larger_value, first), (small, smaller_value, second) in pairwise(rows):
        # Both values must be well above their noise, else their ratio tells nothing of a power.
        if larger_value > 10 * first and smaller_value > 10 * second:
            bound = larger_value * (small / large) ** power
            # With a value proportional to h^r this is power − r: the part of the power that is
            # missing.
            lacking = math.log(smaller_value / bound) / math.log(large / small)  # of the power
            pairs.append((lacking, small, smaller_value, bound, large))
    most_lacking = max((lacking for lacking, *_ in pairs), default=0.0)
    if most_lacking < _LACKING:
        return None
    _, h, value, bound, larger_step = next(
        pair for pair in pairs if pair[0] >= _PLAINLY * most_lacking
    )
    return Counterexample(
        dict(zip(step.names, place.z, strict=True)),
        Fraction(h),
        name,
        f"{value:.6e}",
        f"about {bound:.2e} for O(h^{power}), by that at h = {Fraction(larger_step)}",
        place.t if step.moving else None,
    )
