"""The theory compiles as it stands; its theorems assume what the library's reals do, or nothing."""

import re
from pathlib import Path

import pytest

from tests.helpers.rocq.assumptions import (
    OF_THE_REALS,
    asked_together,
    assuming_words,
    printed_assumptions,
)
from tests.helpers.rocq.session import Session
from verify.proof.assistant.shipped_theory import FOLDER, files, sort_by_imports, text_of

pytestmark = pytest.mark.left_to_ci

_THEOREM = re.compile(r"^ *(?:Theorem|Corollary|Lemma) (\w+)", re.MULTILINE)
_LIBRARIES = re.compile(r"^From Coq Require Import ([^.]*)\.", re.MULTILINE)
_WITH_REALS = {"Reals", "Qreals", "Lra", "Rtrigo_reg"}
# Files that stand on nothing but rings, in which the theorems for every H are.
ALGEBRAIC = {"LieScheme", "Step", "Plane", "Determinant", "EveryClaims", "EveryNumbers"}
PLANTED = {
    "by_axiom": "Axiom by_axiom : 1 = 2.",
    "by_parameter": "Parameters by_parameter : 1 = 2.",
    "by_context": "Context (by_context : 1 = 2).",
    "by_hand": "Theorem by_hand : 1 = 2. Proof. Admitted.",
}


def theorems_of(name: str) -> list[str]:
    """The theorems and lemmas of a file, with its name before theirs."""
    return [f"{name}.{found}" for found in _THEOREM.findall(text_of(name))]


def without_reals(name: str) -> bool:
    """Whether neither the file nor what it stands on imports the library's real numbers."""
    found = (lib for below in sort_by_imports([name]) for lib in _LIBRARIES.findall(text_of(below)))
    return not _WITH_REALS & {word for line in found for word in line.split()}


def test_all_files_of_an_installed_theory_compile_by_its_project_file(theory: Path) -> None:
    """A test without coqc holds that they stand in the right order there."""
    compiled = {path.relative_to(theory).with_suffix(".v") for path in theory.rglob("*.vo")}
    assert compiled == {path.relative_to(FOLDER) for path in files().values()}


def test_theorems_of_the_theory_assume_what_the_reals_do_or_nothing(rocq: Session) -> None:
    of_rings = {name for name in files() if without_reals(name)}
    assert ALGEBRAIC <= of_rings < set(files())
    groups = {"of_rings": of_rings, "of_reals": set(files()) - of_rings}
    asked = f"From AreaPreservation Require {' '.join(sorted(files()))}.\n" + "".join(
        asked_together(group, [x for name in sorted(names) for x in theorems_of(name)])
        for group, names in groups.items()
    )
    algebraic, real = printed_assumptions(rocq.accepted(asked))
    assert algebraic == frozenset()
    assert frozenset() < real <= OF_THE_REALS


def test_what_is_planted_in_a_file_of_the_theory_is_seen_in_its_words_and_told_by_rocq(
    rocq: Session,
) -> None:
    text = text_of("Totals")
    for name, sentence in PLANTED.items():
        before = assuming_words(text)
        assert len(assuming_words(f"{text}{sentence}\n")) == len(before) + 1, name
        text += f"{sentence}\nTheorem used_{name} : 2 = 1. Proof. symmetry. exact {name}. Qed.\n"
    text += "".join(asked_together(f"asked_{name}", [f"used_{name}"]) for name in PLANTED)
    # Of axioms in no section coqc warns, which is no refusal.
    said = rocq.accepted(f'Set Warnings "-all".\n{text}')
    assert printed_assumptions(said) == [frozenset({name}) for name in PLANTED]
