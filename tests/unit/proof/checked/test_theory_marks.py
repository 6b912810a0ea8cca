"""The marks of Rocq: of schemes of which a theorem speaks, and of no others."""

from dataclasses import replace
from fractions import Fraction

import pytest

from verify.proof.checked.proved_statement import (
    ALL,
    DEFECT,
    MAP,
    ProvedStatement,
    statement_for_every_h,
)
from verify.proof.checked.statements import stages, tableau
from verify.proof.checked.theory_marks import theory_marks
from verify.proof.order_for_every_h import prove_for_every_h
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations


def every(scheme: str, about: frozenset = ALL) -> ProvedStatement:
    return statement_for_every_h(prove_for_every_h(scheme), get(scheme), about)


def names(proved: ProvedStatement) -> list[str]:
    return [str(mark).partition(":")[0].removeprefix("Rocq, ") for mark in theory_marks(proved)]


@pytest.mark.parametrize(
    ("scheme", "expected"),
    [
        (
            "lie2",
            [
                "Theorems.determinant_of_lie_in_plane",
                "Theorems.flow_has_taylor_series",
                "Theorems.lie_telescopes_in_plane_for_even",
            ],
        ),
        (
            "lie3",
            [
                "Theorems.determinant_of_lie_in_plane",
                "Theorems.flow_has_taylor_series",
                "Theorems.lie_does_not_telescope_for_odd",
            ],
        ),
        (
            "yoshida4",
            ["Theorems.shears_are_symplectic, Theorems.symplectic_is_area_preserving"],
        ),
        (
            "implicit-midpoint",
            [
                "SymplecticMethods.stage_of_hamiltonian, Symplectic.steps_symplectic, "
                "Theorems.symplectic_is_area_preserving"
            ],
        ),
        (
            "gauss4",
            ["Theorems.runge_kutta_is_symplectic, Theorems.symplectic_is_area_preserving"],
        ),
        ("rk4", []),
    ],
)
def test_each_scheme_has_the_theorems_that_speak_of_it(scheme: str, expected: list[str]) -> None:
    assert names(every(scheme)) == expected


def test_what_is_not_asked_is_not_told() -> None:
    assert names(every("lie2", MAP)) == ["Theorems.flow_has_taylor_series"]
    assert names(every("lie2", frozenset({"product"}))) == ["Theorems.error_over_many_steps"]


def test_a_mark_has_the_order_of_its_scheme() -> None:
    (mark,) = theory_marks(every("lie4", DEFECT))
    assert "no term below h^5" in mark
    assert "−div(X^4 f)/5!" in mark
    (timed,) = theory_marks(
        statement_for_every_h(prove_for_every_h("lie4", timed=True), get("lie4"), DEFECT)
    )
    assert "H(p, q, t)" in timed
    assert "−div(D^4 f)/5!" in timed


def test_in_degrees_s_and_det_j_have_theorems_of_their_own() -> None:
    proof = prove_for_every_h("lie2", degrees=2)
    assert names(statement_for_every_h(proof, get("lie2"), DEFECT)) == ["Theorems.defect_of_lie"]
    volume = frozenset({"volume"})
    assert names(statement_for_every_h(proof, get("lie2"), volume)) == [
        "Theorems.determinant_of_lie"
    ]
    verlet = prove_for_every_h("stormer-verlet", degrees=2)
    assert names(statement_for_every_h(verlet, get("stormer-verlet"), volume)) == []


def test_odd_eta_is_shown_by_an_h_without_time_for_every_h_alone() -> None:
    found = every("lie3", frozenset({"telescopes"}))
    assert len(names(found)) == 1
    assert names(replace(found, for_every_h=False)) == []
    assert names(replace(found, timed=True)) == []


def test_where_delta_j_is_zero_its_first_coefficient_is_no_theorem_of_it() -> None:
    assert names(replace(every("lie2", DEFECT), preserves=True)) == []


@pytest.mark.parametrize(
    ("stage", "separable", "holds"),
    [
        (Stage(Fraction(1), Fraction(1), Fraction(1, 2), Fraction(1, 2)), False, True),
        (Stage(Fraction(1), Fraction(1), Fraction(1), Fraction(1, 2)), False, False),
        (Stage(Fraction(1), Fraction(2), Fraction(1, 2), Fraction(1, 2)), False, False),
        (Stage(Fraction(1), Fraction(2), Fraction(1, 2), Fraction(1, 2)), True, True),
        (Stage(Fraction(1), Fraction(0)), True, True),
    ],
)
def test_a_stage_has_the_theorem_where_its_condition_holds(
    stage: Stage, separable: bool, holds: bool
) -> None:
    assert stages.stages_fulfil(StageEquations((stage,), separable)) is holds


def test_a_tableau_has_the_theorem_where_its_condition_holds() -> None:
    assert tableau.fulfils(get("gauss4").every_h)
    assert not tableau.fulfils(get("rk4").every_h)
    assert not tableau.fulfils(get("yoshida4").every_h)
