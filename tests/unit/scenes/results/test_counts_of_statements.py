"""How the counts of a paper's statements are said; their categories: tests/unit/claims."""

from tests.helpers.constructed.papers import P, R, U, each_category, reading, table
from verify.scenes.results.claim import ClaimResult, describe_counts, statements_of


def counted(*claims: ClaimResult) -> str:
    return describe_counts(statements_of(claims), claims)


def test_a_single_statement_is_counted_in_the_singular() -> None:
    assert counted(reading("A", P)) == "1 statement of the paper, in 1 reading: 1 holds as meant"
    assert counted(reading("A", U), reading("", P, id="ours")) == (
        "1 statement of the paper, in 1 reading: 1 is undecided; 1 more claim is ours"
    )


def test_several_statements_readings_and_claims_of_ours_are_counted_in_the_plural() -> None:
    claims = [
        each.model_copy(update={"id": f"{each.id}{k}", "statement_id": each.statement_id and
                                f"{each.statement_id}{k}"})
        for k in range(2)
        for each in each_category().claims
    ]  # fmt: skip
    assert counted(*claims) == (
        "14 statements of the paper, in 20 readings: 2 hold as meant, 2 hold with a misprint, "
        "2 depend on the reading, 6 are refuted in every reading, 2 are undecided; 6 more claims "
        "are ours"
    )


def test_categories_without_a_statement_are_not_told_of() -> None:
    assert counted(reading("A", R), reading("B", P), table("C")) == (
        "3 statements of the paper, in 3 readings: 1 holds as meant, 2 are refuted in every reading"
    )
