"""Sizes with eight digits and more stand for exact ones near them; errors in them are refuted."""

from fractions import Fraction

import pytest

from verify import modified_hamiltonian, schemes
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes.printed.nearby_order import nearby_of
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict

ENCLOSED, MEASURED = Verdict.ENCLOSED, Verdict.MEASURED
PROVED, REFUTED = Verdict.PROVED, Verdict.REFUTED
KINDS = ("kick", "drift") * 3 + ("kick",)
DOUBLE = float(1 / (2 - 2 ** (1 / 3)))
# Half the sizes of Yoshida's scheme: to 8, 12 and 16 digits, and as a program prints its doubles.
HALVES = [
    ("0.67560360", "1.35120719", "-0.17560360", "-1.70241438"),
    ("0.675603595980", "1.351207191960", "-0.175603595980", "-1.702414383919"),
    ("0.6756035959798289", "1.3512071919596578", "-0.1756035959798288", "-1.7024143839193155"),
    tuple(repr(x) for x in (DOUBLE / 2, DOUBLE, (1 - DOUBLE) / 2, 1 - 2 * DOUBLE)),
]
PENDULUM = systems.get("pendulum").hamiltonian()
HENON = systems.get("henon-heiles").hamiltonian()


def scheme_of(half: tuple[str, ...], order: int = 4) -> str:
    sizes = (*half, *half[-2::-1])
    return "; ".join(map(" ".join, zip(KINDS, sizes, strict=True))) + f"; order {order}"


@pytest.mark.parametrize("half", HALVES)
def test_the_order_of_exact_sizes_near_the_printed_ones_is_told_everywhere(
    half: tuple[str, ...],
) -> None:
    name = scheme_of(half)
    scheme = schemes.get(name)
    for proof in (
        prove(scheme.step_map(PENDULUM), scheme),
        prove_for_every_h(name),
        prove_for_every_h(name, timed=True),
        prove(scheme.step_map(HENON), scheme),
        prove_for_every_h(name, degrees=2),
    ):
        assert (proof.verdict, proof.convergence_order) == (ENCLOSED, 4), proof
        assert proof.convergence_decided
        assert "whose residues are up to" in proof.reason
        assert prove_for_every_h(scheme_of(half, 5)).verdict is REFUTED


@pytest.mark.parametrize("half", HALVES[1:])
@pytest.mark.parametrize("place", [0, 1, 2, 3])
@pytest.mark.parametrize("digit", [5, 9])
def test_a_wrong_digit_is_refuted(half: tuple[str, ...], place: int, digit: int) -> None:
    at = half[place].index(".") + digit
    other = str((int(half[place][at]) + 5) % 10)
    wrong = half[place][:at] + other + half[place][at + 1 :]
    name = scheme_of((*half[:place], wrong, *half[place + 1 :]))
    scheme = schemes.get(name)
    assert prove_for_every_h(name).verdict is REFUTED
    assert prove(scheme.step_map(PENDULUM), scheme).verdict is REFUTED
    assert prove(scheme.step_map(HENON), scheme).verdict is REFUTED


def test_short_decimals_and_quotients_are_what_they_are() -> None:
    short = [("kick", "0.5", None), ("drift", "1.000001", None), ("kick", "1/2", None)]
    assert nearby_of(short) is None
    assert prove_for_every_h("kick 0.5; drift 1.000001; kick 1/2; order 2").verdict is REFUTED
    assert prove_for_every_h("kick 0.5; drift 1.00000001; kick 1/2; order 2").verdict is ENCLOSED
    assert prove_for_every_h("kick 0.5; drift 1; kick 1/2; order 2").verdict is PROVED


def test_what_holds_exactly_as_it_is_printed_is_proved() -> None:
    name = "kick 0.123456789; drift 0.5; kick 0.753086422; drift 0.5; kick 0.123456789; order 2"
    assert prove_for_every_h(name).verdict is PROVED


def test_a_size_that_is_no_polynomial_in_its_decimals_is_exact() -> None:
    assert nearby_of([("kick", "1/(2.0000000001)", None), ("drift", "1", None)]) is None
    assert prove_for_every_h("kick 1/(2.0000000001); drift 1; kick 0.5; order 2").verdict is REFUTED


def test_one_h_may_have_a_higher_order_than_every_h() -> None:
    free = Hamiltonian.parse("p**2/2 + q")  # V is linear, so that order 3 needs less
    scheme = schemes.get("kick 0.50000000; drift 1.00000000; kick 0.50000000; order 2")
    proof = prove(scheme.step_map(free), scheme)
    assert (
        proof.convergence_order
        == prove(schemes.get("stormer-verlet").step_map(free)).convergence_order
    )


def test_the_nearest_parts_are_right_to_many_digits() -> None:
    near = schemes.get(scheme_of(HALVES[2])).every_h.nearby(5)
    gamma = near.parts[1][1]
    assert abs((2 - 1 / gamma) ** 3 - 2) < Fraction(1, 10**80)
    assert near.parts[0][0] == "kick"
    assert near.wrong.order == 5


