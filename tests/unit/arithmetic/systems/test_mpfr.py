"""MPFR against mpmath: the same bits on + − × ÷, the same end of an orbit that leaves the range,
however many stops share a context.

Neither has code in common with the other: mpmath rounds its own integers.
"""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import gmpy2
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify import arithmetic
from verify.arithmetic.systems import mpfr, mpmath
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.digits_on_demand import measure
from verify.runs.float64_bounds import bound_errors
from verify.runs.requested_run import run
from verify.scenes.observables import REPORTED

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + 7*q**4/12")
DIVIDING = Hamiltonian.parse("p**2/2 + 1/(q**2 + a) + q/(3 + p**2)", {"a": "2/7"})
MAP = "p_next = p - h*q/(1 + h*p**2); q_next = q + h*p"
JOBS = [
    pytest.param(DUFFING, "lie2", id="duffing-lie2"),
    pytest.param(DUFFING, "lie3", id="duffing-lie3"),
    pytest.param(DIVIDING, "lie2", id="dividing-lie2"),
    pytest.param(Hamiltonian.parse("p**2/2 + q**2/2"), MAP, id="dividing-map"),
]


def kernel_run(
    h: Hamiltonian, scheme: str, q: Fraction, p: Fraction, steps: int, size: Fraction
) -> KernelRun:
    return KernelRun(h, scheme, {"q": q, "p": p, "h": size}, steps, frozenset(REPORTED), 0)


def assert_the_same_bits(of: KernelRun, bits: int) -> None:
    ours, theirs = of.run(mpfr.at_bits(bits)), of.run(mpmath.at_bits(bits))
    assert ours.done == theirs.done
    assert ours.trail == theirs.trail


@pytest.mark.sample(3)
@pytest.mark.parametrize("bits", [24, 53, 113, 170, 1000])
@pytest.mark.parametrize(("h", "scheme"), JOBS)
def test_a_rational_step_has_the_bits_that_mpmath_has(
    h: Hamiltonian, scheme: str, bits: int
) -> None:
    of = kernel_run(h, scheme, Fraction(3, 2), Fraction(1, 3), 1500, Fraction(1, 70))
    assert len(of.run(mpfr.at_bits(bits)).trail) > 10, "the whole state, at points on the way too"
    assert_the_same_bits(of, bits)


@drawn(50)
@given(
    q=st.fractions(-2, 2, max_denominator=10**6),
    p=st.fractions(-2, 2, max_denominator=10**6),
    size=st.fractions("1/1000", 1, max_denominator=1000),
    bits=st.integers(2, 400),
    at=st.sampled_from(JOBS),
)
def test_the_bits_are_the_same_from_anywhere_at_any_precision(
    q: Fraction, p: Fraction, size: Fraction, bits: int, at: Any
) -> None:
    assert_the_same_bits(kernel_run(*at.values, q, p, 40, size), bits)


@pytest.mark.parametrize("digits", [1, 2, 15, 17, 50, 333])
def test_as_many_digits_are_as_many_bits_as_in_mpmath(digits: int) -> None:
    assert mpfr.make(digits).bits == mpmath.make(digits).bits


def test_one_bit_less_is_seen() -> None:
    """The twin of the tests above: they can tell a last bit."""
    of = kernel_run(DUFFING, "lie2", Fraction(3, 2), Fraction(0), 100, Fraction(1, 70))
    assert of.run(mpfr.at_bits(112)).values != of.run(mpmath.at_bits(113)).values


@pytest.mark.parametrize(("scheme", "size"), [("lie2", "0.5"), ("lie3", "2"), ("lie1", "7/3")])
def test_an_orbit_escapes_at_the_step_at_which_it_does_in_mpmath(scheme: str, size: str) -> None:
    at: dict[str, Any] = {"q": 5, "p": 0, "step_size": size, "steps": 500, "digits": 20}
    ours, theirs = (run(DUFFING, scheme, **at, arithmetic=n) for n in ("mpfr", "mpmath"))
    assert ours.status == theirs.status == "left range"
    assert ours.failed_step == theirs.failed_step


MADE = mpfr.at_bits(100)
UNDEFINED = [
    "1/(x - x)", "1/log(x - x)", "log(-x)", "sqrt(-x)", "root(-x, 3)", "root(-x, 4)",
    "exp(1/(x - x)) - exp(1/(x - x))", "exp(exp(exp(exp(20*x))))", "1/exp(exp(exp(20*x)))",
]  # fmt: skip


@pytest.mark.parametrize("source", UNDEFINED)
def test_what_is_undefined_or_out_of_range_is_an_error_even_where_a_number_comes_out(
    source: str,
) -> None:
    x = MADE.number(Fraction(4, 3))
    with pytest.raises((ArithmeticError, ValueError)), MADE.context():
        eval(source, dict(MADE.functions), {"x": x})  # noqa: S307 - this file's own text
    with MADE.context():
        assert x - x == 0, "an earlier error is forgotten"


def counting(bad: int, worse: int = 99) -> Any:
    """A kernel that adds 1 at each step; an infinity comes and goes in step `bad`, and step `worse`
    is an error at once."""

    def kernel(steps: int, one: Any, x: Any) -> Any:
        for _ in range(steps):
            x = x + one
            if x == bad:
                x = x + one / (one / (x - x))  # 1/(1/0) = 0
            if x == worse:
                raise ValueError
        return steps, x

    return kernel


