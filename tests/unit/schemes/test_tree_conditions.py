"""Conditions by rooted trees: the trees, methods whose order is known, planted errors."""

import math
import time
from dataclasses import replace
from fractions import Fraction

import flint
import pytest
import sympy

from tests.helpers.lie_derivatives import lie_derivatives
from tests.helpers.stepping.implicit_steps import NONLINEAR, RADAU, TABLEAUS, places, planted
from tests.helpers.symmetry import symmetry_conditions
from verify import schemes
from verify.algebra.jets import Jets
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof import order_for_every_h
from verify.proof.order_for_every_h import counterexample, prove_for_every_h
from verify.proof.order_for_one_h import convergence_of, prove
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.schemes.conditions.coloured_trees import condition_text, density, symmetry, vertices
from verify.schemes.conditions.condition import ByConditions, Condition
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import Differentials, TreeConditions, cancels, trees
from verify.schemes.maps.kinds.implicit_runge_kutta import implicit_map, order_of
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

R = sympy.Rational
# Orders as they are printed in Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations.
KNOWN = {
    "euler": (ImplicitTableau.from_numbers([[0]], [1]), 1),
    "implicit euler": (ImplicitTableau.from_numbers([[1]], [1]), 1),
    "heun": (ImplicitTableau.from_numbers([[0, 0], [1, 0]], [R(1, 2)] * 2), 2),
    "kutta 3": (ImplicitTableau.from_numbers([[0, 0, 0], [R(1, 2), 0, 0], [-1, 2, 0]],
                                   [R(1, 6), R(2, 3), R(1, 6)]), 3),
    "rk4": (ImplicitTableau.from_numbers([[0] * 4, [R(1, 2), 0, 0, 0],
                                         [0, R(1, 2), 0, 0], [0, 0, 1, 0]],
                               [R(1, 6), R(1, 3), R(1, 3), R(1, 6)]), 4),
    "radau IIA": (RADAU, 3),
    "lobatto IIIA": (ImplicitTableau.from_numbers(
        [[0, 0, 0], [R(5, 24), R(1, 3), R(-1, 24)], [R(1, 6), R(2, 3), R(1, 6)]],
        [R(1, 6), R(2, 3), R(1, 6)]), 4),
    "implicit-midpoint": (TABLEAUS["implicit-midpoint"], 2),
    "gauss4": (TABLEAUS["gauss4"], 4),
    "gauss6": (TABLEAUS["gauss6"], 6),
}  # fmt: skip
PRESERVING = {"implicit-midpoint", "gauss4", "gauss6"}
SYMMETRIC = PRESERVING | {"lobatto IIIA"}


def made(tableau: ImplicitTableau, order: int) -> Scheme:
    """A scheme that claims this order, and det J ≡ 1."""
    return Scheme(
        name="made", order=order, area_preserving=True, explicit=False, symmetric=True,
        source="this test", build=lambda h: implicit_map(h, tableau),
        every_h=TreeConditions(tableau),
    )  # fmt: skip


def proof_of(
    monkeypatch: pytest.MonkeyPatch, tableau: ImplicitTableau, order: int, separable: bool = False
) -> ProofForEveryH:
    monkeypatch.setattr(order_for_every_h, "get", lambda _: made(tableau, order))
    return prove_for_every_h("made", separable)


# -- trees ----------------------------------------------------------------------------------------


def test_there_are_as_many_trees_as_are_known() -> None:
    counts = [1, 1, 2, 4, 9, 20, 48, 115, 286, 719]
    assert [len(trees(n)) for n in range(1, 11)] == counts
    assert all(len(set(trees(n))) == len(trees(n)) for n in range(1, 11))
    assert all(vertices(t) == n for n in range(1, 11) for t in trees(n))


