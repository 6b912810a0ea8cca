"""Theorems of the theory by their names: only those that it states."""

import re

import pytest

from tests.paths import ROOT
from verify.proof.assistant.shipped_theory import ShippedTheorem, files, text_of


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("Plane", "telescopes_for_even"),
        ("Product", "product_near_one_by_exp"),  # a corollary
        ("Sums", "size_of_sum"),  # a lemma
        ("Theorems", "determinant_of_lie"),
    ],
)
def test_a_theorem_of_the_theory_has_its_name(file: str, name: str) -> None:
    assert str(ShippedTheorem(file, name)) == f"{file}.{name}"
    assert re.search(rf"^\s*(Theorem|Lemma|Corollary) {name}\b", text_of(file), re.MULTILINE)


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("Plane", "telescopes_for_odd"),
        ("Plane", "product_near_one"),  # of another file
        ("Plane", "determinant"),  # a definition
        ("Planes", "telescopes_for_even"),
        ("../Plane", "telescopes_for_even"),
        ("Plane", ""),
    ],
)
def test_what_the_theory_does_not_state_is_refused(file: str, name: str) -> None:
    with pytest.raises(ValueError, match=r"theorem=.*states none"):
        ShippedTheorem(file, name)


def test_every_file_of_the_theory_states_something_or_defines() -> None:
    assert all(
        re.search(r"^\s*(Theorem|Lemma|Corollary|Definition|Record)", text_of(n), re.M)
        for n in files()
    )


def test_the_page_about_theorems_names_what_the_theory_states() -> None:
    page = (ROOT / "docs" / "explanation" / "theorems.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`([A-Z]\w+)\.(\w+)`", page)) - {("File", "name")}  # of all of them
    assert len(named) > 20
    for file, name in named:
        ShippedTheorem(file, name)
