"""A splitting of a field: the exact flows of its parts, composed."""

import pytest

from verify.errors import InputError
from verify.hamiltonians.equations import Equations, read_system
from verify.proof.structures.structures_proof import prove_structures
from verify.schemes import get
from verify.schemes.field_splitting import add_parts, has_steps, separate_parts
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
    scheme = add_parts(PALINDROME, PARTS)
    assert orders(scheme, "volume", "symmetric", "x**2 + y**2 + z**2") == [None, None, 3]


def test_parts_in_one_order_are_not_symmetric() -> None:
    scheme = add_parts("A 1; B 1; C 1", PARTS)
    assert orders(scheme, "volume", "symmetric") == [None, 2]


def test_flows_of_one_part_add_their_times() -> None:
    def ends(scheme: str) -> list[object]:
        step_map = get(add_parts(scheme, PARTS)).step_map(rigid_body())
        return [x.expand() for x in step_map.composed]

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
        ({"A": "x_dot"}, "A 1", "has other equations than the field's x_dot, y_dot, z_dot"),
        ({"A": ""}, "A 1", "has other equations"),
        ({"A": "x_dot = y*("}, "A 1", "split=A: x_dot = y*(: "),
        ({"A": "x_dot = y*z/6: B: y_dot = 1"}, "A 1", "has a colon"),
        ({"A b": "x_dot = 1"}, "A 1", "is no name of a part"),
        ({**PARTS, "A": "x_dot = t*y*z/6"}, "A 1", "depends on t"),
        ({**PARTS, "A": "x_dot = y*z/5"}, "A 1", "split=x_dot: the parts do not add up to the fie"),
        (PARTS, "A 1; D 1", "unknown"),
        (PARTS, "", "is no part with its size"),
        (PARTS, "A", "is no part with its size"),
        (PARTS, "A one", "the size of A"),
        (PARTS, "A 1;" * 201, "more than 200"),
    ],
)
def test_bad_parts_are_named_in_one_line(parts: dict[str, str], scheme: str, says: str) -> None:
    with pytest.raises(InputError) as error:
        get(add_parts(scheme, parts)).step_map(rigid_body())
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_splitting_is_named_by_its_steps_and_parts_and_read_back() -> None:
    scheme = get(add_parts("A 1/2;B 1; A 1/2;", {"A": " x_dot = y ", "B": "y_dot = -x; x_dot = 0"}))
    assert scheme.name == "A 1/2; B 1; A 1/2 with A: x_dot = y; B: y_dot = -x; x_dot = 0"
    parts = {"A": "x_dot = y", "B": "y_dot = -x; x_dot = 0"}
    assert separate_parts(scheme.name) == ("A 1/2; B 1; A 1/2", parts)
    assert (has_steps("kick 1/2; drift 1"), has_steps(scheme.name)) == (True, False)
    assert separate_parts("u_next = u; v_next = v")[1] == {}
    assert has_steps("mine: A 1; B 1")
    titled = add_parts("mine: A 1", {"A": "x_dot = 1"})
    assert get(titled).name == titled == "mine: A 1 with A: x_dot = 1"
    with pytest.raises(InputError, match="split=A: stands twice"):
        get("A 1 with A: x_dot = y; A: y_dot = -x")


def test_parts_may_be_named_as_those_of_an_h_and_have_its_parameters() -> None:
    system = read_system("v_dot = -k*sin(x); x_dot = v", {"k": 2})
    parts = {"kick": "v_dot = -k*sin(x)", "drift": "x_dot = v"}
    scheme = get(add_parts("kick 1/2; drift 1; kick 1/2", parts))
    kicked = "v - h*sin(x)"
    by_hand = f"x_next = x + h*({kicked}); v_next = {kicked} - h*sin(x_next)"
    pairs = zip(*(x.step_map(system).composed for x in (scheme, get(by_hand))), strict=True)
    assert [(a - b).expand() for a, b in pairs] == [0, 0]


def test_steps_without_their_parts_are_told_what_is_missing() -> None:
    with pytest.raises(InputError, match=r"has no parts: write --split, in a scene"):
        get("A 1/2; B 1; A 1/2")


def test_an_h_has_no_parts_of_a_field() -> None:
    with pytest.raises(InputError, match="split=A: are parts of equations without an H"):
        get("A 1 with A: q_dot = p").step_map(read_system("p**2/2"))