DRIVEN = Hamiltonian.parse("p**2/2 + q**4/4 - q*cos(t)")


def test_times_that_are_given_count_where_h_depends_on_time() -> None:
    """A clock that stands still loses the order there, and changes nothing without time."""
    half, total, times = HALVES[2], Fraction(0), list[str]()
    sizes = (*half, *half[-2::-1])
    for kind, size in zip(KINDS, sizes, strict=True):
        times.append(f" at {total}" if kind == "kick" else "")
        total += Fraction(size) if kind == "drift" else 0
    parts = [f"{kind} {size}" for kind, size in zip(KINDS, sizes, strict=True)]
    right = "; ".join(map("".join, zip(parts, times, strict=True))) + "; order 4"
    frozen = "; ".join(x + " at 0" * x.startswith("kick") for x in parts) + "; order 4"
    for name in (right, frozen):
        scheme = schemes.get(name)
        assert prove(scheme.step_map(PENDULUM), scheme).verdict is ENCLOSED
    found = {name: schemes.get(name) for name in (right, frozen)}
    verdicts = {
        name: {prove(x.step_map(DRIVEN), x).verdict, prove_for_every_h(name, timed=True).verdict}
        for name, x in found.items()
    }
    assert verdicts == {right: {ENCLOSED}, frozen: {REFUTED}}


# Its kicks read the force when the drifts before them have been made, to 16 digits.
GAUSS = "drift 0.2113248654051871; kick 1/2{}; drift 0.5773502691896258; kick 1/2{}; "
GAUSS += "drift 0.2113248654051871; order 2"


@pytest.mark.parametrize(
    ("first", "second", "verdict"),
    [
        ("", "", PROVED),  # their sums hold exactly
        (" at 0.2113248654051871", " at 0.7886751345948129", PROVED),
        (" at 0.21132487", " at 0.78867513", PROVED),
        (" at 0.21132487", " at 0.78867514", ENCLOSED),  # fewer digits than the sizes have
        (" at 0.2113248654051871", " at 0.7886751345948126", ENCLOSED),
        (" at 0.2113248654051871", " at 0.7886761345948129", REFUTED),
        (" at 0.2113248654051871", " at 0.7986751345948129", REFUTED),
        (" at 0", " at 0.7886751345948129", REFUTED),
    ],
)
def test_times_with_many_digits_stand_for_those_near_them(
    first: str, second: str, verdict: Verdict
) -> None:
    name = GAUSS.format(first, second)
    scheme = schemes.get(name)
    proofs = prove(scheme.step_map(DRIVEN), scheme), prove_for_every_h(name, timed=True)
    assert {proof.verdict for proof in proofs} == {verdict}
    orders = {proof.convergence_order for proof in proofs}
    assert orders == ({1} if verdict is REFUTED else {2})


@pytest.mark.parametrize(
    ("time", "verdict"), [("0.50000000", PROVED), ("0.50000001", MEASURED), ("0.50000101", REFUTED)]
)
def test_a_time_alone_may_be_printed_with_many_digits(time: str, verdict: Verdict) -> None:
    name = f"drift 1/2; kick 1 at {time}; drift 1/2; order 2"
    assert prove_for_every_h(name, timed=True).verdict is verdict


@pytest.mark.parametrize("system", ["pendulum", None])
@pytest.mark.parametrize("half", HALVES)
def test_a_modified_hamiltonian_is_that_of_a_scheme_whose_digits_leave_residues(
    system: str | None, half: tuple[str, ...]
) -> None:
    equation = modified_hamiltonian(scheme_of(half), system, 4)
    assert equation.verdict is ENCLOSED
    assert "order 4 of exact coefficients near the printed ones" in equation.reason
    assert equation.reach == 4
    assert modified_hamiltonian(scheme_of(half, 5), system, 4).verdict is REFUTED
    wrong = (half[0], half[1].replace("1.351", "1.361"), *half[2:])
    refuted = modified_hamiltonian(scheme_of(wrong), system, 4)
    assert refuted.verdict is REFUTED
    assert "near" not in refuted.reason


def test_what_has_few_digits_beside_others_is_read_as_exact_first() -> None:
    """Of 0.037109375, which is 19/512; where nothing differs there is one reading."""
    third, others = "0.33333333333333333", {"a": "0.037109375", "c": "0.5", "d": "1/3"}
    several = PrintedNumbers({**others, "b": third}).of_a_method()
    assert [set(numbers.units) for numbers in several] == [{"b"}, {"a", "b"}]
    (alone,) = PrintedNumbers({"c": "0.5", "b": third}).of_a_method()
    assert set(alone.units) == {"b"}
    name = f"kick 0.037109375; drift {third}; kick 0.962890625; drift {third}; drift {third}"
    found = prove_for_every_h(f"{name}; order 1")
    assert found.verdict is ENCLOSED
    assert "of those printed to 17 decimals" in found.reason
