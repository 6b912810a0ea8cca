"""Runs in fixed never leave its range unseen: what they find is what mpfr finds.

A kernel's run either ends early and says why, or its values are within their certified bounds of
those of a run with many more bits; `run` then goes to mpfr, and the result says so.
"""

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.fixed_checks import FRACTION_OF
from tests.helpers.sampled import formulas as strategies
from verify.arithmetic.compiled import engine
from verify.arithmetic.systems import fixed, mpfr
from verify.arithmetic.wide.one_orbit import OneOrbit
from verify.code_cache import OFF, VARIABLE
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels import stepping
from verify.kernels.kernel import KernelWriter, kernel_for
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs.a_posteriori_bound import certify
from verify.runs.requested_run import run
from verify.scenes.observables import CLOSED_FORM, REPORTED
from verify.scenes.results.run import RunResult

FIXED, LIKE, TRUE = fixed.at_bits(128 - FRACTION_OF), mpfr.at_bits(112), mpfr.at_bits(500)


def check_kernel_run(kernel_run: KernelRun) -> RunOutcome:
    """The run in fixed: what finishes agrees with mpfr, within the bounds that are certified.

    Where there is no certificate it is about as near as mpfr is in as many bits.
    """
    found = kernel_run.run(FIXED, tangent=True)
    where = _described(kernel_run)
    if found.done < kernel_run.steps:
        assert found.reason, where
        return found
    true, like = kernel_run.run(TRUE), kernel_run.run(LIKE)
    assert true.done == kernel_run.steps, f"{where}: mpfr leaves its range at step {true.done + 1}"
    known = certify(kernel_run, FIXED, found) or {}
    for name, x in true.values.items():
        lost = abs(like.values[name] - x) if like.done == kernel_run.steps else abs(x)
        bound = known.get(name, lost * 2**24 + (1 + abs(x)) / 2**60)
        error = abs(found.values[name] - x)
        assert error <= bound, f"{where}: {name} is off by {float(error)} > {float(bound)}"
    return found


def _described(x: KernelRun) -> str:
    return f"{x.hamiltonian}, {x.parameters}, {x.scheme}, {x.start}, {x.steps} steps"


def kernel_run_of(
    h: Hamiltonian, scheme: str, start: dict[str, Fraction], steps: int = 50,
    observables: tuple[str, ...] = CLOSED_FORM,
) -> KernelRun:  # fmt: skip
    return KernelRun(h, scheme, start, steps, frozenset(observables), 0)


# -- any Hamiltonian ------------------------------------------------------------------------------

FAMILIES = [
    "a*p**2/2 + b*q**2/2 + q**4/4", "p**4*a + b*p*q + q**3/3", "p**2/2 - a*cos(b*q)",
    "p**2/2 + a*exp(b*q) + q**2", "p**2/2 + a/q + b*q", "p**2/2 + a*q*log(q) + b*q**2",
    "p**2/2 + a*q*sqrt(q + b)", "p**2/2 + a*cosh(b*q)", "b*p**2 + sinh(q)*a", "a*log(1 + q**2)*p",
]  # fmt: skip
ten = Fraction(10)


def sizes(least: int, most: int) -> st.SearchStrategy[Fraction]:
    """Rationals other than zero of both signs, from 10^least to 10^most."""
    mantissas = st.fractions(min_value=-1, max_value=1, max_denominator=9999).filter(bool)
    return st.builds(lambda x, e: x * ten**e, mantissas, st.integers(least, most))


starts = st.fixed_dictionaries(
    {"q": sizes(-2, 4), "p": sizes(-2, 4), "h": sizes(-4, 1).map(abs)}
) | st.fixed_dictionaries({"q": sizes(-1, 1), "p": sizes(-1, 1), "h": sizes(-4, 0).map(abs)})
asked = st.sampled_from([CLOSED_FORM, ("lambda_plain",), ("mse", "lambda_plain")])


@pytest.mark.left_to_ci
@drawn(150)
@given(
    text=st.sampled_from(FAMILIES),
    a=sizes(-3, 6), b=sizes(-3, 6), start=starts, steps=st.sampled_from([1, 7, 120]),
    observables=asked,
)  # fmt: skip
def test_a_run_is_right_or_ends_and_says_so(
    text: str, a: Fraction, b: Fraction, start: dict[str, Fraction], steps: int,
    observables: tuple[str, ...],
) -> None:  # fmt: skip
    given = {n: x for n, x in (("a", a), ("b", b)) if n in Hamiltonian.parse(text).symbols}
    check_kernel_run(
        kernel_run_of(Hamiltonian.parse(text, given), "lie2", start, steps, observables)
    )


