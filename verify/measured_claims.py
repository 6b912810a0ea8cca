"""Claims about numbers, decided by runs whose values carry error bounds.

A comparison counts only where the bounds do not touch what it is compared with; else the answer is
UNDECIDED. A printed decimal is true where the value's whole ball rounds to it.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise, product

import flint

from verify.balls import (
    Ball,
    ball,
    bounds,
    fixed,
    in_reach,
    lg,
    middle_and_radius,
    rational_ball,
    shown,
)
from verify.claim_runs import LABELS, QUANTITIES, decided, rows_of, start_of
from verify.claims import (
    Findings,
    LessClaim,
    MagnitudeClaim,
    MonotoneClaim,
    SpreadClaim,
    TableClaim,
    result,
)
from verify.errors import InputError
from verify.exact import decimal, text
from verify.results import ClaimResult, RunResult
from verify.verdict import Verdict


def check_table(claim: TableClaim, findings: Findings) -> ClaimResult:
    scene, rows = rows_of(claim, findings, "mse")
    details = [["initial value", *(f"h = {text(h)}" for h in claim.step_sizes)]]
    details.append(["printed, for all", *claim.printed])
    verdicts: list[bool | None] = []
    values: list[Ball] = []
    for row in rows:
        by_h = {Fraction(run.step_size): run for run in row}
        own = [lg(ball(_at(by_h, h, claim).values["mse"])) for h in claim.step_sizes]
        verdicts += [_rounds_to(v, p) for v, p in zip(own, claim.printed, strict=True)]
        details.append([start_of(row[0]), *(fixed(v, 4) for v in own)])
        values += own
    known = sorted((v for v in values if in_reach(v)), key=_middle)
    seen = "no computed lg MSE is known"
    if known:
        seen = f"computed lg MSE lies between {fixed(known[0], 2)} and {fixed(known[-1], 2)}"
    names = _identities(claim, rows[0], scene.grid.time if scene.grid else None)
    wrong = verdicts.count(False)
    if wrong:
        named = f"; the printed row is {' = '.join(names)} to all its digits" if names else ""
        evidence = f"{wrong} of {len(verdicts)} entries are wrong: {seen}{named}"
        return result(claim, Verdict.REFUTED, evidence, details)
    verdict = Verdict.UNDECIDED if None in verdicts else Verdict.MEASURED
    return result(claim, verdict, f"{seen}, as printed", details)


def _at(by_h: dict[Fraction, RunResult], h: Fraction, claim: TableClaim) -> RunResult:
    if h not in by_h:
        raise InputError(f"claim {claim.id}: step_sizes", text(h), "is not in the scene's grid")
    return by_h[h]


def _rounds_to(value: Ball, printed: str) -> bool | None:
    """Whether the value's whole ball rounds to the printed decimal; None where only a part does."""
    half = Fraction(1, 2 * 10 ** len(printed.partition(".")[2]))
    middle = Fraction(printed)
    accepted = rational_ball(middle) + flint.arb(0, 1) * rational_ball(half)
    if accepted.contains(value):
        return True
    return None if accepted.overlaps(value) else False


def _identities(claim: TableClaim, row: Sequence[RunResult], time: Fraction | None) -> list[str]:
    """Products hᵃ Nᵇ Tᶜ whose lg is the printed row to all its digits, simplest first.

    Looked for among small exponents. As N h = T (up to a step), one of a, b, c can be 0.
    """
    by_h = {Fraction(run.step_size): run for run in row}
    found = []
    for a, b, c in product(range(-6, 7), range(-3, 4), range(-3, 4)):
        if 0 not in (a, b, c) or (a, b, c) == (0, 0, 0):
            continue
        if all(
            _rounds_to(lg(_power(h, by_h[h].steps, time, (a, b, c))), printed) is True
            for h, printed in zip(claim.step_sizes, claim.printed, strict=True)
        ):
            found.append((abs(a) + abs(b) + abs(c), (a, b, c)))
    return [f"lg({_monomial(exponents)})" for _, exponents in sorted(found)]


