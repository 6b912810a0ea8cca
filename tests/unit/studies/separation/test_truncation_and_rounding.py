"""Truncation and rounding of Λ: bits of the real kernel, planted errors, what is exactly zero."""

import math
import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.sampled.separations import area_chains
from tests.paths import vectors
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import fixed, mpfr
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.requested_run import run
from verify.studies.separation import mixed_kernel as separation_kernel
from verify.studies.separation.chain import PARTS, QUANTITIES, Chain
from verify.studies.separation.determinants import WORKING, Determinants
from verify.studies.separation.links import LinksOnDemand
from verify.studies.separation.mixed_kernel import mixed_kernel
from verify.studies.separation.mixed_run import MixedRun
from verify.studies.separation.truncation_and_rounding import separate

VECTORS = vectors()
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
HARMONIC = Hamiltonian.parse("p**2/2 + omega**2*q**2/2", {"omega": "7/3"})
AT = {"q": "1.5", "p": "1/3", "step_size": "0.001"}


def chain_of(
    hamiltonian: Hamiltonian, scheme: str, steps: int = 300, name: str = "plain", **start: Any
) -> Chain:
    at = {"p": Fraction(1, 3), "q": Fraction(3, 2), "h": Fraction(1, 1000), **start}
    found: Chain = getattr(area_chains(hamiltonian, scheme, at, steps, 17, "mpfr"), name)
    return found


