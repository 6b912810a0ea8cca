"""Claims about numbers, decided by runs whose values carry error bounds.

A comparison counts only where the bounds do not touch what it is compared with; else the answer is
UNDECIDED. `verify.claims.printed` has those that print decimals.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from verify.arithmetic.arb import (
    Ball,
    bounds,
    in_reach,
    lg,
    middle_and_radius,
    rational_ball,
    shown,
)
from verify.arithmetic.exact import decimal, text
from verify.claims.findings import Checks, Findings, result
from verify.claims.kinds import LessClaim, MagnitudeClaim, MonotoneClaim, SpreadClaim
from verify.claims.runs import LABELS, QUANTITIES, all_hold, decided, rows_of, sign, start_of
from verify.errors import InputError
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict


def check_spread(claim: SpreadClaim, findings: Findings) -> ClaimResult:
    _, rows = rows_of(claim, findings, claim.quantity)
    details = [["step size", "least", "greatest", "factor"]]
    verdicts: list[bool | None] = []
    worst = Fraction(0)
    for column in zip(*rows, strict=True):
        values = [QUANTITIES[claim.quantity](run) for run in column]
        ends = [bounds(v) if in_reach(v) else None for v in values]
        known = [e for e in ends if e is not None and e[0] > 0]
        if len(known) < len(values):
            verdicts.append(None)
            details.append([column[0].step_size, "unknown", "unknown", "unknown"])
            continue
        # The factor is surely reached, and surely not passed, whatever the values are inside.
        reached = max(low for low, _ in known) / min(high for _, high in known)
        passed = max(high for _, high in known) / min(low for low, _ in known)
        holds = passed <= claim.factor
        verdicts.append(None if not holds and reached <= claim.factor else holds)
        low, high = min(values, key=_middle), max(values, key=_middle)
        details.append([column[0].step_size, shown(low), shown(high), shown(high / low, 3)])
        worst = max(worst, reached)
    evidence = (
        f"{LABELS[claim.quantity]} varies over the initial values by a factor of up to "
        f"{decimal(worst, 2)} at one step size (allowed here: {text(claim.factor)})"
    )
    return result(claim, all_hold(verdicts), evidence, details)


def _middle(x: Ball) -> Fraction:
    return middle_and_radius(x)[0]


def _table(rows: Sequence[Sequence[RunResult]], quantity: str) -> list[list[str]]:
    head = ["initial value", *(f"h = {run.step_size}" for run in rows[0])]
    body = [
        [start_of(row[0]), *(shown(QUANTITIES[quantity](run), 5) for run in row)] for row in rows
    ]
    return [head, *body]


def check_monotone(claim: MonotoneClaim, findings: Findings) -> ClaimResult:
    _, rows = rows_of(claim, findings, claim.quantity)
    quantity, way = QUANTITIES[claim.quantity], 1 if claim.direction == "increases" else -1
    label = LABELS[claim.quantity]
    verdicts: list[bool | None] = []
    counterexamples = []
    for row in rows:
        for one, two in pairwise(row):
            gap = way * (quantity(two) - quantity(one))
            verdicts.append(sign(gap))
            if gap < 0:
                counterexamples.append(
                    f"{start_of(one)}: from h = {one.step_size} to {two.step_size}, {label} goes "
                    f"from {shown(quantity(one), 4)} to {shown(quantity(two), 4)}"
                )
    details = _table(rows, claim.quantity)
    total = f"{len(verdicts)} neighbouring pairs"
    if counterexamples:
        evidence = f"{len(counterexamples)} of {total} go the other way; {counterexamples[0]}"
    elif all_hold(verdicts) is Verdict.UNDECIDED:
        evidence = f"{verdicts.count(None)} of {total} of step sizes are not told apart"
    else:
        evidence = f"{label} {claim.direction} between all {total} of step sizes"
    return result(claim, all_hold(verdicts), evidence, details)


def check_less(claim: LessClaim, findings: Findings) -> ClaimResult:
    _, rows = rows_of(claim, findings, claim.quantity, claim.than)
    one, two = QUANTITIES[claim.quantity], QUANTITIES[claim.than]
    runs = [run for row in rows for run in row]
    verdicts = [sign(two(run) - one(run)) for run in runs]
    ratios = [r for r in (one(run) / two(run) for run in runs) if in_reach(r)]
    largest = shown(max(ratios, key=_middle), 2) if ratios else "unknown"
    evidence = (
        f"{LABELS[claim.quantity]} is at most {largest} times {LABELS[claim.than]} "
        f"in {len(ratios)} of {len(runs)} runs"
    )
    return result(claim, all_hold(verdicts), evidence)


def check_magnitude(claim: MagnitudeClaim, findings: Findings) -> ClaimResult:
    names = list(claim.exponents)
    _, rows = rows_of(claim, findings, *names)
    details = [["initial value", *(f"{LABELS[n]} (about 10^{claim.exponents[n]}?)" for n in names)]]
    holds: list[bool | None] = []
    failing: list[str] = []
    for row in rows:
        runs = [r for r in row if Fraction(r.step_size) == claim.step_size]
        if not runs:
            raise InputError(f"claim {claim.id}", text(claim.step_size), "is not in the grid")
        values = {name: QUANTITIES[name](runs[0]) for name in names}
        off = [abs(lg(values[n]) - claim.exponents[n]) for n in names]
        near = [sign(rational_ball(Fraction(1, 2)) - x) for x in off]
        holds.append(_every(near))
        wrong = [n for n, held in zip(names, near, strict=True) if held is False]
        failing.append(", ".join(f"{LABELS[n]} = {shown(values[n], 2)}" for n in wrong))
        details.append([start_of(row[0]), *(shown(values[n], 4) for n in names)])
    yes = [details[i + 1][0] for i, h in enumerate(holds) if h is True]
    no = [f"{details[i + 1][0]}: {failing[i]}" for i, h in enumerate(holds) if h is False]
    evidence = f"holds for {_list(yes)}; does not hold for {_list(no)}"
    decided = _some(holds) if claim.quantifier == "some" else _every(holds)
    verdict = {True: Verdict.MEASURED, False: Verdict.REFUTED, None: Verdict.UNDECIDED}[decided]
    return result(claim, verdict, evidence, details)


def _every(answers: Sequence[bool | None]) -> bool | None:
    return False if False in answers else None if None in answers else True


def _some(answers: Sequence[bool | None]) -> bool | None:
    return True if True in answers else None if None in answers else False


def _list(names: Sequence[str]) -> str:
    return "; ".join(f"({name})" for name in names) or "none of the initial values"


CHECKS: Checks = {
    SpreadClaim: decided(check_spread),
    MonotoneClaim: decided(check_monotone),
    LessClaim: decided(check_less),
    MagnitudeClaim: decided(check_magnitude),
}
