"""A splitting of a field: the exact flows of its parts, composed."""

import pytest

from verify.errors import InputError
from verify.hamiltonians.equations import Equations, read_system
from verify.proof.structures.structures_proof import prove_structures
from verify.schemes import get
from verify.schemes.field_splitting import formulas_of_splitting
from verify.structures.reading import KeepsRequest, read_structures

PARTS = {"A": "x_dot = y*z/6", "B": "y_dot = z*x/3", "C": "z_dot = -x*y/2"}
PALINDROME = "A 1/2; B 1/2; C 1; B 1/2; A 1/2"


def rigid_body() -> Equations:
    system = read_system("x_dot = y*z/6; y_dot = z*x/3; z_dot = -x*y/2")
    assert isinstance(system, Equations)
    return system


def orders(scheme: str, *keeps: str) -> list[int | None]:
    system, integrator = rigid_body(), get(scheme)
    claims = read_structures(KeepsRequest(keeps=keeps), system)
    proofs = prove_structures(integrator.step_map(system), claims, integrator).keeps
    assert all(proof.is_kept is not None for proof in proofs)
    return [proof.order for proof in proofs]


def test_a_palindrome_of_shears_keeps_volume_and_is_symmetric() -> None:
    scheme = formulas_of_splitting(rigid_body(), PARTS, PALINDROME)
    assert orders(scheme, "volume", "symmetric", "x**2 + y**2 + z**2") == [None, None, 3]


def test_parts_in_one_order_are_not_symmetric() -> None:
    scheme = formulas_of_splitting(rigid_body(), PARTS, "A 1; B 1; C 1")
    assert orders(scheme, "volume", "symmetric") == [None, 2]


def test_flows_of_one_part_add_their_times() -> None:
    def ends(scheme: str) -> list[object]:
        formulas = formulas_of_splitting(rigid_body(), PARTS, scheme)
        return [x.expand() for x in get(formulas).step_map(rigid_body()).composed]

    assert ends("A 1/3; A 2/3; B 1; C 1") == ends("A 1; B 1; C 1")
    assert ends("A 1/3; A 1/2; B 1; C 1") != ends("A 1; B 1; C 1")


@pytest.mark.parametrize(
    ("parts", "scheme", "says"),
    [
        ({"A": "x_dot = y*z/6", "B": "y_dot = z*x/3"}, "A 1; B 1", "do not add up to the field"),
        (
            {"A": "x_dot = y*z/6; y_dot = z*x/3", "C": "z_dot = -x*y/2"},
            "A 1; C 1",
            "no flow that is a polynomial in time",
        ),
        ({"A": "w_dot = 1"}, "A 1", "has other equations"),
        ({**PARTS, "A": "x_dot = t*y*z/6"}, "A 1", "depends on t"),
        (PARTS, "A 1; D 1", "unknown"),
        (PARTS, "A", "is no part with its size"),
        (PARTS, "A one", "the size of A"),
    ],
)
def test_bad_parts_are_named_in_one_line(parts: dict[str, str], scheme: str, says: str) -> None:
    with pytest.raises(InputError) as error:
        formulas_of_splitting(rigid_body(), parts, scheme)
    assert says in str(error.value)
    assert "\n" not in str(error.value)
