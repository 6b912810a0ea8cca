"""Exported certificates of all kinds are proofs for `coqc`, which assume what they may assume."""

from pathlib import Path

import pytest

from tests.helpers.exports import ALL, EVERY, WRITTEN, export
from tests.helpers.rocq import beside, changed, coqc
from tests.helpers.rocq_assumptions import OF_THE_REALS, printed_assumptions
from tests.rocq import STAND_ALONE

ALONE = [f"{name}_alone" for name in STAND_ALONE]


@pytest.mark.parametrize("name", [*ALL, *ALONE])
def test_coqc_takes_the_export(exports: Path, name: str) -> None:
    refused = exports / f"{name}.refused"
    assert not refused.exists(), refused.read_text(encoding="utf-8")
    assert (exports / f"{name}.vo").exists()


@pytest.mark.parametrize("name", [*ALL, *ALONE])
def test_an_export_prints_that_it_assumes_what_the_reals_do_or_nothing(
    exports: Path, name: str
) -> None:
    found = printed_assumptions((exports / f"{name}.said").read_text(encoding="utf-8"))
    plain = name.removesuffix("_alone")
    if plain not in (*EVERY, *WRITTEN) or not plain.startswith("every"):
        (of_all,) = found
        assert frozenset() < of_all <= OF_THE_REALS
        return
    # Those of rings are asked together, and those over the reals.
    of_rings, of_reals = found
    assert of_rings == frozenset()
    assert frozenset() < of_reals <= OF_THE_REALS


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
