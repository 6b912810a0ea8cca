"""What a scheme keeps for every H: each theorem where it holds, and where a condition of it fails.

A planted error is refuted by an H, for which the proof for that H alone says the same.
"""

from dataclasses import replace
from typing import Any

import pytest
import sympy

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.structures.structure_theorems import Products, keeps_products
from verify.proof.structures.structures_for_every_h import prove_structures_for_every_h
from verify.proof.structures.structures_proof import StructuresProof, prove_structures
from verify.schemes import get
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.structures.reading import KeepsRequest, read_structures
from verify.verdict import Verdict

PROVED, REFUTED, UNDECIDED, ENCLOSED = (
    Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED, Verdict.ENCLOSED)  # fmt: skip
TWO, THREE = {"degrees": 2}, {"degrees": 3}
TIMED, SEPARABLE = {"timed": True}, {"separable": True}
LAME, OFF = "kick 1/2; drift 1; kick 1/3", "kick 1/2; drift 1 at 1/3; kick 1/2 at 1"


def every(scheme: str, *keeps: str, reverses: str = "", **family: Any) -> StructuresProof:
    return prove_structures_for_every_h(scheme, KeepsRequest(keeps, reverses=reverses), **family)


CASES: list[tuple[str, str, dict[str, Any], Verdict]] = [
    # linear integrals: by all that treats coordinates alike; by splittings if sizes add up alike
    ("rk4", "p + q", {}, PROVED), ("lie3", "p1 + 2*q2", TWO, PROVED),
    ("gauss4", "p1 - p2", TWO, PROVED), ("implicit-symplectic-euler", "p + q", {}, PROVED),
    ("ruth3", "p + q", {}, PROVED), (LAME, "p + q", {}, REFUTED), (LAME, "p", {}, PROVED),
    ("rk4", "p + q", TIMED, PROVED), ("ruth3", "p + q", TIMED, REFUTED),
    ("ruth3", "q", TIMED, PROVED), ("stormer-verlet", "momentum", TWO, PROVED),
    # quadratic ones: where M = 0, or of products of a p and a q
    ("gauss4", "p**2 + q**2", {}, PROVED), ("gauss6", "angular-momentum", THREE, PROVED),
    ("rk4", "p**2 + q**2", {}, REFUTED), ("lie2", "angular-momentum", TWO, REFUTED),
    ("rk4", "angular-momentum", TWO, REFUTED), ("rk4", "p**2 + q**2", SEPARABLE, REFUTED),
    ("rk4", "p*q", SEPARABLE, REFUTED),
    ("implicit-symplectic-euler", "p*q", {}, PROVED),
    ("implicit-symplectic-euler", "p**2 + q**2", {}, REFUTED),
    ("yoshida4", "angular-momentum", TWO, PROVED), ("yoshida4", "q1*p2 - q2*p1 + p1", TWO, PROVED),
    ("stormer-verlet", "p1**2 + p1*p2", TWO, PROVED),
    ("stormer-verlet", "p**2 + q**2", {}, REFUTED), (LAME, "p*q", {}, REFUTED),
    ("stormer-verlet", "p**2 + p*q", {}, UNDECIDED), ("stormer-verlet", "p*q", TIMED, PROVED),
    # symmetry and reversibility by the coefficients
    ("gauss6", "symmetric", TWO, PROVED), ("yoshida4", "reversible", {}, PROVED),
    ("rk4", "symmetric", {}, REFUTED), ("ruth3", "reversible", {}, REFUTED),
    ("stormer-verlet", "symmetric", TIMED, PROVED), (OFF, "symmetric", TIMED, REFUTED),
    ("implicit-symplectic-euler", "reversible", TWO, REFUTED),
    # volume and the form
    ("ruth3", "volume", THREE, PROVED), ("gauss4", "symplectic", TWO, PROVED),
    ("lie4", "volume", TWO, REFUTED), ("rk4", "area", SEPARABLE, REFUTED),
    # the energy of every H is kept by none of them
    ("gauss4", "energy", {}, REFUTED), ("stormer-verlet", "energy", TWO, REFUTED),
    # a map of order r keeps all up to h^r, and symmetry up to h^(r+1) if r is even
    ("stormer-verlet", "energy: 3", {}, PROVED), ("stormer-verlet", "energy: 4", {}, REFUTED),
    ("gauss4", "energy: 5", THREE, PROVED), ("gauss4", "energy: 6", TWO, REFUTED),
    ("lie2", "symmetric: 4", {}, PROVED), ("lie2", "reversible: 5", {}, REFUTED),
    ("lie3", "reversible: 4", TWO, PROVED), ("lie3", "symmetric: 5", {}, REFUTED),
    ("rk4", "reversible: 6", {}, PROVED), ("rk4", "angular-momentum: 5", TWO, PROVED),
    ("symplectic-euler", "symmetric: 2", {}, PROVED), (LAME, "energy: 2", {}, REFUTED),
    ("stormer-verlet, clock frozen", "symmetric: 3", TIMED, REFUTED),
]  # fmt: skip


