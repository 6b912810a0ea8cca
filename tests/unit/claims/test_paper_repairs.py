"""What of the paper does not hold as it is printed: its repairs, and what is said of them.

Theorems are judged here. Verdicts on runs take minutes and are written down, those that refute by
name; most of these have a `confirmed_by`, by which `tests/second` computes them again.
"""

import math
import re
from collections import Counter
from fractions import Fraction
from typing import Any

import pytest

from tests.paths import ROOT
from tests.second.test_tables import TABLES
from verify.claims.base_claim import Claim, Findings
from verify.claims.claims_file import load_claims
from verify.scenes.results.claim import Category, ClaimResult, StatementResult, statements_of
from verify.verdict import Verdict

FILE = load_claims(ROOT / "reports" / "paper" / "claims.toml")
CLAIMS: dict[str, Any] = {claim.id: claim for claim in FILE.claims}
README = "README.md"
RESULTS = "docs/explanation/results-of-the-paper.md"
# Of the claims that are no theorems, those that `verify check paper` refutes (2026-12-01).
REFUTED_ELSEWHERE = {
    "table-1", "table-1-any-time", "table-1-some-delta", "table-2", "table-2-any-time",
    "duffing-mse-initial-values", "duffing-mse-initial-values-widely", "duffing-mse-size",
    "duffing-criterion-3-printed", "duffing-lambda-increases-50", "duffing-no-pattern",
    "duffing-ratio-decreases", "duffing-ratio-decreases-50", "duffing-ratio-alike-50",
    "duffing-smaller-step-lambda-50", "duffing-magnitudes-every", "duffing-maintains-exactly",
    "duffing-flow-area", "duffing-multi-step-consistent", "duffing-multi-step-area-elsewhere",
    "duffing-multi-step-consistent-elsewhere", "pendulum-mse-initial-values",
    "pendulum-mse-initial-values-widely", "pendulum-mse-size", "pendulum-criterion-3-printed",
    "pendulum-ratio-decreases", "pendulum-satisfactory-solution", "pendulum-flow-area",
    "pendulum-multi-step-area-exactly", "maintains-area-exactly", "cat-face", "cat-face-elsewhere",
    "solution-error", "solution-error-pendulum", "solution-error-small-step",
}  # fmt: skip
SYSTEMS = {"duffing": "table-1", "pendulum": "table-2"}
systems = pytest.mark.parametrize("system", SYSTEMS)


def judge(claim: Claim) -> ClaimResult:
    if claim.kind == "theorem":
        return claim.judge(Findings({}))
    refuted = claim.id in REFUTED_ELSEWHERE
    return claim.result(Verdict.REFUTED if refuted else Verdict.MEASURED, "")


@pytest.fixture(scope="module")
def results() -> dict[str, ClaimResult]:
    return {claim.id: judge(claim) for claim in FILE.claims}


@pytest.fixture(scope="module")
def statements(results: dict[str, ClaimResult]) -> tuple[StatementResult, ...]:
    return statements_of([*results.values()])


def text_of(page: str) -> str:
    return " ".join((ROOT / page).read_text(encoding="utf-8").split())


def test_what_is_written_down_as_refuted_is_a_claim_on_no_theorem() -> None:
    assert {CLAIMS[name].kind for name in REFUTED_ELSEWHERE}.isdisjoint({"theorem"})


# -- a repair for each statement that does not hold as it is printed ------------------------------


def test_each_statement_that_does_not_hold_as_it_is_printed_has_a_repair_and_no_other_has(
    results: dict[str, ClaimResult], statements: tuple[StatementResult, ...]
) -> None:
    wanting = {each.id for each in statements if each.category is not Category.AS_MEANT}
    assert wanting == {result.repairs for result in results.values()} - {""}


def test_every_repair_holds_itself(results: dict[str, ClaimResult]) -> None:
    assert not [r.id for r in results.values() if r.repairs and not r.verdict.holds]


def test_every_repair_says_what_it_changes_in_the_paper(results: dict[str, ClaimResult]) -> None:
    assert not [r.id for r in results.values() if r.repairs and not r.effect]


def test_the_repairs_that_change_a_table_are_the_two_tables(
    results: dict[str, ClaimResult],
) -> None:
    assert {r.repairs for r in results.values() if r.effect == "table"} == {*SYSTEMS.values()}


def test_a_repair_has_other_words_than_its_statement() -> None:
    statement = {c.reading_of: c.statement for c in FILE.claims if c.id == c.reading_of}
    for claim in FILE.claims:
        repaired = claim.repairs or (claim.reading_of if claim.repaired else "")
        if repaired:
            assert (claim.repaired or claim.statement) != statement[repaired]


def test_the_documentation_counts_the_categories(statements: tuple[StatementResult, ...]) -> None:
    counts = Counter(each.category for each in statements)
    as_meant, misprinted, depends, refuted, undecided = (counts[c] for c in Category)
    assert undecided == 0
    assert (
        f"{as_meant} hold as meant, {misprinted} hold with a misprint, {depends} depend on the "
        f"reading and **{refuted} hold in none**"
    ) in text_of(RESULTS)
    assert (
        f"{as_meant + misprinted} hold as meant ({misprinted} with a misprint), {depends} depend "
        f"on the reading and {refuted} hold in none"
    ) in text_of(README)
    assert f"each of the {misprinted + depends + refuted} statements that" in text_of(RESULTS)


