"""Splittings run in every arithmetic, within their bounds; their irrational coefficients too."""

from fractions import Fraction

import flint
import pytest

from tests.helpers.planted.splittings import SPLITTINGS
from tests.helpers.stepping.stepper import Stepper
from verify import arithmetic, schemes
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.rounding import rounding_of
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.operations import StepProgram
from verify.runs.requested_run import run
from verify.schemes.maps.step_map import StepMap

SYSTEMS = ("p**2/2 - cos(q)", "p**2/2 + p**3/9 + exp(q) - q")
STEPS, H = 30, Fraction(1, 70)
COMPILED_DIGITS = 25


def true_values(step_map: StepMap) -> tuple[Fraction, Fraction]:
    stepper = Stepper(step_map, 80)
    p, q = stepper.run(Fraction(1, 3), Fraction(1, 2), H, STEPS)
    return stepper.arithmetic.exact(p), stepper.arithmetic.exact(q)


@pytest.mark.left_to_ci
@pytest.mark.sample(10)
@pytest.mark.parametrize("text", SYSTEMS)
@pytest.mark.parametrize("name", SPLITTINGS)
def test_runs_in_every_arithmetic_hold_the_true_values(name: str, text: str) -> None:
    hamiltonian = Hamiltonian.parse(text)
    p, q = true_values(schemes.get(name).step_map(hamiltonian))
    for used in ("float64", "mpfr", "mpmath", "ball"):
        made = run(
            hamiltonian, name, q="1/2", p="1/3", step_size=H, steps=STEPS, arithmetic=used,
            digits=COMPILED_DIGITS,
        )  # fmt: skip
        assert made.arithmetic == used
        for found, true in ((made.values["p"], p), (made.values["q"], q)):
            bound = Fraction(found.bound)
            assert abs(Fraction(found.value) - true) <= bound
            assert bound < (1e-12 if used == "float64" else 1e-20)
        assert made.values["lambda"].value == "0"


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", ["yoshida4", "blanes-moan4", "triple-jump6"])
def test_fixed_point_numbers_have_the_irrational_coefficients(name: str) -> None:
    hamiltonian = Hamiltonian.parse(SYSTEMS[0])
    p, q = true_values(schemes.get(name).step_map(hamiltonian))
    made = run(
        hamiltonian, name, q="1/2", p="1/3", step_size=H, steps=STEPS, arithmetic="fixed",
        digits=COMPILED_DIGITS,
    )  # fmt: skip
    assert made.arithmetic == "fixed", "not what it falls back on"
    for found, true in ((made.values["p"], p), (made.values["q"], q)):
        assert abs(Fraction(found.value) - true) <= Fraction(found.bound) < 1e-20


@pytest.mark.parametrize("digits", [30, 200])
@pytest.mark.parametrize(("number", "degree"), [("2", 3), ("4", 3), ("2", 15), ("1/700", 5)])
def test_a_given_root_is_rounded_as_the_bound_says(number: str, degree: int, digits: int) -> None:
    program, fixed = StepProgram(), arithmetic.get("fixed", digits)
    root = program.root(program.constant(Fraction(number)), degree)
    lowering = Lowering(program, fixed.functions, bits=fixed.bits)
    assert lowering.function(root) is None
    given = fixed.exact(lowering.named_constants(fixed.number)[f"number_{lowering.name(root)}"])
    with working_precision(2000):
        bound = rounding_of(fixed)(program.ops[root], flint.arb(2))
        true = rational_ball(Fraction(number)).root(degree)
        assert abs(rational_ball(given) - true) < bound
        assert abs(rational_ball(given + Fraction(1, 2**fixed.bits)) - true) > bound, "a unit off"


def test_a_root_of_what_is_no_number_is_still_not_there() -> None:
    program = StepProgram()
    root = program.root(program.input("h", static=True), 3)
    assert Lowering(program, arithmetic.get("fixed", 30).functions).function(root) == "root"
