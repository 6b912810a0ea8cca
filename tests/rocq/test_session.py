"""A session of Rocq says of right texts that they are taken, of wrong ones where they are not."""

import pytest

from tests.helpers.rocq.session import Session, first_missing

pytestmark = pytest.mark.left_to_ci

RIGHT = "Definition one := 1.\nLemma it_is : one = 1.\nProof. reflexivity. Qed.\nCheck it_is.\n"
WRONG = RIGHT.replace("one = 1", "one = 2")


def test_what_is_taken_is_told_from_what_is_refused(rocq: Session) -> None:
    assert rocq.accepted(RIGHT) == "it_is\n     : one = 1\n"
    assert rocq.stops_at(WRONG) == "it_is"
    with pytest.raises(AssertionError, match="Unable to unify"):
        rocq.accepted(WRONG)
    with pytest.raises(AssertionError, match="The command has not failed"):
        rocq.stops_at(RIGHT)


@pytest.mark.parametrize(
    "left",
    ["Lemma open : 1 = 1.\n", "Theorem open : 1 = 1.\nProof. reflexivity.\n"],
    ids=["begun", "not ended"],
)
def test_a_proof_without_an_end_is_not_taken(rocq: Session, left: str) -> None:
    with pytest.raises(AssertionError, match="open proofs"):
        rocq.accepted(left)
    assert rocq.stops_at(left) == "open"


def test_what_has_no_meaning_is_no_refusal(rocq: Session) -> None:
    for text in ("Lemma (.\n", "Lemma l : one = 1.\n"):
        with pytest.raises(AssertionError, match=r"Syntax error|was not found"):
            rocq.stops_at(text)


def test_a_warning_is_a_complaint(rocq: Session) -> None:
    text = f'Notation "x + y" := x : nat_scope.\n{RIGHT}'
    assert "it_is" in rocq.accepted(text, warned=True)
    with pytest.raises(AssertionError, match="overridden"):
        rocq.accepted(text)


def test_a_text_leaves_nothing(rocq: Session) -> None:
    rocq.accepted(f"From Coq Require Import Reals.\nLocal Open Scope R_scope.\n{RIGHT}")
    rocq.accepted(
        "Fail Check one.\nFail Check Rplus.\nLemma l : 1 = S O.\nProof. reflexivity. Qed.\n"
    )


def test_the_first_that_is_not_defined_is_found_behind_another_of_its_name() -> None:
    text = "Lemma a : T.\nModule M.\n  Lemma b : T.\nEnd M.\n(*\nLemma c : T. *)\nLemma b : T.\n"
    assert first_missing(text, "") == "a"
    assert first_missing(text, "a is defined\nb is defined\n") == "b"
    assert first_missing(text, "b is defined\na is defined\n") == "b"
    assert first_missing(text, "a is defined\nb is defined\nb is defined\n").startswith("nothing")
