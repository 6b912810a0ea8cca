"""Exported certificates of all kinds are proofs for `coqc`, which assume what they may assume."""

from pathlib import Path

import pytest

from tests.helpers.exports import ALL, export
from tests.helpers.rocq import accepted, beside, changed, coqc
from tests.helpers.rocq_assumptions import (
    ASKED,
    OF_THE_REALS,
    asked_together,
    printed_assumptions,
)

pytestmark = pytest.mark.left_to_ci


@pytest.mark.parametrize("name", ALL)
def test_coqc_takes_the_export(exports: Path, name: str) -> None:
    refused = exports / f"{name}.refused"
    assert not refused.exists(), refused.read_text(encoding="utf-8")
    assert (exports / f"{name}.vo").exists()


def of_rings_in(name: str) -> bool:
    """Whether an export has theorems of rings, which it asks about first; then those of reals."""
    return name.startswith("every_")


def test_all_exports_assume_what_the_reals_do_or_nothing(
    theory: Path, exports: Path, tmp_path: Path
) -> None:
    """As they ask themselves, each apart: that is done in the next test."""
    asked = {name: ASKED.findall(export(name).text) for name in ALL}
    rings = [f"{name}.{asked[name].pop(0)}" for name in ALL if of_rings_in(name)]
    reals = [f"{name}.{of_all}" for name in ALL for of_all in asked[name]]
    assert len(reals) == len(ALL)
    loaded = f"Require {' '.join(ALL)}.\n"
    text = loaded + asked_together("of_rings", rings) + asked_together("of_reals", reals)
    said = accepted(tmp_path / "asked.v", text, {**beside(theory), "": exports})
    check_assumptions(said, of_rings=True)


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", ALL)
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


def test_an_axiom_in_an_export_is_told_by_rocq(theory: Path, tmp_path: Path) -> None:
    name = "every_kick"
    text = changed(
        export(name).text,
        "Lemma checked : sound_for_every meant certified. Proof. constructor; "
        "[reflexivity..| |]; vm_cast_no_check (eq_refl true). Qed.",
        "Axiom checked : sound_for_every meant certified.",
    )
    path = tmp_path / f"{name}.v"
    path.write_text(text, encoding="utf-8")
    found = coqc(path, beside(theory))
    assert found.status == 0, found.complaints
    of_rings, of_reals = printed_assumptions(found.said)
    assert of_rings == {"Data.checked"}
    assert of_reals - OF_THE_REALS == {"Data.checked"}


def test_what_stands_in_the_data_hides_nothing_of_what_is_read(
    theory: Path, tmp_path: Path
) -> None:
    """H, and a word of the theory, that mean something else there."""
    name = "every_kick"
    text = changed(
        export(name).text,
        "End Data.",
        "Definition meant_otherwise := meant. Definition belongs := True. "
        'Definition hamiltonian := 0. Notation "x == y" := True : ring_of_functions. End Data.',
    )
    path = tmp_path / f"{name}.v"
    path.write_text(text, encoding="utf-8")
    found = coqc(path, beside(theory))  # which warns of the notation
    assert found.status == 0, found.complaints
    of_rings, of_reals = printed_assumptions(found.said)
    assert of_rings == frozenset()
    assert of_reals <= OF_THE_REALS
