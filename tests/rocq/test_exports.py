"""Exported certificates of all kinds are proofs for Rocq, which assume what they may assume."""

import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.helpers.rocq.assumptions import (
    ASKED,
    OF_THE_REALS,
    asked_together,
    printed_assumptions,
)
from tests.helpers.rocq.coqc import accepted, beside, changed, in_module
from tests.helpers.rocq.exports import ALL, export
from tests.helpers.rocq.session import Session

pytestmark = pytest.mark.left_to_ci

_LIBRARY = re.compile(r"^From Coq Require Import ([^.]*)\.\n", re.MULTILINE)
_IMPORTED = re.compile(r"^From \w+ Require Import [^.]*\.$", re.MULTILINE)
# One of each that import the same.
BY_THEMSELVES = (
    "every_lie2", "every_kick", "pendulum_lie2", "pendulum_lie3", "kick_of_two",
    "stormer_verlet", "two_roots", "gauss4",
)  # fmt: skip
# The shortest of those for every H, for one, and by coefficients.
ALONE = ("every_kick_of_two", "kick_of_two", "stormer_verlet")


def of_rings_in(name: str) -> bool:
    """Whether an export has theorems of rings, which it asks about first; then those of reals."""
    return name.startswith("every_")


def test_those_by_themselves_are_one_of_each_that_import_the_same() -> None:
    imported = {name: tuple(_IMPORTED.findall(export(name).text)) for name in ALL}
    assert sorted(imported[name] for name in BY_THEMSELVES) == sorted(set(imported.values()))


@pytest.mark.parametrize(
    "names",
    [
        pytest.param(BY_THEMSELVES, id="one-of-each"),
        pytest.param(tuple(ALL), id="all", marks=pytest.mark.sample(0)),
    ],
)
def test_coqc_takes_exports_which_assume_what_the_reals_do_or_nothing(
    names: Sequence[str], theory: Path, tmp_path: Path
) -> None:
    """Each a module of one file, which imports the library once: that takes as long as an export.

    What they assume is asked of all together, as to print it takes longer still. What one imports
    the next has, too: of those that import the same, one is taken by itself in the next test.
    """
    texts = {name: export(name).text for name in names}
    asked = {name: ASKED.findall(text) for name, text in texts.items()}
    rings = [f"{name}.{asked[name].pop(0)}" for name in names if of_rings_in(name)]
    reals = [f"{name}.{of_all}" for name in names for of_all in asked[name]]
    assert len(reals) == len(names)
    library = sorted({word for text in texts.values() for word in imported_of_library(text)})
    modules = [in_module(name, _LIBRARY.sub("", ASKED.sub("", texts[name]))) for name in names]
    loaded = f'Set Warnings "-require-in-module".\nFrom Coq Require Import {" ".join(library)}.\n'
    together = [
        loaded,
        *modules,
        asked_together("of_rings", rings),
        asked_together("of_reals", reals),
    ]
    said = accepted(tmp_path / "exports.v", "".join(together), beside(theory))
    check_assumptions(said, of_rings=True)


def imported_of_library(text: str) -> list[str]:
    """The files of the library that a text imports."""
    return [word for found in _LIBRARY.findall(text) for word in found.split()]


@pytest.mark.parametrize("name", BY_THEMSELVES)
def test_an_export_is_taken_by_itself_with_what_it_imports(rocq: Session, name: str) -> None:
    rocq.accepted(ASKED.sub("", export(name).text))


@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=[] if x in ALONE else pytest.mark.sample(0)) for x in ALL]
)
def test_coqc_takes_an_export_that_stands_alone_and_says_what_it_assumes(
    name: str, tmp_path: Path
) -> None:
    """With what it needs of the theory, which takes as long as to compile that."""
    said = accepted(tmp_path / f"{name}.v", export(name, stands_alone=True).text)
    check_assumptions(said, of_rings=of_rings_in(name))


def check_assumptions(said: str, *, of_rings: bool) -> None:
    """That Rocq says, of theorems of rings, that they assume nothing; of others, what reals do."""
    *rings, reals = printed_assumptions(said)
    assert rings == [frozenset()] * of_rings
    assert frozenset() < reals <= OF_THE_REALS


def test_an_axiom_in_an_export_is_told_by_rocq(rocq: Session) -> None:
    text = changed(
        export("every_kick").text,
        "Lemma checked : sound_for_every meant certified. Proof. constructor; "
        "[reflexivity..| |]; vm_cast_no_check (eq_refl true). Qed.",
        "Axiom checked : sound_for_every meant certified.",
    )
    of_rings, of_reals = printed_assumptions(rocq.accepted(text))
    assert of_rings == {"Data.checked"}
    assert of_reals - OF_THE_REALS == {"Data.checked"}


def test_what_stands_in_the_data_hides_nothing_of_what_is_read(rocq: Session) -> None:
    """H, and a word of the theory, that mean something else there."""
    text = changed(
        export("every_kick").text,
        "End Data.",
        "Definition meant_otherwise := meant. Definition belongs := True. "
        'Definition hamiltonian := 0. Notation "x == y" := True : ring_of_functions. End Data.',
    )
    of_rings, of_reals = printed_assumptions(rocq.accepted(text, warned=True))  # of the notation
    assert of_rings == frozenset()
    assert of_reals <= OF_THE_REALS