@pytest.mark.parametrize("order", range(1, 10))
def test_monotone_labellings_add_up_to_a_factorial(order: int) -> None:
    """Σ n!/(γ σ) = (n−1)!, the number of monotonically labelled trees (theorem II.2.6)."""
    labelled = sum(Fraction(math.factorial(order), density(t) * symmetry(t)) for t in trees(order))
    assert labelled == math.factorial(order - 1)


@pytest.mark.parametrize("order", range(1, 8))
def test_differentials_over_density_and_symmetry_are_the_exact_flow(order: int) -> None:
    differentials = Differentials(Jets(order))
    for part, name in enumerate("pq"):
        total = differentials.jets.zero
        for tree in trees(order):
            total += differentials.differential(tree)[part] * flint.fmpq(
                1, density(tree) * symmetry(tree)
            )
        assert (
            total * math.factorial(order) == lie_derivatives(differentials.jets, name, order)[order]
        )


def test_conditions_are_written_as_in_the_literature() -> None:
    few = [condition_text(t) for n in (1, 2, 3) for t in trees(n)]
    assert few == ["b·1", "b·c", "b·A(c)", "b·c^2"]
    assert {condition_text(t): density(t) for t in trees(4)} == {
        "b·A(A(c))": 24, "b·A(c^2)": 12, "b·(c A(c))": 8, "b·c^3": 4,
    }  # fmt: skip


# -- methods --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", KNOWN)
def test_known_methods_have_their_order(name: str) -> None:
    tableau, order = KNOWN[name]
    conditions = TreeConditions(tableau).order_conditions(order + 1)
    assert all(c.holds and c.residue == "0" for c in conditions if c.order <= order)
    wrong = [c for c in conditions if c.order == order + 1 and c.holds is False]
    assert wrong
    assert all(float(c.residue) != 0 for c in wrong)


@pytest.mark.parametrize("name", KNOWN)
def test_known_methods_preserve_area_and_are_symmetric_as_is_known(name: str) -> None:
    tableau, _ = KNOWN[name]
    assert all(c.holds for c in tableau.area_conditions()) is (name in PRESERVING)
    assert all(c.holds for c in symmetry_conditions(TreeConditions(tableau))) is (name in SYMMETRIC)


@pytest.mark.parametrize("name", KNOWN)
def test_the_order_for_every_h_is_the_one_of_a_nonlinear_h(name: str) -> None:
    tableau, order = KNOWN[name]
    proof = prove(implicit_map(Hamiltonian.parse("p**2/2 + p*q**2 + q**3/3 + q**2/2"), tableau))
    assert proof.convergence_order == order
    assert proof.area_preserving is (name in PRESERVING)


def test_the_residue_is_that_of_plain_arithmetic() -> None:
    """b·A(c) − 1/6 of Radau IIA with an error in a_12, by fractions."""
    tableau = planted(RADAU, 0, 1, R(1, 10**6))
    a = [[Fraction(str(x)) for x in row] for row in tableau.rows]
    b = [Fraction(str(x)) for x in tableau.weights]
    c = [sum(row) for row in a]
    true = sum(b[i] * a[i][j] * c[j] for i in (0, 1) for j in (0, 1)) - Fraction(1, 6)
    (found,) = [x for x in TreeConditions(tableau).order_conditions(3) if x.name == "b·A(c) = 1/6"]
    assert abs(Fraction(found.residue) - true) < abs(true) / 10**4
    assert true != 0


@pytest.mark.parametrize("name", ["gauss4", "gauss6"])
def test_gauss_methods_are_proved_for_every_h(name: str) -> None:
    proof, scheme = prove_for_every_h(name), schemes.get(name)
    assert isinstance(scheme.every_h, ByConditions)
    assert proof.verdict is Verdict.PROVED
    assert (proof.convergence_order, proof.area_preserving) == (scheme.order, True)
    count = {"gauss4": 8 + 3, "gauss6": 37 + 6}[name]
    assert len(proof.conditions) == count
    assert all(c.holds and c.residue == "0" for c in proof.conditions)