@pytest.mark.left_to_ci
@drawn(20)
@given(
    text=strategies.polynomials(degree=5, most_terms=3) | strategies.trigonometric(most_terms=1),
    scheme=st.sampled_from(["lie1", "lie2", "symplectic-euler"]),
    start=starts,
)
def test_a_run_of_any_hamiltonian_is_right_or_ends_and_says_so(
    text: str, scheme: str, start: dict[str, Fraction]
) -> None:
    try:
        check_kernel_run(kernel_run_of(Hamiltonian.parse(text), scheme, start))
    except InputError:  # a scheme may be implicit for this H
        assume(False)


# -- escapes --------------------------------------------------------------------------------------

# H, its parameters, q, p, h and the number of steps; whether it stays in fixed.
CASES: list[tuple[str, dict[str, Any], Any, Any, str, int, bool]] = [
    ("p**2/2 + q**2/2 + q**4/4", {}, 3, 0, "1", 50, False),
    ("p**2/2 + q**2/2 + q**4/4", {}, 3, 0, "1", 4, False),
    ("p**2/2 + q**2/2 + q**4/4", {}, 1, 0, "0.1", 300, True),
    ("p**2/2 - q**2/2", {}, 1, 0, "0.5", 100, False),
    ("p**2/2 + q**3", {}, "-0.5", 0, "0.1", 400, False),
    ("p**2/2 - a*cos(q)", {"a": 10**6}, 1, 0, "0.0001", 300, False),
    ("p**2/2 - a*cos(q)", {"a": 100}, 1, 0, "0.001", 300, True),
    ("p**2/2 - cos(a*q)", {"a": 10**6}, 1, 0, "0.0001", 100, False),
    ("p**2/2 - q", {}, 1, 32000, "0.1", 20, False),
    ("p**2/2 + exp(q)", {}, 9, 1, "0.001", 200, True),
    ("p**2/2 - exp(q)", {}, 1, 1, "0.1", 60, False),
    ("p**2/2 + exp(q)", {}, 10, 30, "0.01", 60, False),
    ("p**2/2 - 1/q", {}, 1, -1, "0.01", 200, False),
    ("p**2/2 - 1/q", {}, 1, "0.3", "0.01", 100, True),
    ("p**2/2 + 1/q", {}, 1, -2, "0.01", 300, True),
    ("p**2/2 + 1/q", {}, "1/20000", 0, "0.00001", 30, False),
    ("p**2/2 + q*log(q)", {}, 1, -1, "0.05", 300, False),
    ("p**2/2 + q*log(q)", {}, "0.9", "0.1", "0.01", 300, True),
    ("p**2/2 + q*sqrt(q)", {}, 1, "0.1", "0.01", 300, False),
    ("p**2/2 + q*sqrt(q) - q", {}, "0.5", "0.05", "0.01", 300, True),
    ("p**2/2 + cosh(q)", {}, 5, "0.1", "0.01", 300, True),
    ("p**2/2 - cosh(q)", {}, 1, "0.1", "0.1", 100, False),
    ("p**2/2 + sinh(q)", {}, 9, "0.1", "0.01", 300, False),
    ("p**2/2 + q*atan(q)", {}, 1, 0, "0.01", 50, False),
    ("p**2/2 + (q**2 + 1)**(1/3)", {}, 1, 0, "0.01", 50, False),
]  # fmt: skip


def ran(
    name: str, text: str, parameters: dict[str, Any], q: Any, p: Any, step_size: str, steps: int,
    observables: tuple[str, ...] = CLOSED_FORM, scheme: str = "lie2",
) -> RunResult:  # fmt: skip
    return run(Hamiltonian.parse(text, parameters), scheme, q=q, p=p, step_size=step_size,
               steps=steps, arithmetic=name, digits=20, observables=observables)  # fmt: skip


def assert_agree(found: RunResult, true: RunResult) -> None:
    assert (found.status, found.failed_step) == (true.status, true.failed_step)
    assert set(found.values) == set(true.values)
    for name, value in found.values.items():
        error = abs(Fraction(value.value) - Fraction(true.values[name].value))
        assert error <= Fraction(value.bound) + Fraction(true.values[name].bound), name


@pytest.mark.sample(5)
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}-{case[2]}-{case[5]}")
def test_a_result_is_the_one_of_mpfr_and_says_where_it_fell_back(
    case: tuple[str, dict[str, Any], Any, Any, str, int, bool],
) -> None:
    *given, stays = case
    found, true = ran("fixed", *given), ran("mpfr", *given)
    assert_agree(found, true)
    assert (found.arithmetic == "fixed") == (not found.fallback) == stays