def finals(chain: Chain) -> dict[str, Fraction]:
    return {name: chain.final(name)[0] for name in QUANTITIES}


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
@pytest.mark.parametrize("scheme", ["lie2", "rk4", "explicit-midpoint"])
@pytest.mark.parametrize("h", ["1/100", "1/100000"])
def test_a_long_run_is_asked_for_enough_digits_at_once(
    hamiltonian: Hamiltonian, scheme: str, h: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However small the step, and so Λ; of lie2 beside float64 in numbers of three limbs."""
    refined, formats = [], []
    refine, step_through = LinksOnDemand.refine, MixedRun.step_through

    def noted_refine(self: Any, *lacking: Any) -> bool:
        refined.append(refine(self, *lacking))
        return refined[-1]

    def noted_steps(self: Any, arithmetic: Arithmetic, advance: Any) -> Any:
        formats.append((arithmetic.name, arithmetic.bits))
        return step_through(self, arithmetic, advance)

    monkeypatch.setattr(LinksOnDemand, "refine", noted_refine)
    monkeypatch.setattr(MixedRun, "step_through", noted_steps)
    at = {**AT, "q": "0.3", "step_size": h}
    assert separate(hamiltonian, scheme, **at, steps=70_000, digits=6).status == "finished"
    assert refined == [False]
    assert scheme != "lie2" or formats == [("fixed", 140)]


def test_the_working_value_is_what_run_reports_for_float64() -> None:
    found = separate(DUFFING, "lie2", **AT, steps=2000)
    reported = run(DUFFING, "lie2", **AT, steps=2000, observables=("lambda", "lambda_plain"))
    assert found.plain is not None
    error = Fraction(found.plain.parts.lambda_working.value) - Fraction(
        reported.values["lambda_plain"].value
    )
    assert abs(error) <= Fraction(reported.values["lambda_plain"].bound)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_fixed_and_mpfr_find_the_same_parts(hamiltonian: Hamiltonian) -> None:
    start = {"p": Fraction(1, 3), "q": Fraction(3, 2), "h": Fraction(1, 1000)}
    run = hamiltonian, "lie2", start, 1000
    found = [area_chains(*run, 17, name) for name in ("fixed", "mpfr")]
    for way in ("plain", "closed_form"):
        one, other = (getattr(each, way) for each in found)
        assert one.kind == other.kind == "enclosed"
        for name in QUANTITIES:
            (x, dx), (y, dy) = one.final(name), other.final(name)
            assert abs(x - y) <= dx + dy <= abs(x) / 10**16, name


# -- what is exactly zero, and known so -----------------------------------------------------------


@pytest.mark.parametrize("name", ["plain", "closed_form"])
def test_a_map_of_determinant_1_has_no_truncation_nor_what_follows_from_it(name: str) -> None:
    chain = chain_of(PENDULUM, "symplectic-euler", name=name, h=Fraction(5, 2))
    for part in ("truncation", "input", "trajectory"):
        assert chain.final(part) == (0, 0)
    assert chain.kind == "enclosed"
    value, bound = chain.final("determinant")
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


# -- planted errors -------------------------------------------------------------------------------


@pytest.fixture
def plant(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, str], None]:
    """Replaces a pattern in the lines of every mixed kernel that is made from now on."""

    def planted(pattern: str, by: str) -> None:
        original = separation_kernel.assemble

        def changed(*given: Any) -> str:
            *others, inside = given
            lines = [re.sub(pattern, by, line) for line in inside]
            assert lines != inside, "the pattern is there"
            return original(*others, lines)

        mixed_kernel.cache_clear()
        monkeypatch.setattr(separation_kernel, "assemble", changed)

    yield planted  # type: ignore[misc]
    mixed_kernel.cache_clear()


ROUNDED = "f_big = 536870913.0 * f_p; f_p = f_big - (f_big - f_p)"  # Veltkamp: float32's 24 bits
PLANTS = {
    "none": ("$a", "", "", 0),
    "states": (r"(f_p = f_p \+ .*)", rf"\1; {ROUNDED}", "trajectory", 1e-12),
    "determinants": (r"(f_det = .*)", r"\1 * 1.0000000001", "determinant", 1e-8),
    "products": (r"(f_plain = .*)", r"\1 * 1.0000000001", "product", 1e-8),
}  # fmt: skip


@pytest.mark.parametrize(("pattern", "by", "part", "least"), PLANTS.values(), ids=PLANTS)
def test_a_planted_error_shows_in_its_own_part_alone(
    plant: Callable[[str, str], None], pattern: str, by: str, part: str, least: float
) -> None:
    usual = finals(chain_of(DUFFING, "lie2", h=Fraction(1, 20)))
    if part:
        plant(pattern, by)
    found = finals(chain_of(DUFFING, "lie2", h=Fraction(1, 20)))
    assert sum(found[n] for n in ("truncation", *PARTS)) == found["lambda_working"]
    changed = {n for n in PARTS if abs(found[n] - usual[n]) > Fraction(1, 10**12)}
    assert changed == ({part} if part else set())
    if part:
        assert abs(found[part]) > least > 1000 * abs(usual[part])
    assert found["truncation"] == usual["truncation"]
    assert found["input"] == usual["input"]
    before = PARTS[: PARTS.index(part)] if part else PARTS
    assert all(found[n] == usual[n] for n in before), "links before the error are the same bits"


# -- bounds ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("made", [mpfr.at_bits(60), fixed.at_bits(112)], ids=["mpfr", "fixed"])
@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_counted_bounds_hold_for_few_bits_and_are_not_far_off(
    hamiltonian: Hamiltonian, made: Arithmetic
) -> None:
    start = {"p": Fraction(1, 3), "q": Fraction(3, 2), "h": Fraction(1, 50)}
    kernel_run = KernelRun(hamiltonian, "lie2", start, 600, WORKING, 10)
    working = MixedRun(Determinants(), kernel_run, follow=True)
    coarse, fine = (
        run_alone(working.step_through(x, lambda _: None)) for x in (made, mpfr.at_bits(300))
    )
    for name in ("trajectory", "factors", "closed_factors"):
        (x,), (y,) = getattr(coarse, name), getattr(fine, name)
        assert x.kind == y.kind == "enclosed"
        error = max(abs(a - b) for a, b in zip(x.trail, y.trail, strict=True))
        assert 0 < error <= x.bound <= 10**5 * error, name


def test_where_rounding_cannot_be_counted_a_rerun_estimates_it() -> None:
    """Λ grows beyond ½ here, and the counted bound speaks of less."""
    chain = chain_of(DUFFING, "lie1", steps=100, h=Fraction(1, 20))
    assert max(map(abs, chain.links[2].trail)) > Fraction(1, 2)
    assert chain.links[2].kind == chain.links[3].kind == "estimated"
    start = {"p": Fraction(1, 3), "q": Fraction(3, 2), "h": Fraction(1, 20)}
    finer = area_chains(DUFFING, "lie1", start, 100, 40, "mpfr").plain
    for name in QUANTITIES:
        (x, dx), (y, dy) = chain.final(name), finer.final(name)
        assert abs(x - y) <= dx + dy, name


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("text", "at"),
    [("p**2/2 + 1/(2 + q**2)", 1), ("p**2/2 + sin(q)", 40000), ("p**2/2 - q**2/2 + sin(q)", 3)],
    ids=["a function that may leave it", "a start beyond it", "an orbit that leaves it"],
)
def test_what_fixed_cannot_follow_goes_to_mpfr(text: str, at: str) -> None:
    found = [
        separate(Hamiltonian.parse(text), "lie2", q=at, p=1, step_size="0.5", steps=30,
                 arithmetic=name) for name in ("fixed", "mpfr")
    ]  # fmt: skip
    assert found[0].plain is not None
    assert found[1].plain is not None
    for (name, x), (_, y) in zip(found[0].plain.parts, found[1].plain.parts, strict=True):
        assert abs(Fraction(x.value) - Fraction(y.value)) <= Fraction(x.bound) + Fraction(
            y.bound
        ), name


@pytest.mark.parametrize("case", VECTORS, ids=["duffing-lie2", "pendulum", "duffing-lie3"])
def test_truncation_is_the_lambda_of_the_vectors(case: dict[str, Any]) -> None:
    hamiltonian = Hamiltonian.parse(case["hamiltonian"], case["parameters"])
    found = separate(hamiltonian, case["scheme"], q=case["q0"], p=case["p0"], digits=30,
                     step_size=case["step_size"], steps=case["steps"])  # fmt: skip
    assert found.plain is not None
    assert found.closed_form is not None
    truncation = found.plain.parts.truncation
    error = abs(Fraction(truncation.value) - Fraction(case["lambda"]))
    assert error <= Fraction(truncation.bound)
    assert len(truncation.value.partition("e")[0].strip("-")) == 31, "30 digits and a point"
    plain, closed = (abs(Fraction(x.parts.total.value)) for x in (found.plain, found.closed_form))
    assert closed < plain / 10**2, "the closed form buys two digits at least"


def test_a_bound_of_astronomical_size_is_none_and_is_not_written_out() -> None:
    """Over the region visited exp(p) goes beyond what a rational may hold: 4 GB, and no end."""
    escaping = Hamiltonian.parse("a*q**2 + 5*exp(p - 3*q)/2", {"a": "1/2"})
    found = separate(
        escaping, "explicit-midpoint", q="-13/20", p="67/50", step_size="1/16", steps=11, digits=8
    )
    assert found.status == "finished"
    assert found.plain is not None
    assert found.plain.error_kind == "estimated"


def test_at_an_equilibrium_the_noise_in_p_is_not_waited_for() -> None:
    """Of an H with a parameter, p's parts cancel up to rounding; written out, exactly."""
    at: dict[str, Any] = {"q": "0." + 22 * "9", "p": 0, "step_size": "1/100", "steps": 100}
    soft = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": -1})
    written = Hamiltonian.parse("p**2/2 + q**2/2 - q**4/4")
    one, other = (separate(h, "lie4", digits=3, **at) for h in (soft, written))
    assert (one.status, other.status) == ("finished", "finished")
    assert one.plain is not None
    assert other.plain is not None
    assert one.plain.parts.truncation == other.plain.parts.truncation


@pytest.mark.parametrize(
    ("formula", "scheme", "h", "steps", "digits"),
    [
        ("p**2/2 + q**2/2", "rk4", "1e-6", 1000, 17),  # ΔJ is a constant, and known by a proof
        ("p**2/2 + q**2/2", "rk4", "1e-7", 1000, 17),
        ("p**2/2 + q**2/2", "explicit-midpoint", "1e-12", 1, 20),
        ("p**2/2 + q**2/2", "lie2", "1e-12", 1000, 20),
        ("p**2/2 + 3*(1 - exp(-q))**2", "rk4", "1e-20", 1000, 10),  # Λ is near 10^−120
    ],
)
def test_all_parts_have_the_digits_that_are_asked_for(
    formula: str, scheme: str, h: str, steps: int, digits: int
) -> None:
    """However small they are beside the product."""
    at = {"q": "0.5", "p": "0.25", "step_size": h}
    found = separate(Hamiltonian.parse(formula), scheme, **at, steps=steps, digits=digits)
    for way in (found.plain, found.closed_form):
        assert way is not None
        largest = max(abs(Fraction(value.value)) for _, value in way.parts)
        for name, value in way.parts:
            size, bound = abs(Fraction(value.value)), Fraction(value.bound)
            nothing = size == 0 and bound * 10 ** (4 * digits) <= largest
            known = bound * 10 ** (digits - 1) <= size
            assert nothing or known, f"{name}: {value.value} ± {value.bound}"


@pytest.mark.parametrize("name", ["sum", "rest", "p_low", "x0", "plain"])
def test_a_parameter_may_have_a_name_that_the_kernel_has_for_itself(name: str) -> None:
    asked = {"scheme": "lie2", "q": 1, "p": 0, "step_size": "0.1", "steps": 20}
    named = Hamiltonian.parse(f"p**2/2 + {name}*q**4/4", {name: 3})
    plain = Hamiltonian.parse("p**2/2 + a*q**4/4", {"a": 3})
    one, other = (separate(exact, **asked) for exact in (named, plain))  # type: ignore[arg-type]
    assert one.plain == other.plain
    assert one.closed_form == other.closed_form
