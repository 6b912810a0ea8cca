"""Truncation and rounding of Λ and of W: bits of the real kernel, planted errors, digits."""

import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.sampled.separations import area_chains, chain_of
from tests.paths import vectors
from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.studies.separation import mixed_kernel as separation_kernel
from verify.studies.separation.chain import PARTS, QUANTITIES, Chain
from verify.studies.separation.links import LinksOnDemand, separate_chains
from verify.studies.separation.mixed_kernel import mixed_kernel
from verify.studies.separation.mixed_run import MixedRun
from verify.studies.separation.truncation_and_rounding import separate

VECTORS = vectors()
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
HENON = systems.get("henon-heiles").hamiltonian({})
DRIVEN = systems.get("driven-henon-heiles").hamiltonian({"epsilon": "1/10", "omega": "7/5"})
AT = {"q": "1.5", "p": "1/3", "step_size": "0.001"}
AT_2: dict[str, Any] = {"q": ["0.3", "-0.1"], "p": ["0.1", "0.2"], "step_size": "0.1"}


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


@pytest.mark.parametrize(
    ("hamiltonian", "start", "steps", "way", "observable"),
    [
        (DUFFING, {"p": "1/3", "q": "3/2", "h": "1/1000"}, 2000, "plain", "lambda_plain"),
        (HENON, {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1", "h": "0.1"}, 300,
         "closed_form", "symplectic_defect"),
    ],
    ids=["plane", "degrees"],
)  # fmt: skip
def test_the_working_value_is_that_of_a_float64_run_bit_for_bit(
    hamiltonian: Hamiltonian, start: dict[str, str], steps: int, way: str, observable: str
) -> None:
    at = {name: Fraction(x) for name, x in start.items()}
    chains = getattr(run_alone(separate_chains(hamiltonian, "lie2", at, steps, 17)), way)
    kernel_run = KernelRun(hamiltonian, "lie2", at, steps, frozenset({observable}), 0)
    value = kernel_run.run(number_systems.get("float64", 17)).values[observable]
    assert max(abs(chain.final("lambda_working")[0]) for chain in chains) == value


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


# -- in n degrees of freedom ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("hamiltonian", "scheme", "steps", "t0"),
    [
        (HENON, "stormer-verlet", 60, 0),
        (HENON, "implicit-midpoint", 60, 0),
        (HENON, "gauss4", 60, 0),
        (DRIVEN, "gauss4", 20, "1/3"),
    ],
    ids=["stormer-verlet", "implicit-midpoint", "gauss4", "driven-gauss4"],
)
def test_of_what_is_symplectic_by_proof_all_of_w_is_rounding(
    hamiltonian: Hamiltonian, scheme: str, steps: int, t0: str | int
) -> None:
    result = separate(hamiltonian, scheme, **AT_2, steps=steps, t0=t0)
    assert (result.status, result.arithmetic) == ("finished", "mpfr")
    assert result.plain is not None
    assert result.closed_form is not None
    parts = result.plain.parts
    for part in (parts.truncation, parts.input, parts.trajectory):
        assert not any(map(any, part.exact))
    assert any(map(any, parts.total.exact)), "float64 rounds its Jacobians"
    assert 0 < abs(parts.total.largest) < 1e-13
    assert not any(map(any, result.closed_form.parts.w_working.exact))
    assert result.closed_form.error_kind == "enclosed"
    assert "S ≡ 0" in str(result.tangent.meaning)


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("system", "parameters", "scheme", "q", "p"),
    [
        ("kepler", {"mu": 1}, "lie2", ["2/5", "0"], ["0", "2"]),
        ("magnetic", {"b": 1, "k": 1, "c": 1}, "lie4", ["0", "3/4"], ["1/2", "0"]),
        ("fput", {"n": 4, "alpha": "1/4", "beta": "1/2"}, "rk4", ["0.1", "0", "0", "0"], ["0"] * 4),
    ],
)
def test_named_systems_are_separated(
    system: str, parameters: dict[str, Any], scheme: str, q: list[str], p: list[str]
) -> None:
    exact = systems.get(system).hamiltonian(parameters)
    result = separate(exact, scheme, q=q, p=p, step_size="0.01", steps=15)
    assert result.status == "finished"
    assert result.closed_form is not None
    parts = result.closed_form.parts
    assert abs(parts.truncation.largest) > abs(parts.total.largest)
    entry = parts.truncation.entry(0, 1)
    assert -entry == parts.truncation.entry(1, 0)


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