@pytest.mark.left_to_ci
@pytest.mark.sample(17)
@pytest.mark.parametrize("text", [*NONLINEAR.values(), "p**2*q**3", "cos(p + q)", "exp(p*q)"])
@pytest.mark.parametrize("name", ["euler", "rk4", "radau IIA", "lobatto IIIA", "gauss4", "gauss6"])
def test_the_order_at_a_point_is_the_one_of_the_series(name: str, text: str) -> None:
    tableau, order = KNOWN[name]
    hamiltonian = Hamiltonian.parse(text)
    known = order_of(tableau, canonical_field(hamiltonian)[0])
    by_series = replace(implicit_map(hamiltonian, tableau), known_order=lambda: None)
    found = convergence_of(by_series).order
    if known is None:  # of this H more is right than of every H, or it is undefined at the points
        assert found is None or found > order
    else:
        assert known == found == order


def test_an_involved_h_takes_no_time() -> None:
    text = "p**2/2 - cos(q) + exp(sin(q)*p)/10 + log(1 + q**2) + sqrt(1 + p**2)"
    field, _ = canonical_field(Hamiltonian.parse(text))
    begun = time.perf_counter()
    assert order_of(TABLEAUS["gauss6"], field) == 6
    assert time.perf_counter() - begun < 10


# -- planted errors -------------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    "error", [R(1, 10**6), R(1, 10**11), -R(1, 10**40), sympy.sqrt(2) / 10**11]
)
@pytest.mark.parametrize(
    ("name", "order"), [("implicit-midpoint", 2), ("gauss4", 4), ("gauss6", 6)]
)
def test_an_error_in_any_coefficient_is_refuted_with_its_residue(
    name: str, order: int, error: sympy.Expr, monkeypatch: pytest.MonkeyPatch
) -> None:
    size = abs(float(error))
    for place in places(TABLEAUS[name]):
        wrong = planted(TABLEAUS[name], *place, error)
        proof = proof_of(monkeypatch, wrong, order)
        assert proof.verdict is Verdict.REFUTED, place
        assert "residue" in proof.reason
        assert proof.area_preserving is None
        failing = [c for c in proof.conditions if c.holds is False]
        residues = [abs(float(c.residue)) for c in failing]
        assert failing
        assert all(size / 10**6 < x < 10 * size for x in residues), (place, residues)
        assert any(c.order == 0 for c in failing), "area is lost, too"