@pytest.mark.parametrize(("scheme", "keeps", "family", "verdict"), CASES)
def test_each_theorem_holds_with_its_conditions_alone(
    scheme: str, keeps: str, family: dict[str, Any], verdict: Verdict
) -> None:
    proof = every(scheme, keeps, **family)
    assert {x.verdict for x in proof.keeps} == {verdict}, proof.reason
    for kept in proof.keeps if verdict is REFUTED else ():
        # The proof for the example alone refutes it with the same power of h.
        example = Hamiltonian.parse(kept.example)
        claims = read_structures(KeepsRequest((keeps,)), example)
        alone = prove_structures(get(scheme).step_map(example), claims, get(scheme))
        assert (alone.verdict, kept.order) == (REFUTED, alone.keeps[0].order)


@pytest.mark.parametrize(
    "system",
    [
        "p**2/2 + q**2/2 + q**4/4", "p**2/2 - cos(q)", "p**4/4 + q**4/4 - q**2",
        pytest.param("p1**2/2 + p2**2/2 + (q1**2 + q2**2)**2/4", marks=pytest.mark.left_to_ci),
        pytest.param("p1**2/2 + p2**2 + p1*p2 + exp(q1 + q2**2)", marks=pytest.mark.left_to_ci),
    ],
)  # fmt: skip
def test_what_is_proved_for_every_h_is_refuted_for_none(system: str) -> None:
    hamiltonian = Hamiltonian.parse(system)
    keeps = ("symmetric", "reversible", "volume", "energy: 3", "symmetric: 3")
    for name in ("lie2", "rk4", "gauss4", "stormer-verlet", "implicit-symplectic-euler"):
        scheme = get(name)
        claims = read_structures(KeepsRequest(keeps), hamiltonian)
        alone = prove_structures(scheme.step_map(hamiltonian), claims, scheme).keeps
        for one, all_h in zip(
            alone, every(name, *keeps, degrees=hamiltonian.degrees).keeps, strict=True
        ):
            assert all_h.verdict is not PROVED or one.verdict is PROVED
            assert one.verdict is not REFUTED or all_h.verdict is REFUTED


def test_a_splitting_in_time_says_where_its_theorem_holds() -> None:
    (kept,) = every("stormer-verlet", "p*q", timed=True).keeps
    assert "T is smooth at p = 0, or V at q = 0" in kept.domain.texts
    # H = (log p + log q)(1 + t) is smooth at neither, and its flow keeps p q; the step does not.
    system = Hamiltonian.parse("(1 + t)**3*(log(p) + log(q))")
    claims = read_structures(KeepsRequest(("p*q",)), system)
    scheme = get("stormer-verlet")
    proof = prove_structures(scheme.step_map(system), claims, scheme)
    assert proof.verdict is REFUTED


def test_other_reflections_are_those_of_schemes_that_commute_with_them() -> None:
    assert every("gauss4", "reversible", reverses="q, p").verdict is PROVED
    assert every("stormer-verlet", "reversible", reverses="q, p").verdict is REFUTED
    assert every("stormer-verlet", "reversible", reverses="p, -q").verdict is PROVED


def tableau(*rows: str) -> ImplicitTableau:
    """A tableau by its rows, the weights last."""
    numbers = [[sympy.Rational(x) for x in row.split()] for row in rows]
    return ImplicitTableau.from_numbers(numbers[:-1], numbers[-1])


