"""Claims that print decimals: true where a value's whole ball rounds to what is printed.

A value on the border of two roundings counts for both. Where only a part of the ball rounds to what
is printed, the answer is UNDECIDED.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import product

from verify.arithmetic.arb import (
    Ball,
    bounds,
    fixed,
    in_reach,
    lg,
    middle_and_radius,
    rational_ball,
    shown,
)
from verify.arithmetic.exact import text
from verify.claims.findings import Checks, Findings, result
from verify.claims.kinds import TableClaim, ValueClaim
from verify.claims.runs import LABELS, NEEDS, QUANTITIES, all_hold, decided, rows_of, start_of
from verify.errors import InputError
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict

_ALSO_SHOWN = 3  # digits beyond those that are printed


def check_value(claim: ValueClaim, findings: Findings) -> ClaimResult:
    quantity: str = claim.kind
    if claim.lg_printed is not None:
        quantity = "lg_mse" if claim.kind == "mse" else "lg_abs_lambda"
    printed = claim.printed or claim.lg_printed or ""
    _, ((run, *more), *others) = rows_of(claim, findings, quantity)
    if more or others:
        raise InputError(f"claim {claim.id}", "", "speaks of one run; give step_size, q and p")
    holds = _holds(run, quantity, printed)
    known = _shown(run, quantity, len(printed.partition("e")[0]) + _ALSO_SHOWN)
    says = {
        True: "which rounds to",
        False: "which does not round to",
        None: "not known to round to",
    }
    evidence = f"{LABELS[quantity]} = {known}, {says[holds]} {printed}, in {run.steps} steps"
    return result(claim, all_hold([holds]), evidence)


def check_table(claim: TableClaim, findings: Findings) -> ClaimResult:
    scene, rows = rows_of(claim, findings, claim.quantity)
    printed_rows = claim.rows or [claim.printed or ()] * len(rows)
    if len(printed_rows) != len(rows):
        raise InputError(f"claim {claim.id}: rows", len(printed_rows), f"give {len(rows)} rows")
    details = [["initial value", *(f"h = {text(h)}" for h in claim.step_sizes)]]
    if claim.printed is not None:
        details.append(["printed, for all", *claim.printed])
    verdicts: list[bool | None] = []
    values: list[Ball] = []
    for row, printed in zip(rows, printed_rows, strict=True):
        by_h = {Fraction(run.step_size): run for run in row}
        runs = [_at(by_h, h, claim) for h in claim.step_sizes]
        verdicts += [_holds(run, claim.quantity, p) for run, p in zip(runs, printed, strict=True)]
        if claim.rows is not None:
            details.append([f"printed, {start_of(row[0])}", *printed])
        places = [_places(p) for p in printed]
        own = [_cell(run, claim.quantity, n) for run, n in zip(runs, places, strict=True)]
        details.append([start_of(row[0]), *own])
        values += [QUANTITIES[claim.quantity](run) for run in runs]
    label = LABELS[claim.quantity]
    seen = f"no computed {label} is known"
    if known := sorted((v for v in values if in_reach(v)), key=_middle):
        low, high = (_short(v, claim.quantity) for v in (known[0], known[-1]))
        seen = f"computed {label} lies between {low} and {high}"
    wrong = verdicts.count(False)
    if not wrong:
        return result(claim, all_hold(verdicts), f"{seen}, as printed", details)
    names = _identities(claim, rows[0], scene.grid.time if scene.grid else None)
    named = f"; the printed row is {' = '.join(names)} to all its digits" if names else ""
    evidence = f"{wrong} of {len(verdicts)} entries are wrong: {seen}{named}"
    return result(claim, Verdict.REFUTED, evidence, details)


def _at(by_h: dict[Fraction, RunResult], h: Fraction, claim: TableClaim) -> RunResult:
    if h not in by_h:
        raise InputError(f"claim {claim.id}: step_sizes", text(h), "is not in the scene's grid")
    return by_h[h]


# -- rounding -------------------------------------------------------------------------------------


def _holds(run: RunResult, quantity: str, printed: str) -> bool | None:
    source = run.values[NEEDS[quantity][0]]
    if quantity.startswith("lg") and Fraction(source.value) == Fraction(source.bound) == 0:
        return False  # lg 0 is no number
    return _rounds_to(QUANTITIES[quantity](run), printed)


def _places(printed: str) -> int:
    """How many decimals: the unit of the last digit is 10^−places."""
    mantissa, _, exponent = printed.partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)


def _rounds_to(value: Ball, printed: str) -> bool | None:
    """Whether the value's whole ball rounds to the printed decimal; None where only a part does."""
    if not in_reach(value):
        return None
    half = Fraction(10) ** -_places(printed) / 2
    low, high = bounds(value)
    if abs(low - Fraction(printed)) <= half and abs(high - Fraction(printed)) <= half:
        return True
    return None if low - half <= Fraction(printed) <= high + half else False


# -- how values are shown -------------------------------------------------------------------------


def _middle(x: Ball) -> Fraction:
    return middle_and_radius(x)[0]


def _shown(run: RunResult, quantity: str, digits: int) -> str:
    value = QUANTITIES[quantity](run)
    if quantity.startswith("lg"):
        return fixed(value, max(1, digits - 2)) if in_reach(value) else "unknown"
    return shown(value, digits)


def _cell(run: RunResult, quantity: str, places: int) -> str:
    value = QUANTITIES[quantity](run)
    return fixed(value, max(1, places)) if quantity.startswith("lg") else shown(value)


def _short(value: Ball, quantity: str) -> str:
    return fixed(value, 2) if quantity.startswith("lg") else shown(value, 3)


# -- what a wrong row is --------------------------------------------------------------------------


def _identities(claim: TableClaim, row: Sequence[RunResult], time: Fraction | None) -> list[str]:
    """Products hᵃ Nᵇ Tᶜ whose lg is the printed row to all its digits, simplest first.

    Looked for among small exponents. As N h = T (up to a step), one of a, b, c can be 0.
    """
    if claim.quantity != "lg_mse" or claim.printed is None:
        return []
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


CHECKS: Checks = {ValueClaim: decided(check_value), TableClaim: decided(check_table)}
