"""What a user claims of his step, held against what was found, with a counterexample."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from verify.integrators.probe import FINER, Measured, Row, Trial, measured
from verify.integrators.results import NOTHING, Claims, Counterexample, Finding, judged
from verify.integrators.step_probes import Point
from verify.prose import Prose, joined, prose
from verify.verdict import Verdict

_TOO_SLOW = 1.3  # times what a power allows: a step's other terms make less of it
_PLAINLY = 0.95
_SHOWN = {"proof": Verdict.PROVED, "duals": Verdict.MEASURED, "floats": Verdict.MEASURED}


def with_claims(found: Finding, claims: Claims, trial: Trial) -> Finding:
    """REFUTED where a claim is, with the counterexample; UNDECIDED where one is not decided.

    Where all that is claimed is shown, and that it is a scheme, what else is not decided does not
    count.
    """
    told = judged(claims, found)
    failed = [claim for claim in told if claim[1] is not True]
    false = [claim for claim in failed if claim[1] is False]
    if not failed and found.verdict is not Verdict.REFUTED:
        waits = found.verdict is Verdict.UNDECIDED and claims != NOTHING
        return replace(found, verdict=_SHOWN[found.how]) if waits and found.scheme else found
    if not false and found.verdict is not Verdict.REFUTED:
        return replace(
            found,
            verdict=Verdict.UNDECIDED,
            reason=prose(failed[0][0], " is claimed and not decided: ", found.reason),
        )
    if found.verdict is Verdict.REFUTED:
        found = _but_for_area(found, [name for name, holds, _ in told if holds])
    if false:
        name, _, known = false[0]
        reason = prose(name, " is claimed; ", known, " (", found.reason, ")")
        found = replace(found, verdict=Verdict.REFUTED, reason=reason)
    else:
        name = prose("order 1")
    return replace(found, counterexample=_counterexample(name, claims, trial))


def _but_for_area(found: Finding, held: Sequence[Prose]) -> Finding:
    """Says of what is no scheme what it has all the same: the order is refuted, and not that."""
    area = [prose("det J ≡ 1")] if found.area_preserving else []
    stands = area or held  # which is more than an order of ΔJ
    if not stands:
        return found
    shown = "proved" if found.how == "proof" else "measured"
    which = joined(" and ", stands)
    reason = prose("the order is refuted, not ", which, f", which is {shown}: ", found.reason)
    return replace(found, reason=reason)


def _counterexample(name: str, claims: Claims, trial: Trial) -> Counterexample | None:
    for how in trial.step.ways:
        try:
            whole = measured(trial, how)
            row = whole.largest
            if name == "det J ≡ 1":
                value = f"{row.delta_j:.6e} ± {row.delta_noise:.1e}"
                clock = trial.step.clock(*row.delta_at) if trial.step.moving else None
                return Counterexample(*row.delta_at, row.h, "det J − 1", value, "0", clock)
            area = name.startswith("ΔJ")
            power = (claims.area_order or 1) if area else (claims.order or 1) + 1
            at = whole.rows[-1].delta_at if area else whole.rows[-1].error_at
            there = measured(replace(trial, points=[at]), how, FINER[how])
            return _too_slow(there, at, power, area)
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    return None


def _too_slow(found: Measured, at: Point, power: int, area: bool) -> Counterexample | None:
    """Two step sizes between which a quantity shrinks by less than its power says.

    The largest of those at which that shows as plainly as it does anywhere.
    """
    pairs: list[tuple[float, Row, float, float, Row]] = []
    for large, small in pairwise(found.rows):
        (one, first), (two, second) = (_value(row, area) for row in (large, small))
        if one > 100 * first and two > 100 * second:
            allowed = one * float(small.h / large.h) ** power
            pairs.append((two / allowed, small, two, allowed, large))
    most = max((ratio for ratio, *_ in pairs), default=0.0)
    if most < _TOO_SLOW:
        return None
    _, row, value, allowed, before = next(pair for pair in pairs if pair[0] >= _PLAINLY * most)
    return Counterexample(
        *at,
        row.h,
        "|det J − 1|" if area else "the distance from the exact flow after one step",
        f"{value:.6e}",
        f"about {allowed:.2e} for O(h^{power}), by that at h = {before.h}",
        *found.times,
    )


def _value(row: Row, area: bool) -> tuple[float, float]:
    return (abs(row.delta_j), row.delta_noise) if area else (row.error, row.error_noise)
