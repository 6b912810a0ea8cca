"""Exported certificates of all kinds are proofs for `coqc`, which assume what they may assume."""

from pathlib import Path

import pytest

from tests.helpers.exports import ALL, EVERY, WRITTEN, export
from tests.helpers.rocq import accepted, beside, changed, coqc
from tests.helpers.rocq_assumptions import OF_THE_REALS, asked_together, printed_assumptions
from tests.rocq import STAND_ALONE

ALONE = [f"{name}_alone" for name in STAND_ALONE]
# Of these theorems of an export for every H the H is one of real numbers.
OF_REALS = ("first_coefficient_is_not_zero", "_over_the_reals")


@pytest.mark.parametrize("name", [*ALL, *ALONE])
def test_coqc_takes_the_export(exports: Path, name: str) -> None:
    refused = exports / f"{name}.refused"
    assert not refused.exists(), refused.read_text(encoding="utf-8")
    assert (exports / f"{name}.vo").exists()


def test_theorems_of_exports_assume_what_the_reals_do_or_nothing(
    theory: Path, exports: Path, tmp_path: Path
) -> None:
    every = [name for name in (*EVERY, *WRITTEN) if name.startswith("every")]
    groups: dict[str, list[str]] = {"of_rings": [], "of_reals": []}
    for name in [*ALL, *ALONE]:
        for theorem in export(name.removesuffix("_alone")).theorems:
            of_rings = name in every and not theorem.endswith(OF_REALS)
            groups["of_rings" if of_rings else "of_reals"].append(f"{name}.{theorem}")
    assert all(any(x.startswith(f"{name}.") for x in groups["of_rings"]) for name in every)
    asked = f"Require {' '.join([*ALL, *ALONE])}.\n" + "".join(
        asked_together(group, theorems) for group, theorems in groups.items()
    )
    folders = {**beside(theory), "": exports}  # their names stand alone
    algebraic, real = printed_assumptions(accepted(tmp_path / "asked.v", asked, folders))
    assert algebraic == frozenset()
    assert frozenset() < real <= OF_THE_REALS


def test_an_axiom_in_an_export_is_told_by_rocq(theory: Path, tmp_path: Path) -> None:
    name = "every_kick"
    text = changed(
        export(name).text,
        "Lemma checked : sound_for_every meant certified. Proof. constructor; "
        "[reflexivity..|vm_compute; reflexivity|vm_compute; reflexivity]. Qed.",
        "Axiom checked : sound_for_every meant certified.",
    )
    path = tmp_path / f"{name}.v"
    of_rings = [x for x in export(name).theorems if not x.endswith(OF_REALS)]
    path.write_text(text + asked_together("asked", of_rings), encoding="utf-8")
    found = coqc(path, beside(theory))
    assert found.status == 0, found.complaints
    assert printed_assumptions(found.said) == [frozenset({"checked"})]