@pytest.mark.parametrize(("name", "order"), [("gauss4", 4), ("gauss6", 6)])
def test_swapped_stages_and_signs_are_refuted(
    name: str, order: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = TABLEAUS[name]
    swapped = replace(right, rows=right.rows[::-1])
    flipped = replace(right, rows=tuple(tuple(row[::-1]) for row in right.rows))
    for wrong in (swapped, flipped):
        assert proof_of(monkeypatch, wrong, order).verdict is Verdict.REFUTED
    both = replace(right, rows=tuple(tuple(row[::-1]) for row in right.rows[::-1]))
    renamed = replace(both, weights=right.weights[::-1])  # the same stages in another order
    assert proof_of(monkeypatch, renamed, order).verdict is Verdict.PROVED


@pytest.mark.parametrize(("name", "order"), [("gauss4", 4), ("gauss6", 6)])
def test_for_every_separable_h_an_error_is_refuted_as_well(
    name: str, order: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = proof_of(monkeypatch, TABLEAUS[name], order, separable=True)
    assert (right.verdict, right.separable) == (Verdict.PROVED, True)
    assert right.convergence_order == order
    for place in places(TABLEAUS[name]):
        wrong = planted(TABLEAUS[name], *place, R(1, 10**11))
        proof = proof_of(monkeypatch, wrong, order, separable=True)
        assert (proof.verdict, proof.separable) == (Verdict.REFUTED, True)


def test_a_claim_of_more_than_there_is_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    assert proof_of(monkeypatch, TABLEAUS["gauss4"], 5).verdict is Verdict.REFUTED
    assert proof_of(monkeypatch, TABLEAUS["gauss4"], 3).verdict is Verdict.PROVED


@pytest.mark.parametrize("separable", [False, True])
@pytest.mark.parametrize("name", ["heun", "rk4", "radau IIA", "lobatto IIIA"])
def test_a_method_that_loses_area_is_refuted_by_an_h(
    name: str, separable: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    tableau, order = KNOWN[name]
    proof = proof_of(monkeypatch, tableau, order, separable)
    assert proof.verdict is Verdict.REFUTED
    assert "ΔJ has order" in proof.reason
    assert (proof.convergence_order, proof.area_preserving) == (order, False)


@pytest.mark.parametrize("name", sorted(PRESERVING))
def test_no_h_stands_against_a_method_that_preserves_area(name: str) -> None:
    tableau, order = KNOWN[name]
    assert counterexample(made(tableau, order), separable=False) is None


# -- the plane ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("separable", "known"), [(False, [1, 1, 2, 4, 8, 15, 30]), (True, [1, 1, 2, 4, 8, 15, 28])]
)
def test_in_the_plane_some_trees_depend_on_each_other_from_five_vertices_on(
    separable: bool, known: list[int]
) -> None:
    ranks = []
    for order in range(1, 8):
        differentials = Differentials(Jets(order, separable=separable))
        rows = []
        for tree in trees(order):
            parts = [x.to_dict() for x in differentials.differential(tree)]
            rows.append({(k, m): c for k, part in enumerate(parts) for m, c in part.items()})
        keys = sorted({key for row in rows for key in row})
        ranks.append(flint.fmpq_mat([[row.get(k, 0) for k in keys] for row in rows]).rank())
    assert ranks == known


def test_only_what_cancels_for_every_h_is_taken_for_nothing() -> None:
    """f''(f, f'f'f) = f'f'f''(f, f) in the plane, and nothing else of five vertices is alike."""
    one, other = (next(t for t in trees(5) if condition_text(t) == text)
                  for text in ("b·(c A(A(c)))", "b·A(A(c^2))"))  # fmt: skip
    ring = TABLEAUS["gauss4"].numbers.ring
    gap = TABLEAUS["gauss4"].numbers.a[0][1]
    shares = {tree: gap * symmetry(tree) for tree in trees(5)}
    for own in (Differentials(Jets(5)), Differentials(Jets(5, separable=True))):
        assert cancels(ring, {one: shares[one], other: -shares[other]}, own) is True
        assert cancels(ring, {one: shares[one], other: shares[other]}, own) is False
        assert cancels(ring, {one: shares[one]}, own) is False
        for tree in set(trees(5)) - {one, other}:
            assert cancels(ring, {one: shares[one], tree: -shares[tree]}, own) is False


# -- input ----------------------------------------------------------------------------------------


def test_a_tableau_that_does_not_fit_is_refused() -> None:
    for rows, weights in (([], []), ([[1]], [1, 1]), ([[1, 1], [1]], [1, 1])):
        with pytest.raises(ValueError, match="as many rows"):
            ImplicitTableau.from_numbers(rows, weights)
    with pytest.raises(ValueError, match="numbers"):
        ImplicitTableau.from_numbers([[sympy.Symbol("x")]], [1])


def test_orders_beyond_10_are_refused() -> None:
    with pytest.raises(InputError, match="up to 10"):
        TreeConditions(RADAU).order_conditions(11)


def test_a_condition_of_order_1_is_that_of_consistency() -> None:
    tableau = ImplicitTableau.from_numbers([[R(1, 2)]], [R(9, 10)])
    assert TreeConditions(tableau).order_conditions(1) == (
        Condition("b·1 = 1", 1, "-1.0000e-01", False),
    )