LOBATTO_A, LOBATTO_B = tableau("0 0", "1/2 1/2", "1/2 1/2"), tableau("1/2 0", "1/2 0", "1/2 1/2")
PQ: Products = {(0, 1)}


@pytest.mark.parametrize(
    ("first", "second", "products", "kept"),
    [
        (LOBATTO_B, LOBATTO_A, PQ, True), (LOBATTO_A, LOBATTO_A, PQ, False),
        (LOBATTO_B, LOBATTO_A, {(0, 0)}, False), (LOBATTO_B, LOBATTO_A, {(0,), (1,)}, True),
        (LOBATTO_A, LOBATTO_B, PQ | {(0,)}, True),
        (LOBATTO_A, tableau("1/2 0", "1/2 0", "1/3 2/3"), {(0,), (1,)}, False),
        (LOBATTO_A, None, PQ, False), (LOBATTO_A, None, {(0,), (1,)}, True),
        (tableau("1/2", "1"), None, {(0, 0), (1, 1)}, True),
    ],
)  # fmt: skip
def test_a_partitioned_method_keeps_products_of_p_and_q(
    first: ImplicitTableau, second: ImplicitTableau | None, products: Products, kept: bool
) -> None:
    assert keeps_products(TreeConditions(replace(first, of_q=second)), products, 1) is kept


PARTS = "kick {a}; drift {b}; kick {c}; drift {d}; kick {c}; drift {b}; kick {a}; order 4"
YOSHIDA = PARTS.format(a="0.67560359598", b="1.3512071919", c="-0.1756035960", d="-1.7024143839")


@pytest.mark.parametrize(
    ("keeps", "verdict", "order"),
    [("energy: 5", ENCLOSED, None), ("energy: 6", REFUTED, 5), ("energy", REFUTED, 5),
     ("p + q", UNDECIDED, None), ("symmetric", PROVED, None), ("p**2 + q**2", REFUTED, 5)],
)  # fmt: skip
def test_printed_decimals_stand_for_the_numbers_near_them(
    keeps: str, verdict: Verdict, order: int | None
) -> None:
    (kept,) = every(YOSHIDA, keeps).keeps
    assert (kept.verdict, kept.order) == (verdict, order)


def test_what_the_rounding_of_decimals_explains_is_left_undecided() -> None:
    rounded = "kick 0.50000000001; drift 1; kick 0.49999999999"
    assert every(rounded, "symmetric").verdict is UNDECIDED
    assert every(rounded.replace("0000001", "0100001"), "symmetric").verdict is REFUTED


@pytest.mark.parametrize(
    ("scheme", "keeps", "refined", "family", "message"),
    [
        ("gauss4", "q**3", {}, {}, "--keeps=q**3: is no integral"),
        ("gauss4", "conformal", {}, {}, "--keeps=conformal: is of one system"),
        ("gauss4", "symplectic", {"form": "dp^dq"}, {}, "--form=dp^dq: is of one system"),
        ("gauss4", "volume", {"density": "1/p"}, {}, "--density=1/p: is of one system"),
        ("gauss4", "p", {"casimirs": ("q",)}, {}, "--casimir=q: is of one system"),
        ("gauss4", "energy", {}, TIMED, "--keeps=energy: H depends on t"),
        ("gauss4", "7", {}, {}, "--keeps=7: is a constant"),
        ("gauss4", "a*p", {}, {}, "unknown name 'a'; allowed: p, q"),
        ("gauss4", "angular-momentum", {}, {}, "is of two or three degrees of freedom"),
        ("gauss4", "reversible", {"reverses": "1/p, q"}, {}, "is not affine"),
        ("gauss4", "p1", {}, {"degrees": 0}, "degrees=0: must be"),
        ("rk4, clock frozen", "area", {}, {}, "is given for one H"),
    ],
)
def test_what_has_no_meaning_for_every_h_is_refused_in_one_line(
    scheme: str, keeps: str, refined: dict[str, Any], family: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError) as refused:
        prove_structures_for_every_h(scheme, KeepsRequest((keeps,), **refined), **family)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
