"""What of the theory a file that stands alone holds: all that it names, and no lemma beyond."""

import re
from collections.abc import Iterable

import pytest

from tests.helpers.rocq.exports import ALL, export
from verify.proof.assistant.shipped_theory import (
    files,
    format_modules,
    parts_of,
    select_needed,
    sort_by_imports,
    text_of,
    without_comments,
    words_of,
)

NUMBERS = """(** Numbers, and a comment (* within *) it. *)

From Coq Require Import Lia.
Local Open Scope nat_scope.

Definition two := 2. (* . *)
Definition three := 3.

Notation "x ++" := (S x).

Section Sums.
  Context (n : nat).
  Notation m := (n + two).

  (** By which what is meant is seen. *)
  Lemma more' : n <= m.
  Proof. assert (a : two = 2). { reflexivity. } rewrite a. lia. Qed.

  Theorem much_more : n <= m + three.
  Proof. pose more'. unfold three. lia. Qed.
End Sums.

Section Empty.
  Context (k : nat).
  Lemma none : k = k. Proof. reflexivity. Qed.
End Empty.
"""
OTHERS = (
    "From Coq Require Import Lia.\nLemma of_others : 1 = 1.\nProof. intro none. reflexivity. Qed.\n"
)


@pytest.mark.parametrize("text", [NUMBERS, OTHERS, *map(text_of, files())])
def test_the_parts_are_the_file(text: str) -> None:
    parts = parts_of(text)
    assert "".join(part.text for part in parts) == text
    proofs = len(re.findall(r"\b(?:Qed|Defined)\.", without_comments(text)))
    assert sum(bool(re.search(r"\bProof\b", part.text)) for part in parts) <= proofs
    sections = [part.section for part in parts if part.section]
    assert sections == sorted(sections, key=sections.index)


def left(by: str, *names: str) -> dict[str, str]:
    """Of these files, each of which imports those before it."""
    texts = {"Numbers": NUMBERS, "Others": OTHERS}
    return select_needed(
        {x: texts[x] for x in names}, {x: names[: k + 1] for k, x in enumerate(names)}, by
    )


def test_a_lemma_in_use_stays_with_what_its_proof_and_its_section_need() -> None:
    whole = re.sub(r"\nSection Empty.*End Empty\.\n", "", NUMBERS, flags=re.DOTALL)
    assert left("Check (much_more, three).", "Numbers", "Others") == {"Numbers": whole}


def test_a_lemma_that_is_not_in_use_goes_with_what_it_alone_needs() -> None:
    text = left("Check more'.", "Numbers")["Numbers"]
    assert "much_more" not in text
    assert "three" not in text
    assert "two" in text


def test_a_section_goes_with_its_last_lemma_and_a_notation_for_all_stays() -> None:
    text = left("(* much_more *) Check much_mor, xmuch_more.", "Numbers")["Numbers"]
    assert 'Notation "x ++" := (S x).' in text
    assert "Local Open Scope nat_scope." in text
    assert not {"Section", "Context", "two"} & words_of(without_comments(text))


def test_a_name_means_something_in_files_that_may_name_it() -> None:
    assert "Lemma none" in left("Check of_others.", "Numbers", "Others")["Numbers"]
    assert "Lemma none" not in left("Check of_others.", "Others", "Numbers")["Numbers"]


def test_a_file_of_which_nothing_is_left_goes_unless_it_is_named() -> None:
    assert left("", "Others") == {}
    assert list(left("Others.x", "Others")) == ["Others"]


def names_in(texts: Iterable[str]) -> set[str]:
    return {part.name for text in texts for part in parts_of(text) if part.name}


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", ALL)
def test_an_export_holds_what_its_files_name_and_no_lemma_that_nothing_names(name: str) -> None:
    *modules, rest = re.split(
        r"^Module (?=\w+\.$)", export(name, stands_alone=True).text, flags=re.M
    )
    held = {module.split(".")[0]: module.partition("\n")[2] for module in modules[1:]}
    assert len(held) > 5
    for file, text in held.items():
        below = sort_by_imports([file])
        whole = names_in(map(text_of, below))
        stated = names_in(held[name] for name in below if name in held)
        assert words_of(without_comments(text)) & whole <= stated, file
    parts = [part for text in [*held.values(), rest] for part in parts_of(text)]
    for part in parts_of("".join(held.values())):
        named = any(part.name in other.words for other in parts if other.text != part.text)
        assert part.name is None or named, part.name


def test_most_of_the_theory_is_left_out_where_little_is_needed() -> None:
    assert format_modules(["Theorems"], user_text="").count("Lemma ") < 5
    assert format_modules(["Totals"], user_text="total_zero").count("Lemma total_") == 1
