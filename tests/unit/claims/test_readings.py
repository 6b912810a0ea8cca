"""Readings of one statement: what a claims file may say of them, and what holds of a statement."""

from collections.abc import Callable
from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.prose import Prose
from verify.scenes.results.claim import (
    Category,
    Outcome,
    Standing,
    StatementResult,
    describe_counts,
    outcome_of,
    statements_of,
)
from verify.verdict import Verdict

HEAD = 'title = "A paper"\n[defaults]\nscheme = "lie2"\nsystem = "harmonic"\nkind = "order"\n'
PROVED, REFUTED, UNDECIDED = Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED


def claim(name: str, order: int = 4, **keys: str) -> str:
    """ΔJ of lie2 on the oscillator is of order 4, so that this order alone holds."""
    said = "".join(f'{key} = "{text}"\n' for key, text in keys.items())
    return f'[[claim]]\nid = "{name}"\norder = {order}\n{said}'


@pytest.fixture
def written(tmp_path: Path) -> Callable[..., Path]:
    def write(*claims: str, head: str = HEAD) -> Path:
        path = tmp_path / "claims.toml"
        path.write_text(head + "".join(claims), encoding="utf-8")
        return path

    return write


# -- what holds of a statement --------------------------------------------------------------------

OUTCOMES = [  # of fair readings, and of a strict or a misprinted one
    ((PROVED,), (), Outcome.HOLDS),
    ((PROVED, Verdict.MEASURED, Verdict.ENCLOSED), (), Outcome.HOLDS),
    ((REFUTED, PROVED), (), Outcome.IN_SOME),
    ((PROVED, UNDECIDED), (), Outcome.IN_SOME),
    ((REFUTED, REFUTED), (), Outcome.REFUTED),
    ((REFUTED, UNDECIDED), (), Outcome.UNDECIDED),
    ((UNDECIDED,), (), Outcome.UNDECIDED),
    ((PROVED,), (REFUTED,), Outcome.HOLDS),
    ((PROVED,), (UNDECIDED,), Outcome.HOLDS),
    ((REFUTED, PROVED), (PROVED,), Outcome.IN_SOME),
    ((REFUTED,), (PROVED,), Outcome.IN_SOME),
    ((UNDECIDED,), (PROVED,), Outcome.IN_SOME),
    ((REFUTED,), (REFUTED,), Outcome.REFUTED),
    ((REFUTED,), (UNDECIDED,), Outcome.UNDECIDED),
]


@pytest.mark.parametrize("standing", ["strict", "misprint"])
@pytest.mark.parametrize(("fair", "others", "outcome"), OUTCOMES)
def test_a_statement_holds_as_it_is_meant_and_is_refuted_only_where_every_reading_is(
    fair: tuple[Verdict, ...], others: tuple[Verdict, ...], outcome: Outcome, standing: Standing
) -> None:
    readings = [*((v, "fair") for v in fair), *((v, standing) for v in others)]
    assert outcome_of(readings) is outcome  # type: ignore[arg-type]
    assert outcome_of(readings[::-1]) is outcome  # type: ignore[arg-type]


def test_readings_have_the_texts_of_their_statement_and_are_counted_with_it(
    written: Callable[..., Path],
) -> None:
    path = written(
        claim("a", source="Eq. 1", section="1 One", statement="It is so.", reading="loosely"),
        claim("b", 3, reading_of="a", reading="to the letter", standing="strict"),
        claim("c", 3, statement="Another."),
        claim("d", 3, statement="Ours.", standing="ours"),
    )
    check = prepare(load_claims(path))
    found = check.run(Store(None), where=THIS_PROCESS)
    assert [(c.statement_id, str(c.statement), c.source) for c in found] == [
        ("a", "It is so.", "Eq. 1"), ("a", "It is so.", "Eq. 1"), ("c", "Another.", ""),
        ("", "Ours.", ""),
    ]  # fmt: skip
    assert (found[1].reading, found[1].standing, found[1].section) == (
        "to the letter", "strict", "1 One",
    )  # fmt: skip
    statements = check.statements(found)
    assert [(s.id, s.outcome, s.readings) for s in statements] == [
        ("a", Outcome.HOLDS, ("a", "b")),
        ("c", Outcome.REFUTED, ("c",)),
    ]
    assert describe_counts(statements, found) == (
        "2 statements of the paper, in 3 readings: 1 holds as meant, 1 is refuted in every "
        "reading; 1 more claim is ours"
    )


def test_misprints_of_what_holds_as_meant_are_counted_apart(written: Callable[..., Path]) -> None:
    path = written(
        claim("a", 3, standing="misprint", reading="as printed"),
        claim("b", reading_of="a", reading="as meant"),
        claim("c"),
        claim("d", 3, standing="misprint", reading="as printed"),
        claim("e", 3, reading_of="d", reading="otherwise"),
    )
    check = prepare(load_claims(path))
    results = check.run(Store(None), where=THIS_PROCESS)
    assert describe_counts(check.statements(results), results) == (
        "3 statements of the paper, in 5 readings: 1 holds as meant, 1 holds with a misprint, 1 "
        "is refuted in every reading"
    )