GROWING = ("p**2/2 + q**2/2", {}, "0.01", 0, "0.1", 1200)  # Π det J grows to 10^5, and q to 4


@pytest.mark.parametrize("observables", [("lambda_plain",), ("lambda_plain", "mse"), REPORTED])
def test_a_product_of_determinants_that_outgrows_the_format_is_seen(
    observables: tuple[str, ...],
) -> None:
    """The orbit itself stays well inside."""
    true = ran("mpfr", *GROWING, observables=observables, scheme="lie1")
    found = ran("fixed", *GROWING, observables=observables, scheme="lie1")
    assert abs(Fraction(true.values["lambda_plain"].value)) > 2**15
    assert_agree(found, true)
    assert found.fallback


SCHEMES = {
    "pole": "p_next = p - h*q/(1 - 10*h); q_next = q + h*p",
    "logarithm": "p_next = p - h*q*log(1 - 20*h); q_next = q + h*p",
    "root": "p_next = p - h*q*sqrt(1 - 20*h); q_next = q + h*p",
    "exponential": "p_next = p - h*q*exp(200*h); q_next = q + h*p",
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("kind", SCHEMES)
@pytest.mark.parametrize("observables", [(), CLOSED_FORM])
def test_a_function_that_has_no_value_before_the_loop_is_seen(
    kind: str, observables: tuple[str, ...]
) -> None:
    given = ("p**2/2 + q**2/2", {}, 1, 0, "0.1", 3, observables, SCHEMES[kind])
    found = ran("fixed", *given)
    assert_agree(found, ran("mpfr", *given))
    assert found.fallback


# -- losses ---------------------------------------------------------------------------------------


def kernel_run_of_case(
    case: tuple[Any, ...], scheme: str, observables: tuple[str, ...]
) -> KernelRun:
    text, parameters, *start, steps = case
    at = {n: Fraction(x) for n, x in zip("qph", start, strict=True)}
    return kernel_run_of(Hamiltonian.parse(text, parameters), scheme, at, steps, observables)


def kernel_runs() -> list[KernelRun]:
    """What leaves the format for good, only for a while, or before the loop."""
    tasks: list[tuple[tuple[Any, ...], str, tuple[str, ...]]] = [
        (("p**2/2 + q**2/2 + q**4/4", {}, 3, 0, "1", 4), "lie2", CLOSED_FORM),
        (("p**2/2 - q", {}, 1, 32000, "0.1", 100), "lie2", ("lambda",)),
        (("-q", {}, 1, 32000, "10", 200), "lie2", ()),
        (GROWING, "lie1", ("lambda_plain",)),
        (("p**2/2 - 1/q", {}, 1, -1, "0.01", 100), "lie2", ("lambda",)),
        (("p**2/2 + q**2/2", {}, 1, 0, "0.1", 3), SCHEMES["root"], ("lambda",)),
    ]
    return [kernel_run_of_case(*task) for task in tasks]


def wrong_kernel_runs() -> list[str]:
    """Of the kernel runs those that the check finds wrong."""
    wrong = []
    for kernel_run in kernel_runs():
        try:
            check_kernel_run(kernel_run)
        except AssertionError as error:
            wrong.append(str(error))
    return wrong


def anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels are written anew, with what is planted."""
    monkeypatch.setattr(stepping, "kernel_for", kernel_for.__wrapped__)


def test_without_a_loss_no_kernel_run_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    anew(monkeypatch)
    assert wrong_kernel_runs() == []


@pytest.mark.left_to_ci
@pytest.mark.parametrize("unseen", ["p", "q", "plain"])
def test_a_loop_that_looks_away_from_one_number_is_caught(
    monkeypatch: pytest.MonkeyPatch, unseen: str
) -> None:
    anew(monkeypatch)
    true = KernelWriter.guard

    def less(self: KernelWriter, needed: Any) -> str:
        looked_at = true(self, needed).split(" and ")
        return " and ".join(x for x in looked_at if not x.startswith(f"inside({unseen},"))

    monkeypatch.setattr(KernelWriter, "guard", less)
    assert wrong_kernel_runs()


def test_a_function_without_a_value_that_does_not_say_so_is_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    anew(monkeypatch)
    monkeypatch.setattr(engine, "_cached_function", engine._cached_function.__wrapped__)
    monkeypatch.setenv(VARIABLE, OFF)
    monkeypatch.setattr(OneOrbit, "_require", lambda self, condition: None)
    assert wrong_kernel_runs()


def test_limits_beyond_the_format_are_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    anew(monkeypatch)
    monkeypatch.setattr(stepping, "_FORMAT_LIMIT", Fraction(2**40))
    assert wrong_kernel_runs()
