"""A splitting that a user writes down: proved or refuted from its coefficients."""

import pytest

from verify import schemes
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.verdict import Verdict

VERLET = "kick 1/2; drift 1; kick 1/2; order 2"
G = "1/(2-2**(1/3))"
FOREST_RUTH = (
    f"drift {G}/2; kick {G}; drift (1-{G})/2; kick 1-2*{G}; drift (1-{G})/2; kick {G}; "
    f"drift {G}/2; order 4"
)


@pytest.mark.parametrize(
    ("name", "twin"), [(VERLET, "stormer-verlet"), (FOREST_RUTH, "forest-ruth")]
)
def test_one_that_is_named_too_is_that_scheme(name: str, twin: str) -> None:
    own, other = schemes.get(name).every_h, schemes.get(twin).every_h
    for (kind, size), (second, length) in zip(own.parts, other.parts, strict=True):
        assert kind == second
        assert abs((size - length).evalf(60)) < 1e-50
    proof = prove_for_every_h(name)
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.convergence_order == schemes.get(twin).order


@pytest.mark.parametrize(
    ("old", "new"),
    [("drift 1;", "drift 1.000000000500;"), ("kick 1/2; order", "kick 0.500001; order")],
)
def test_an_error_in_a_coefficient_is_refuted_with_its_residue(old: str, new: str) -> None:
    proof = prove_for_every_h(VERLET.replace(old, new))
    assert proof.verdict is Verdict.REFUTED
    wrong = next(c for c in proof.conditions if not c.holds)
    assert wrong.residue in ("5.00000000000e-10", "1.00000000000e-06")


def test_an_order_that_is_one_too_high_is_refuted() -> None:
    assert prove_for_every_h(VERLET.replace("order 2", "order 3")).verdict is Verdict.REFUTED
    assert prove_for_every_h(VERLET).verdict is Verdict.PROVED


def triple(root: int, steps: list[str]) -> list[str]:
    """The triple jump of these steps of order root − 1."""
    outer, inner = f"1/(2 - 2**(1/{root}))", f"(1 - 2/(2 - 2**(1/{root})))"
    return [f"{size}*{step}" for size in (outer, inner, outer) for step in steps]


@pytest.mark.left_to_ci
def test_order_8_is_proved_though_no_condition_beyond_it_is_known() -> None:
    steps = triple(7, triple(5, triple(3, ["1"])))
    parts = "; ".join(f"kick {x}/2; drift {x}; kick {x}/2" for x in steps)
    proof = prove_for_every_h(f"{parts}; order 8")
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, 8)


def test_without_an_order_it_claims_consistency() -> None:
    scheme = schemes.get("kick 1; drift 1")
    assert (scheme.order, scheme.symmetric) == (1, False)
    assert prove(scheme.step_map(Hamiltonian.parse("p**2/2 + q**4")), scheme).verdict == "PROVED"


def test_a_palindrome_claims_symmetry_and_spaces_do_not_count() -> None:
    assert schemes.get(VERLET).symmetric
    assert schemes.get("  kick   1/2 ;drift 1;kick 1/2;order  2 ").name == VERLET


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("kick", "write it as"),
        ("kick 1; drift", "write it as"),
        ("kick 1; jump 1", "jump: unknown"),
        ("kick 1; drift x", "unknown name 'x'; allowed: numbers alone"),
        ("kick 1; drift sqrt", r"write sqrt\(2\); allowed: numbers alone"),
        ("kick 1/0", "division by zero"),
        ("kick 1; drift 1; order two", "is not a whole number"),
        ("kick 1; drift 1; order 9", "must be 1 … 8"),
        ("kick 1; drift 1; order 0", "must be 1 … 8"),
        ("kick 1; order 2; drift 1", "order: unknown"),
        ("; ".join(["kick 1"] * 201), "write it as"),
        ("kick 1; drift 1 = 2", "write it as"),
    ],
)
def test_a_bad_one_is_refused_in_one_line(name: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem) as info:
        schemes.get(name)
    assert "\n" not in str(info.value)
