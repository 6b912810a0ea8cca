"""`verify.prove` of what a step keeps, of an H and of equations without one."""

from collections.abc import Callable

import pytest

import verify
from verify import InputError, StructuresProof, Verdict

PREY = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
EULER = "u_next = u*exp(h*(v - 2)); v_next = v*exp(h*(1 - u*exp(h*(v - 2))))"


def test_only_what_is_named_is_judged() -> None:
    proof = verify.prove("pendulum", "lie2", keeps=["energy: 3"])
    assert isinstance(proof, StructuresProof)
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, 2)
    (energy,) = proof.keeps
    assert (energy.order, energy.leading, energy.telescopes) == (3, "-p**3*sin(q)/6", True)
    wrong = verify.prove("pendulum", "lie2", keeps=["energy: 4", "symmetric"])
    assert [x.verdict for x in wrong.keeps] == [Verdict.REFUTED] * 2


def test_of_equations_a_form_and_a_density_are_kept() -> None:
    proof = verify.prove(PREY, EULER, keeps="symplectic", form="du^dv/(u*v)", density="1/(u*v)")
    assert [(x.structure.name, x.is_kept) for x in proof.keeps] == [
        ("symplectic", True), ("volume", True),
    ]  # fmt: skip
    other = verify.prove(PREY, "rk4", keeps="symplectic: 5", form="du^dv/(u*v)")
    assert (other.verdict, other.keeps[0].order) == (Verdict.PROVED, 5)
    assert other.keeps[0].is_kept is False


def test_a_parameter_of_equations_has_a_value_or_stays_a_symbol() -> None:
    field = "u_dot = u*(v - a); v_dot = v*(1 - u)"
    density, values = "1/(u*v)", {"a": 2}
    symbolic = verify.prove(field, "rk4", keeps="volume: 5", density=density)
    valued = verify.prove(field, "rk4", parameters=values, keeps="volume: 5", density=density)
    assert "a" in symbolic.keeps[0].leading
    assert "a" not in valued.keeps[0].leading
    assert symbolic.verdict is valued.verdict is Verdict.PROVED


def test_a_map_of_ones_own_is_proved_to_keep_area() -> None:
    hamiltonian = verify.Hamiltonian.parse("p**2/2 - cos(q)")
    step_map = verify.schemes.get("stormer-verlet").step_map(hamiltonian)
    assert verify.prove(step_map, keeps="area").verdict is Verdict.PROVED
    plain = verify.prove(step_map)
    assert not isinstance(plain, StructuresProof)


def test_every_hamiltonian_is_proved_without_a_system() -> None:
    proof = verify.prove(
        scheme="gauss4", every_hamiltonian=True, degrees=2, keeps="angular-momentum"
    )
    assert isinstance(proof, StructuresProof)
    assert proof.verdict is Verdict.PROVED
    wrong = verify.prove(scheme="rk4", every_hamiltonian=True, keeps="energy")
    assert (wrong.verdict, wrong.keeps[0].order) == (Verdict.REFUTED, 5)
    assert wrong.keeps[0].example in str(wrong.reason)
    plain = verify.prove(scheme="lie2", every_hamiltonian=True)
    assert (plain.order, plain.quantifier) == (3, "every smooth H")


BAD: dict[str, tuple[Callable[[], object], str]] = {
    "name": (lambda: verify.prove(PREY, "rk4", keeps="volum"), "keeps=volum: unknown; is volume"),
    "form": (lambda: verify.prove(PREY, "rk4", keeps="symplectic", form="du^dw"), "form=w: unk"),
    "type": (lambda: verify.prove(PREY, "rk4", keeps=[3]), "keeps=[3]: is no text"),  # type: ignore[list-item]
    "nothing-asked": (lambda: verify.prove(PREY, "rk4"), "has no H, which is needed here"),
    "sweep": (lambda: verify.sweep(PREY, "rk4", q=1, p=0, step_size=0.1, steps=1), "has no H"),
    "scheme": (lambda: verify.prove(PREY, "stormer-verlet", keeps="volume"), "takes an H"),
    "every-system": (
        lambda: verify.prove("pendulum", "lie2", every_hamiltonian=True),  # type: ignore[call-overload]
        "system=pendulum: goes without every_hamiltonian",
    ),
    "every-scheme": (
        lambda: verify.prove(every_hamiltonian=True, keeps="energy"),
        "scheme: is of one H; every_hamiltonian=True goes with",
    ),
    "every-keeps": (
        lambda: verify.prove(scheme="rk4", every_hamiltonian=True, keeps="q**3"),
        "keeps=q**3: is no integral that theorems on every H know",
    ),
    "family": (
        lambda: verify.prove("pendulum", "lie2", degrees=2),  # type: ignore[call-overload]
        "degrees=2: goes with every_hamiltonian=True",
    ),
    "no-system": (lambda: verify.prove(scheme="lie2"), "system: is missing"),  # type: ignore[call-overload]
    "parameter": (
        lambda: verify.prove(PREY, "rk4", parameters={"b": 1}, keeps="volume"),
        "parameter=b: H has no such parameter",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_argument_is_refused_in_one_line(name: str) -> None:
    call, message = BAD[name]
    with pytest.raises(InputError) as refused:
        call()
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
    assert "--" not in str(refused.value)
