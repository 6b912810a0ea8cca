"""Where a certificate has to be careful: what was found to be wrong once, and its like."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import flint
import pytest

from tests.helpers.exact_orbits import assert_contained, case, enclosed_finely
from verify.arithmetic.arb import bounds, rational_ball
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import fixed, float64, mpfr, mpmath
from verify.execution.keeper import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.rounding import rounding_of
from verify.kernels.step.kinds import RationalConstant
from verify.kernels.stepping import KernelRun
from verify.runs.a_posteriori_bound import certify
from verify.runs.requested_run import run
from verify.runs.step_bounds import StepDerivatives
from verify.scenes.observables import REPORTED

FREE = "p**2/2"
WIDE = fixed.at_bits(112)


def certified_and_contained(at: Any, arithmetic: Arithmetic) -> dict[str, Fraction]:
    """What is certified of a run, which contains the true values."""
    kernel_run = at.kernel_run()
    made = kernel_run.run(arithmetic, tangent=True)
    assert made.done == at.steps
    errors = certify(kernel_run, arithmetic, made)
    assert errors is not None
    assert_contained(made.values, errors, enclosed_finely(at, errors), at)
    return errors


# -- fixed point: what leaves the format ----------------------------------------------------------

PARTIAL = [
    ("sqrt(a)*q**2 + q**4", "1e-10"), ("q**2/a", "1e-5"), ("q**2*exp(-a)/2", "-12"),
    ("q**2*cosh(a)/100000", "10.9"), ("q**2*log(a)", "1e-40"), ("q**2*log(-a)", "-1e-40"),
]  # fmt: skip


@pytest.mark.sample(2)
@pytest.mark.parametrize(("potential", "a"), PARTIAL)
def test_a_function_of_a_parameter_without_a_value_in_fixed_point_goes_to_mpfr(
    potential: str, a: str
) -> None:
    """It is computed before the loop, and has to be remembered in it."""
    hamiltonian = Hamiltonian.parse(f"p**2/2 + {potential}", {"a": a})
    at: dict[str, Any] = {"q": "0.1", "p": 0, "step_size": "0.0001", "steps": 20, "digits": 25}
    found, true = (run(hamiltonian, "lie2", **at, arithmetic=name) for name in ("fixed", "mpmath"))
    assert found.arithmetic == "mpfr"
    assert found.fallback
    for name, value in found.values.items():
        near = Fraction(true.values[name].value), Fraction(true.values[name].bound)
        assert abs(Fraction(value.value) - near[0]) <= Fraction(value.bound) + near[1], name


def test_a_function_of_a_parameter_with_a_value_stays_in_fixed_point() -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + sqrt(a)*q**2 + q**4", {"a": "1e-3"})
    found = run(hamiltonian, "lie2", q="0.1", p=0, step_size="0.0001", steps=20, digits=25,
                arithmetic="fixed")  # fmt: skip
    assert (found.arithmetic, found.error_kind) == ("fixed", "enclosed")


@pytest.mark.parametrize("observables", [REPORTED, ("lambda_plain",)])
def test_a_product_of_determinants_that_leaves_the_format_goes_to_mpfr(
    observables: tuple[str, ...],
) -> None:
    """(1 + h²)^2000 = 4·10⁸, of an orbit that stays below 10."""
    found = run(Hamiltonian.parse("p**2/2 + q**2/2"), "lie1", q="0.001", p=0, step_size="0.1",
                steps=2000, arithmetic="fixed", digits=20, observables=observables)  # fmt: skip
    value = found.values["lambda_plain"]
    true = (1 + Fraction(1, 100)) ** 2000 - 1
    assert found.arithmetic == "mpfr"
    assert abs(Fraction(value.value) - true) <= Fraction(value.bound)


# -- Λ --------------------------------------------------------------------------------------------


def area(factor: str) -> str:
    return f"p_next = p; q_next = q*({factor})"


def test_a_product_that_rounding_holds_still_is_certified_with_the_factor_that_it_lost() -> None:
    """With 8 bits Λ stays below 1 where it is e^9.7, and so what is seen of it does not tell."""
    at = case(FREE, area("1 + 1/1024"), 0, 0, 1, 10_000)
    errors = certified_and_contained(at, mpfr.at_bits(8))
    assert errors["lambda"] > 10_000


@pytest.mark.parametrize("arithmetic", [WIDE, mpfr.at_bits(60)], ids=lambda a: a.name)
@pytest.mark.parametrize("factor", ["1/2", "1/16", "31/16", "1 - h/3"])
def test_an_area_that_nearly_vanishes_or_doubles_at_every_step_is_certified(
    factor: str, arithmetic: Arithmetic
) -> None:
    at = case(FREE, area(factor), "1/3", "1/7", 1, 8)
    assert "lambda" in certified_and_contained(at, arithmetic)


@pytest.mark.parametrize("factor", ["0", "-1/2", "-1"])
def test_a_factor_that_is_not_positive_gives_no_certificate(factor: str) -> None:
    kernel_run = case(FREE, area(factor), "1/3", "1/7", 1, 5).kernel_run()
    made = kernel_run.run(mpfr.at_bits(60), tangent=True)
    assert not certify(kernel_run, mpfr.at_bits(60), made)


def test_a_factor_far_from_1_is_certified_without_its_logarithm() -> None:
    at = case(FREE, area("5/2"), "1/3", "1/7", 1, 5)
    assert "lambda" in certified_and_contained(at, mpfr.at_bits(60))


@pytest.mark.parametrize("arithmetic", [WIDE, mpfr.at_bits(60)], ids=lambda a: a.name)
@pytest.mark.parametrize("h", ["5/2", "7", "1e-30", "1/10"])
def test_step_sizes_far_from_those_in_use_are_certified(h: str, arithmetic: Arithmetic) -> None:
    at = case("p**2/2000 + q**2/2000 + q**3/5000", "lie4", "0.1", "0.3", h, 5)
    assert set(certified_and_contained(at, arithmetic)) >= {"p", "q", "mse", "lambda"}


@pytest.mark.sample(3)
@pytest.mark.parametrize("asked", [(), ("mse",), ("lambda",), ("delta_j_max",), ("lambda", "mse")])
def test_what_is_certified_is_what_was_asked_for(asked: tuple[str, ...]) -> None:
    kernel_run = case("p**2/2 - cos(q)", "lie2", "1.5", 0, "0.1", 30).kernel_run(frozenset(asked))
    for arithmetic in (WIDE, mpfr.at_bits(60)):
        made = kernel_run.run(arithmetic, tangent=True)
        assert set(certify(kernel_run, arithmetic, made) or {}) == {"p", "q", *asked}


# -- rounding, domains, sizes ---------------------------------------------------------------------


@pytest.mark.parametrize("made", [mpfr.at_bits(5), mpmath.at_bits(7), mpfr.at_bits(53), WIDE])
@pytest.mark.parametrize(
    "value", [Fraction(1001, 64), Fraction(1, 3), Fraction(-7, 2), Fraction(1)]
)
def test_a_constant_is_off_by_what_its_number_is(made: Arithmetic, value: Fraction) -> None:
    own = rounding_of(made)(RationalConstant(value), flint.arb(0))
    assert bounds(own)[1] >= abs(made.exact(made.number(value)) - value) >= bounds(own)[0]
    assert (own == 0) == (made.exact(made.number(value)) == value)


def test_beyond_the_domain_of_the_map_there_is_no_bound_of_its_second_derivatives() -> None:
    """log q + log 1/q has the derivative 0 everywhere, and no value where q < 0."""
    scheme = "p_next = p + h*(log(q) + log(1/q)); q_next = q + h*p"
    found = StepDerivatives.from_scheme(Hamiltonian.parse(FREE), scheme, volume=True, form=False)
    assert found is not None

    def second(low: str, high: str) -> Any:
        q = rational_ball(Fraction(low)).union(rational_ball(Fraction(high)))
        return found.second({"h": flint.arb("0.1")}, {"p": flint.arb(1), "q": q})

    assert second("0.1", "2") == 0
    assert not second("-0.1", "2").is_finite()


HUGE: list[Callable[[], Any]] = [
    lambda: ("p**2/2 + q", "lie2", {"q": "1e400", "p": 0}),
    lambda: ("p**2/2 + q", "lie2", {"q": 0, "p": "-1e400"}),
    lambda: ("p**2/2 + 1e400*q**2", "lie2", {"q": "1e-300", "p": 0}),
    lambda: ("p**2/2 + 1e-400*q**4", "lie2", {"q": 1, "p": 0}),
    lambda: ("(1 + p)**20 + (1 + q + q**2)**12", "symplectic-euler", {"q": "-0.5", "p": "-1.01"}),
]


@pytest.mark.parametrize("name", ["mpfr", "fixed"])
@pytest.mark.parametrize("made", HUGE)
def test_numbers_beyond_float64_and_maps_of_many_terms_are_run(
    made: Callable[[], Any], name: str
) -> None:
    text, scheme, start = made()
    found = run(Hamiltonian.parse(text), scheme, **start, step_size="0.1", steps=3, digits=20,
                arithmetic=name)  # fmt: skip
    assert found.status in ("finished", "left range")


@pytest.mark.parametrize("bits", [12, 20, 40])
def test_a_run_in_few_bits_has_a_certificate_that_holds_or_none(bits: int) -> None:
    """So few that the quadratic term decides."""
    for steps in (10, 30, 100, 300):
        at = case("p**2/2 - cos(q)", "lie2", "1.5", "0.5", "1/10", steps)
        kernel_run, made = at.kernel_run(), mpfr.at_bits(bits)
        walked = kernel_run.run(made, tangent=True)
        errors = certify(kernel_run, made, walked) or {}
        assert_contained(walked.values, errors, enclosed_finely(at, errors), at)


# -- float64, and runs that go on -----------------------------------------------------------------


def test_the_bounds_of_a_float64_run_are_those_of_a_certified_one() -> None:
    at = case("p**2/2 + q**2/2 + q**4/4", "lie2", "1.5", 0, "1/1000", 3000)
    found = run(Hamiltonian.parse(at.text), "lie2", q=at.q, p=at.p, step_size=at.h, steps=at.steps,
                observables=REPORTED)  # fmt: skip
    assert (found.arithmetic, found.error_kind) == (float64.NAME, "enclosed")
    values = {n: Fraction(v.value) for n, v in found.values.items()}
    errors = {n: Fraction(v.bound) for n, v in found.values.items()}
    true = enclosed_finely(at, {n: e for n, e in errors.items() if n != "lambda_plain"})
    assert_contained(values, errors, {**true, "lambda_plain": true["lambda"]}, at)


@pytest.mark.parametrize("arithmetic", [WIDE, mpfr.at_bits(80)], ids=lambda a: a.name)
def test_a_run_that_was_interrupted_is_certified_as_the_one_that_was_not(
    arithmetic: Arithmetic, tmp_path: Path
) -> None:
    at = case("p**2/2 - cos(q)", "lie2", "1.5", "1.5", "1/100", 3000)
    start = {"p": at.p, "q": at.q, "h": at.h}

    def kernel_run(keeper: Keeper) -> KernelRun:
        observables = frozenset({"lambda", "mse"})
        return KernelRun(
            Hamiltonian.parse(at.text), at.scheme, start, at.steps, observables, 0, keeper
        )

    def interrupt(done: int) -> None:
        if done > 1000:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kernel_run(Keeper(tmp_path, "run")).run(arithmetic, tangent=True, progress=interrupt)
    went_on: list[int] = []
    of = kernel_run(Keeper(tmp_path, "run"))
    second = of.run(arithmetic, tangent=True, progress=went_on.append)
    whole = kernel_run(Keeper(None, "")).run(arithmetic, tangent=True)
    assert went_on[0] > 1000
    assert (second.trail, second.tangents) == (whole.trail, whole.tangents)
    assert certify(of, arithmetic, second) == certify(of, arithmetic, whole) is not None
