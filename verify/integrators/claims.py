"""What a user claims of his step, held against what was seen, with a counterexample."""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from verify.integrators.measures.order import PlaceOrder
from verify.integrators.measures.structure import REFUTES
from verify.integrators.places.place import Place
from verify.integrators.probes.reading import Reading
from verify.integrators.results import NOTHING, Counterexample, Finding, judged
from verify.integrators.trial import Trial
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, joined, prose
from verify.verdict import Verdict

_LACKING = 0.4  # of a power of h: a step's other terms make less of it
_PLAINLY = 0.8  # of what is lacking at most
_SHOWN = {"proof": Verdict.PROVED, "duals": Verdict.MEASURED, "floats": Verdict.MEASURED}


def with_claims(finding: Finding, trial: Trial) -> Finding:
    """REFUTED where a claim is, with the counterexample; UNDECIDED where one is not decided.

    Where all that is claimed is shown, and that it is a scheme, what else is not decided does not
    count.
    """
    told = judged(trial.claims, finding)
    failed = [claim for claim in told if claim[1] is not True]
    false = [claim for claim in failed if claim[1] is False]
    if not failed and finding.verdict is not Verdict.REFUTED:
        waits = finding.verdict is Verdict.UNDECIDED and trial.claims != NOTHING
        return (
            replace(finding, verdict=_SHOWN[finding.how]) if waits and finding.scheme else finding
        )
    if not false and finding.verdict is not Verdict.REFUTED:
        return replace(
            finding,
            verdict=Verdict.UNDECIDED,
            reason=prose(failed[0][0], " is claimed and not decided: ", finding.reason),
        )
    if finding.verdict is Verdict.REFUTED:
        finding = _but_for_area(finding, [name for name, holds, _ in told if holds])
    if false:
        name, _, known = false[0]
        reason = prose(name, " is claimed; ", known, " (", finding.reason, ")")
        finding = replace(finding, verdict=Verdict.REFUTED, reason=reason)
    else:
        name = prose("order 1")
    return replace(finding, counterexample=counterexample(str(name), trial))


def _but_for_area(finding: Finding, held: Sequence[Prose]) -> Finding:
    """Says of what is no scheme what it has all the same: the order is refuted, and not that."""
    area = [prose("det J ≡ 1")] if finding.area_preserving else []
    stands = area or held  # which is more than an order of ΔJ
    if not stands:
        return finding
    shown = "proved" if finding.how == "proof" else "measured"
    which = joined(" and ", stands)
    reason = prose("the order is refuted, not ", which, f", which is {shown}: ", finding.reason)
    return replace(finding, reason=reason)


def counterexample(name: str, trial: Trial) -> Counterexample | None:
    """Where the claim of that name is seen to fail; None where it is seen nowhere."""
    (structure, distances), step = trial.evidence or (None, None), trial.step
    if name in ("det J ≡ 1", "that it is symplectic"):
        if structure is None or structure.worst.beyond <= REFUTES:
            return None
        clear = [x for x in structure.readings if x.beyond > REFUTES]
        return of_reading(step, max(clear, key=lambda x: x.defect), name)
    if name.startswith("ΔJ"):
        power = trial.claims.area_order or 1
        ladders = zip(structure.ladder, structure.rows, strict=True) if structure else ()
        each = [_too_slow(step, place, list(rows), power, "|det J − 1|") for place, rows in ladders]
        return next((x for x in each if x is not None), None)
    power = (trial.claims.order or 1) + 1
    failing = sorted(
        (x for x in (distances.places if distances else ()) if x.rows),
        key=lambda x: x.power if x.power is not None else 99,
    )
    each = [_of_place(step, x, power) for x in failing[:3]]
    return next((x for x in each if x is not None), None)


def of_reading(step: UserMap, reading: Reading, name: str) -> Counterexample:
    """An entry of S, or det J − 1, that is not 0."""
    z = dict(zip(step.names, reading.place.z, strict=True))
    h = reading.h if step.stepped else None
    t = reading.place.t if step.moving else None
    if step.degrees == 1 or (
        name == "det J ≡ 1" and abs(reading.volume) > REFUTES * reading.volume_noise
    ):
        value = f"{reading.volume:.6e} ± {reading.volume_noise:.1e}"
        return Counterexample(z, h, "det J − 1", value, "0", t)
    at = reading.shown
    value = f"{reading.entries[at]:.6e} ± {reading.noise[at]:.1e}"
    return Counterexample(z, h, f"the entry {step.entry(at)} of S", value, "0", t)


def _of_place(step: UserMap, seen: PlaceOrder, power: int) -> Counterexample | None:
    what = f"the distance of {seen.component}' from the exact flow after one step"
    return _too_slow(step, seen.place, list(seen.rows), power, what)


def _too_slow(
    step: UserMap, place: Place, rows: list[tuple[float, float, float]], power: int, what: str
) -> Counterexample | None:
    """Two step sizes between which a quantity shrinks by less than its power says.

    The largest of those at which that shows as plainly as it does anywhere.
    """
    pairs: list[tuple[float, float, float, float, float]] = []
    for (large, one, first), (small, two, second) in pairwise(rows):
        if one > 10 * first and two > 10 * second:
            allowed = one * (small / large) ** power
            lacking = math.log(two / allowed) / math.log(large / small)  # of the power
            pairs.append((lacking, small, two, allowed, large))
    most = max((lacking for lacking, *_ in pairs), default=0.0)
    if most < _LACKING:
        return None
    _, h, value, allowed, before = next(pair for pair in pairs if pair[0] >= _PLAINLY * most)
    return Counterexample(
        dict(zip(step.names, place.z, strict=True)),
        Fraction(h),
        what,
        f"{value:.6e}",
        f"about {allowed:.2e} for O(h^{power}), by that at h = {Fraction(before)}",
        place.t if step.moving else None,
    )