def _power(h: Fraction, steps: int, time: Fraction | None, exponents: tuple[int, int, int]) -> Ball:
    a, b, c = exponents
    length = h * steps if time is None else time
    return rational_ball(h**a * Fraction(steps) ** b * length**c)


def _monomial(exponents: tuple[int, int, int]) -> str:
    above = [_factor(n, e) for n, e in zip("hNT", exponents, strict=True) if e > 0]
    below = [_factor(n, -e) for n, e in zip("hNT", exponents, strict=True) if e < 0]
    return (" ".join(above) or "1") + (f"/{' '.join(below)}" if below else "")


def _factor(name: str, exponent: int) -> str:
    return name if exponent == 1 else f"{name}^{exponent}"


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
    return result(claim, _all(verdicts), evidence, details)


def _middle(x: Ball) -> Fraction:
    return middle_and_radius(x)[0]


def _all(verdicts: Sequence[bool | None]) -> Verdict:
    """REFUTED by one False; MEASURED where there is something to measure and all is True."""
    if False in verdicts:
        return Verdict.REFUTED
    return Verdict.UNDECIDED if None in verdicts or not verdicts else Verdict.MEASURED


def _table(rows: Sequence[Sequence[RunResult]], quantity: str) -> list[list[str]]:
    head = ["initial value", *(f"h = {run.step_size}" for run in rows[0])]
    body = [
        [start_of(row[0]), *(shown(QUANTITIES[quantity](run), 5) for run in row)] for row in rows
    ]
    return [head, *body]


def check_monotone(claim: MonotoneClaim, findings: Findings) -> ClaimResult:
    _, rows = rows_of(claim, findings, claim.quantity)
    quantity, sign = QUANTITIES[claim.quantity], 1 if claim.direction == "increases" else -1
    label = LABELS[claim.quantity]
    verdicts: list[bool | None] = []
    counterexamples = []
    for row in rows:
        for one, two in pairwise(row):
            gap = sign * (quantity(two) - quantity(one))
            verdicts.append(_sign(gap))
            if gap < 0:
                counterexamples.append(
                    f"{start_of(one)}: from h = {one.step_size} to {two.step_size}, {label} goes "
                    f"from {shown(quantity(one), 4)} to {shown(quantity(two), 4)}"
                )
    details = _table(rows, claim.quantity)
    total = f"{len(verdicts)} neighbouring pairs"
    if counterexamples:
        evidence = f"{len(counterexamples)} of {total} go the other way; {counterexamples[0]}"
    elif _all(verdicts) is Verdict.UNDECIDED:
        evidence = f"{verdicts.count(None)} of {total} of step sizes are not told apart"
    else:
        evidence = f"{label} {claim.direction} between all {total} of step sizes"
    return result(claim, _all(verdicts), evidence, details)


def _sign(x: Ball) -> bool | None:
    """Whether x is positive (True) or negative (False); None where its ball holds 0."""
    return True if x > 0 else False if x < 0 else None


def check_less(claim: LessClaim, findings: Findings) -> ClaimResult:
    _, rows = rows_of(claim, findings, claim.quantity, claim.than)
    one, two = QUANTITIES[claim.quantity], QUANTITIES[claim.than]
    runs = [run for row in rows for run in row]
    verdicts = [_sign(two(run) - one(run)) for run in runs]
    ratios = [r for r in (one(run) / two(run) for run in runs) if in_reach(r)]
    largest = shown(max(ratios, key=_middle), 2) if ratios else "unknown"
    evidence = (
        f"{LABELS[claim.quantity]} is at most {largest} times {LABELS[claim.than]} "
        f"in {len(ratios)} of {len(runs)} runs"
    )
    return result(claim, _all(verdicts), evidence)


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
        near = [_sign(rational_ball(Fraction(1, 2)) - x) for x in off]
        holds.append(_every(near))
        wrong = [n for n, sign in zip(names, near, strict=True) if sign is False]
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


CHECKS = {
    TableClaim: decided(check_table),
    SpreadClaim: decided(check_spread),
    MonotoneClaim: decided(check_monotone),
    LessClaim: decided(check_less),
    MagnitudeClaim: decided(check_magnitude),
}