# -- the repaired tables --------------------------------------------------------------------------


def table(name: str) -> list[list[float]]:
    return [[float(cell) for cell in row] for row in CLAIMS[f"{name}-repaired"].rows]


def printed(name: str) -> list[float]:
    return [float(cell) for cell in CLAIMS[name].printed]


@systems
def test_a_repaired_table_is_that_of_another_program(system: str) -> None:
    claim = CLAIMS[f"{SYSTEMS[system]}-repaired"]
    assert claim.rows == tuple(tuple(f"{x:.4f}" for x in row) for row in TABLES[system])
    assert claim.step_sizes == CLAIMS[SYSTEMS[system]].step_sizes


def test_how_much_better_than_printed_the_scheme_is_said_to_be_is_so() -> None:
    gaps = [
        above - value
        for name in SYSTEMS.values()
        for row in table(name)
        for above, value in zip(printed(name), row, strict=True)
    ]
    powers = f"{min(gaps):.1f} to {max(gaps):.1f}"
    assert powers == "4.2 to 16.2"
    (cause,) = [each for each in FILE.causes if each.disfavours]
    assert f"is smaller than printed, by {powers} powers of ten" in cause.disfavours
    assert f"the MSE is {powers} decades smaller" in text_of(RESULTS)


def test_one_determinant_left_at_0_prints_the_rows_of_both_tables() -> None:
    """As the origin of the slip is told: MSE + 1/N, N = 20,000/h, to four decimals."""
    (cause,) = [each for each in FILE.causes if each.origin]
    assert "has the four printed decimals of all 12 numbers" in cause.origin
    for name in SYSTEMS.values():
        for row in table(name):
            sums = [
                10**value + float(h) / 20000
                for value, h in zip(row, CLAIMS[name].step_sizes, strict=True)
            ]
            assert tuple(f"{math.log10(x):.4f}" for x in sums) == CLAIMS[name].printed


# -- repairs that have numbers of their own -------------------------------------------------------


@systems
def test_the_repaired_factor_holds_for_the_repaired_table_and_is_no_greater_than_it_need_be(
    system: str,
) -> None:
    columns = zip(*table(SYSTEMS[system]), strict=True)
    largest = max(10 ** (max(column) - min(column)) for column in columns)
    claim = CLAIMS[f"{system}-mse-initial-values-repaired"]
    assert 0.95 * claim.factor < largest < claim.factor
    assert f"by a factor of up to {int(claim.factor):,}." in claim.statement


@systems
def test_the_repaired_sizes_are_the_last_column_of_the_repaired_table(system: str) -> None:
    claim = CLAIMS[f"{system}-mse-size-repaired"]
    assert claim.rows == tuple((f"{row[-1]:.1f}",) for row in table(SYSTEMS[system]))
    assert claim.step_sizes == CLAIMS[SYSTEMS[system]].step_sizes[-1:]
    sizes = re.findall(r"`10\^(-\d+\.\d)`", claim.statement)
    assert sizes == [cell for (cell,) in claim.rows]


@systems
def test_the_bound_of_the_growth_is_told_with_the_constants_that_are_claimed(system: str) -> None:
    claim = CLAIMS[f"{system}-growth-bound"]
    c1, c2 = (str(float(c)).removesuffix(".0") for c in (claim.c1, claim.c2))
    bound = f"|Λ| ≤ {c1} `h^{claim.eta}` + {c2} `h^{claim.eta + 1}` T at the end"
    assert claim.statement.startswith(bound)


def test_the_documentation_has_the_same_bounds() -> None:
    duffing, pendulum = (CLAIMS[f"{system}-growth-bound"] for system in SYSTEMS)
    assert (duffing.eta, duffing.c1, duffing.c2) == (2, 5, 11)
    assert (pendulum.eta, pendulum.c1, pendulum.c2) == (2, 1, Fraction(1, 4))
    assert "|Λ| ≤ 5h² + 11h³T (Duffing) and h² + h³T/4 (pendulum)" in text_of(RESULTS)


# -- what the paper leaves open -------------------------------------------------------------------


def test_assumptions_name_claims_on_the_same_sentence_of_the_paper() -> None:
    assert FILE.assumptions
    for assumption in FILE.assumptions:
        for pair in assumption.decides:
            assert pair.claim != pair.otherwise
            assert {pair.claim, pair.otherwise} <= CLAIMS.keys()
            assert CLAIMS[pair.claim].section == CLAIMS[pair.otherwise].section
        assert {*assumption.settled_by} <= CLAIMS.keys()


def test_what_settles_an_assumption_holds(results: dict[str, ClaimResult]) -> None:
    settled = [name for each in FILE.assumptions for name in each.settled_by]
    assert settled
    assert all(results[name].verdict.holds for name in settled)


def test_the_documentation_says_how_many_verdicts_turn_on_each_assumption(
    results: dict[str, ClaimResult],
) -> None:
    time, delta, cat, count = (
        sum(
            results[pair.claim].verdict.holds is not results[pair.otherwise].verdict.holds
            for pair in assumption.decides
        )
        for assumption in FILE.assumptions
    )
    assert (delta, count) == (0, 0)
    assert (
        f"the time T = 20,000, on which {time} verdicts turn, the place of the cat ({cat}), δ = 1 "
        "and the count of k (none)"
    ) in text_of(RESULTS)
