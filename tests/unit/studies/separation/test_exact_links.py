"""Parts of a separation that are exactly zero, or in closed form, and known so."""

import math
from fractions import Fraction

import pytest

from tests.helpers.sampled.separations import chain_of
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lockstep import run_alone
from verify.studies.separation.links import separate_chains

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
HARMONIC = Hamiltonian.parse("p**2/2 + omega**2*q**2/2", {"omega": "7/3"})
HENON = systems.get("henon-heiles").hamiltonian({})


@pytest.mark.parametrize("name", ["plain", "closed_form"])
@pytest.mark.parametrize(
    ("hamiltonian", "scheme", "start", "steps"),
    [
        (PENDULUM, "symplectic-euler", {"p": "1/3", "q": "3/2", "h": "5/2"}, 300),
        (HENON, "stormer-verlet", {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1", "h": "0.1"},
         60),
    ],
    ids=["plane", "degrees"],
)  # fmt: skip
def test_a_map_that_is_symplectic_by_proof_has_no_truncation_nor_what_follows_from_it(
    hamiltonian: Hamiltonian, scheme: str, start: dict[str, str], steps: int, name: str
) -> None:
    at = {coordinate: Fraction(x) for coordinate, x in start.items()}
    chains = run_alone(separate_chains(hamiltonian, scheme, at, steps, 17, "mpfr"))
    for chain in getattr(chains, name):
        for part in ("truncation", "input", "trajectory"):
            assert chain.final(part) == (0, 0)
        assert chain.kind == "enclosed"
        value, bound = chain.final("determinant" if hamiltonian.planar else "derivatives")
        assert (value == 0) == (name == "closed_form"), "det − 1 is rounded, a ΔJ of 0 is not"
        assert bound <= abs(value) / 10**15


def test_a_constant_delta_j_has_no_trajectory_part_and_a_closed_truncation() -> None:
    chain = chain_of(HARMONIC, "lie2", steps=1000)
    x = Fraction(7, 3) / 1000
    exact = (1 + x**4 / 4) ** 1000 - 1
    value, bound = chain.final("truncation")
    assert abs(value - exact) <= bound < exact / 10**30
    assert chain.final("trajectory") == (0, 0)
    assert chain.final("input")[0] != 0, "7/3 and 1/1000 are rounded"
    assert chain.kind == "enclosed"


@pytest.mark.parametrize("q", [Fraction(3, 2), Fraction(1, 10)])
def test_inputs_that_float64_has_exactly_have_no_input_part(q: Fraction) -> None:
    chain = chain_of(DUFFING, "lie2", h=Fraction(1, 1024), p=Fraction(-1, 4), q=q)
    assert (chain.final("input") == (0, 0)) == (q == Fraction(3, 2))
    assert chain.final("input")[0] != 0 or q == Fraction(3, 2)


def test_after_one_step_the_trajectory_has_no_part_yet() -> None:
    assert chain_of(DUFFING, "lie2", steps=1).final("trajectory") == (0, 0)
    assert chain_of(DUFFING, "lie2", steps=2).final("trajectory")[0] != 0


def test_a_determinant_of_1_for_the_exact_parameter_alone_is_not_carried_over() -> None:
    """3a − 1 vanishes at a = 1/3, and not at the float64 next to it."""
    hamiltonian = Hamiltonian.parse("p**2/2 + (3*a - 1)*p*q**2", {"a": "1/3"})
    chain = chain_of(hamiltonian, "lie2", steps=50)
    assert chain.final("truncation") == (0, 0)
    assert chain.final("input")[0] != 0


def test_the_closed_forms_sum_loses_nothing_to_the_number_of_steps() -> None:
    """Without what the two-sum keeps, 5000 additions lose some 30 times as much."""
    chain = chain_of(DUFFING, "lie2", steps=5000, name="closed_form")
    largest = max(abs(x) for x in chain.trail("lambda_working")[0])
    assert max(abs(x) for x in chain.trail("product")[0]) <= 2 * math.ulp(float(largest))