@pytest.mark.parametrize(
    ("outcome", "category", "of_a_misprint"),
    [
        (Outcome.HOLDS, Category.AS_MEANT, Category.MISPRINTED),
        (Outcome.IN_SOME, Category.DEPENDS, Category.DEPENDS),
        (Outcome.REFUTED, Category.REFUTED, Category.REFUTED),
        (Outcome.UNDECIDED, Category.UNDECIDED, Category.UNDECIDED),
    ],
)
def test_a_statement_has_the_category_of_its_outcome_and_of_its_misprint(
    outcome: Outcome, category: Category, of_a_misprint: Category
) -> None:
    statement = StatementResult(
        id="a", source="", section="", statement=Prose("x"), outcome=outcome, readings=("a",)
    )
    assert statement.category is category
    assert statement.model_copy(update={"misprinted": True}).category is of_a_misprint


def test_a_reading_that_is_a_misprint_makes_its_statement_misprinted(
    written: Callable[..., Path],
) -> None:
    path = written(
        claim("a", reading="as meant"),
        claim("b", 3, reading_of="a", reading="as printed", standing="misprint"),
        claim("c", reading="as meant"),
        claim("d", 3, reading_of="c", reading="exactly", standing="strict"),
    )
    check = prepare(load_claims(path))
    statements = check.statements(check.run(Store(None), where=THIS_PROCESS))
    assert [(each.id, each.misprinted) for each in statements] == [("a", True), ("c", False)]


@pytest.mark.parametrize(
    ("category", "one", "several"),
    [
        (Category.AS_MEANT, "holds as meant", "hold as meant"),
        (Category.MISPRINTED, "holds with a misprint", "hold with a misprint"),
        (Category.DEPENDS, "depends on the reading", "depend on the reading"),
        (Category.REFUTED, "is refuted in every reading", "are refuted in every reading"),
        (Category.UNDECIDED, "is undecided", "are undecided"),
    ],
)
def test_a_category_is_a_verb_of_one_statement_and_of_several(
    category: Category, one: str, several: str
) -> None:
    assert (category.verb(1), category.verb(2), category.verb(0)) == (one, several, several)


def test_a_statement_of_which_a_reading_is_not_checked_has_no_outcome(
    written: Callable[..., Path],
) -> None:
    path = written(claim("a", 3), claim("b", reading_of="a", reading="rightly"), claim("c"))
    check = prepare(load_claims(path), ["a", "c"])
    found = check.run(Store(None), where=THIS_PROCESS)
    assert [each.id for each in check.statements(found)] == ["c"]


def test_a_file_that_says_nothing_of_readings_counts_claims_alone(
    written: Callable[..., Path],
) -> None:
    check = prepare(load_claims(written(claim("a"), claim("b", 3))))
    found = check.run(Store(None), where=THIS_PROCESS)
    assert statements_of(found) == check.statements(found) == ()


# -- mistakes -------------------------------------------------------------------------------------

FIRST = claim("a", statement="It is so.")
WRONG = {
    "unknown": (FIRST + claim("b", reading_of="A", reading="so"), "no claim before this one"),
    "later": (claim("b", reading_of="a", reading="so") + FIRST, "no claim before this one"),
    "of-itself": (claim("b", reading_of="b", reading="so"), "no claim before this one"),
    "of-a-reading": (
        FIRST + claim("b", reading_of="a", reading="so") + claim("c", reading_of="b", reading="x"),
        "is a reading of a; name a statement's first claim",
    ),
    "of-ours": (
        claim("a", standing="ours") + claim("b", reading_of="a", reading="so"),
        "is ours; name a statement's first claim",
    ),
    "ours": (
        FIRST + claim("b", reading_of="a", reading="so", standing="ours"),
        "is no reading of a paper's statement",
    ),
    "with-a-statement": (
        FIRST + claim("b", reading_of="a", reading="so", statement="Or so."),
        "is that of a; say how it is read",
    ),
    "without-words": (FIRST + claim("b", reading_of="a"), "is missing: how a is read here"),
    "none-fair": (
        claim("a", standing="misprint")
        + claim("b", reading_of="a", reading="x", standing="strict"),
        "no reading of this statement is fair",
    ),
    "no-such-standing": (claim("a", standing="mine"), "'fair', 'strict', 'misprint' or 'ours'"),
    "no-such-key": (FIRST + claim("b", reading_off="a"), "reading_off"),
}  # fmt: skip


@pytest.mark.parametrize(("body", "problem"), WRONG.values(), ids=WRONG)
def test_what_cannot_be_said_of_readings_is_named_with_its_line(
    written: Callable[..., Path], body: str, problem: str
) -> None:
    with pytest.raises(InputError, match=r"claims\.toml:\d+: claim [abc]: ") as told:
        load_claims(written(body))
    assert problem in str(told.value)
    assert "\n" not in str(told.value)


ROOTS = {
    "about": ('about = "A text"\n', "about"),
    "number": ("about = [1]\n", "about"),
    "left_out": ('left_out = [{ what = "x" }]\n', "left_out"),
    "one": ('left_out = "x"\n', "left_out"),
}


@pytest.mark.parametrize(("head", "key"), ROOTS.values(), ids=ROOTS)
def test_what_a_file_says_before_and_after_its_claims_is_checked(
    written: Callable[..., Path], head: str, key: str
) -> None:
    with pytest.raises(InputError, match=key):
        load_claims(written(claim("a"), head=head + HEAD))
    good = 'about = ["A text."]\nleft_out = [{ what = "x", why = "y" }]\n'
    file = load_claims(written(claim("a"), head=good + HEAD))
    assert (file.about, file.left_out) == (("A text.",), (("x", "y"),))