@pytest.mark.parametrize(("bad", "worse", "kept"), [(7, 99, 3), (7, 9, 3), (99, 9, 4), (99, 99, 6)])
def test_of_stops_in_one_context_those_before_the_first_error_are_kept(
    bad: int, worse: int, kept: int
) -> None:
    """What a flag remembers is seen when the context is left, some stops later."""
    one, zero = MADE.number(Fraction(1)), MADE.number(Fraction(0))
    found = run_alone(MADE.states(counting(bad, worse), 2, 6, [one], [zero]))
    assert found == [[2], [4], [6], [8], [10], [12]][:kept]


def test_stops_that_stay_in_range_share_a_context() -> None:
    entered: list[int] = []

    def context() -> Any:
        entered.append(1)
        return MADE.context()

    one, zero = MADE.number(Fraction(1)), MADE.number(Fraction(0))
    assert (
        len(run_alone(replace(MADE, context=context).states(counting(99), 1, 50, [one], [zero])))
        == 50
    )
    assert len(entered) == 1


@pytest.mark.parametrize("name", ["mpfr", "mpmath", "ball", "float64"])
def test_a_run_that_leaves_between_stops_ends_where_it_does_stop_by_stop(name: str) -> None:
    """Of √q, whose root is undefined after some eighty steps, and of q, which is so nowhere."""
    made = arithmetic.get(name, 30)
    for formula, leaves in (("p**2/2 + sqrt(q)", True), ("p**2/2 + q", False)):
        start = {"q": Fraction(1), "p": Fraction(-1), "h": Fraction(1, 100)}
        of = KernelRun(Hamiltonian.parse(formula), "lie2", start, 500, frozenset(), 0, sections=100)
        together, each = of.run(made), of.run(replace(made, chunk=of.section))
        assert (together.done, together.trail) == (each.done, each.trail)
        assert (1 < len(together.trail) < 100) == (together.done < of.steps) == leaves


def assert_is_the_quotient(number: Any, bits: int, value: Fraction) -> None:
    """Rounded to nearest, to even, as integers alone have it; the value is between 0 and 1."""
    scale = bits
    while value * 2**scale < 2 ** (bits - 1):
        scale += 1
    assert number.precision == bits
    assert Fraction(*number.as_integer_ratio()) == Fraction(round(value * 2**scale), 2**scale)


@drawn(200)
@given(
    st.sampled_from([24, 53, 100, 113, 333, 1000]),
    st.integers(1, 10**40),
    st.sampled_from([1, 3, 7, 10**40 + 1]),
)
def test_division_rounds_at_the_contexts_precision(bits: int, above: int, more: int) -> None:
    # gmpy2 2.2.0 to 2.2.2 divided with the precision of the context of whoever asked.
    value = Fraction(above, above + more)
    made = mpfr.at_bits(bits)
    for callers in (gmpy2.context(), gmpy2.context(precision=20, round=gmpy2.RoundUp)):
        with callers:
            assert_is_the_quotient(made.number(value), bits, value)
        with callers, made.context():
            quotient = gmpy2.mpz(above) / gmpy2.mpz(above + more)
            assert_is_the_quotient(quotient, bits, value)


def test_a_quotient_of_another_precision_is_seen() -> None:
    third = gmpy2.mpq(1, 3)
    for planted in (gmpy2.mpfr(third), gmpy2.mpfr(gmpy2.mpfr(third), 100)):
        with pytest.raises(AssertionError):
            assert_is_the_quotient(planted, 100, Fraction(1, 3))
    assert_is_the_quotient(gmpy2.mpfr(third, 100), 100, Fraction(1, 3))


def test_a_context_is_its_own_whatever_the_threads_context_is() -> None:
    x = MADE.number(Fraction(1, 3))
    with MADE.context():
        expected = MADE.exact(gmpy2.sin(x) / 3)
    odd = gmpy2.context(
        precision=20, real_prec=11, round=gmpy2.RoundUp, emax=9, emin=-9, subnormalize=True,
        trap_inexact=True, allow_complex=True, rational_division=True,
    )  # fmt: skip
    with odd:
        before = repr(gmpy2.get_context())
        made = mpfr.at_bits(100)
        assert made.number(Fraction(1, 3)) == x
        assert made.functions == MADE.functions
        with made.context():
            assert made.exact(gmpy2.sin(x) / 3) == expected
        with pytest.raises(KeyError), made.context():
            raise KeyError
        with pytest.raises(ArithmeticError), made.context():
            gmpy2.log(x - x)
        with made.context(), arithmetic.get("mpfr", 500).context(), made.context():
            pass
        assert repr(gmpy2.get_context()) == before


@pytest.mark.parametrize("text", ["p**2/2 + q**2/2 + 7*q**4/12", "p**2/2 - cos(q)"])
def test_the_bounds_of_float64_are_those_that_mpmath_would_give(text: str) -> None:
    of = kernel_run(
        Hamiltonian.parse(text), "lie2", Fraction(3, 2), Fraction(0), 500, Fraction(1, 70)
    )
    first = of.run(arithmetic.get("float64", 17))
    found = run_alone(bound_errors(of, first, {}))
    assert found.rigorous
    by_mpmath = run_alone(measure(of, "mpmath", 30)).bounds
    for name, (value, bound) in found.values.items():
        true, error = by_mpmath.values[name]
        assert value == first.values[name]
        assert abs(bound - abs(value - true)) <= abs(true) / 10**19 + error
