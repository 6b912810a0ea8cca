"""One conformance suite for every number system that `verify.arithmetic` finds.

The checks themselves are in conformance.py.
"""

import re
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import cache
from typing import Any

import click
import flint
import gmpy2
import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers import conformance
from tests.helpers.conformance import function
from verify import arithmetic
from verify.algebra.enclosure import BALLS
from verify.arithmetic.number_system import Arithmetic
from verify.commands.run import run as run_command
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.observables import REPORTED

DIGITS = {"fixed": (17, 36)}  # to compile it for more takes long; tests/property has all widths


def _systems() -> list[Any]:
    """Each number system at several precisions, but once where `digits` changes nothing."""
    found: list[Arithmetic] = []
    params = []
    for name in arithmetic.names():
        for digits in DIGITS.get(name, (17, 50, 200)):
            made = arithmetic.get(name, digits)
            if made not in found:
                found.append(made)
                params.append(pytest.param(name, digits, id=f"{name}-{digits}"))
    return params


SYSTEMS = _systems()
every_system = pytest.mark.parametrize(("name", "digits"), SYSTEMS)
numbers = st.builds(
    lambda x, e: x * Fraction(10) ** e,
    st.fractions(min_value=-10, max_value=10, max_denominator=10**9),
    st.integers(-250, 250),
)
# Products and quotients of these stay in every arithmetic's range.
middling = st.builds(
    lambda x, e: x * Fraction(10) ** e,
    st.fractions(min_value=-10, max_value=10, max_denominator=10**9),
    st.integers(-30, 30),
)

get = cache(arithmetic.get)  # so that what was compiled for one is found again


def test_the_number_systems_are_found() -> None:
    assert {"float64", "fixed", "mpmath", "mpfr", "ball"} <= set(arithmetic.names())


def test_the_command_line_names_every_number_system() -> None:
    (option,) = (o for o in run_command.params if o.name == "arithmetic")
    assert isinstance(option, click.Option)
    words = re.findall(r"\w+", option.help or "")
    assert set(arithmetic.names()) <= set(words)


@every_system
def test_an_arithmetic_knows_its_name_and_has_the_digits_asked_for(name: str, digits: int) -> None:
    made = arithmetic.get(name, digits)
    assert made.name == name
    assert made.bits == 53 or 2**made.bits >= 10**digits
    assert made == arithmetic.get(name, digits)
    assert made.chunk >= 1


@every_system
@drawn(60)
@given(x=numbers)
def test_a_rational_is_rounded_once_and_read_back_exactly(
    name: str, digits: int, x: Fraction
) -> None:
    conformance.check_number(get(name, digits), x)


@every_system
@drawn(60)
@given(m=st.integers(-(2**53), 2**53), e=st.integers(-300, 300))
def test_what_the_working_precision_holds_is_kept_exactly(
    name: str, digits: int, m: int, e: int
) -> None:
    made = arithmetic.get(name, digits)
    x = m * Fraction(2) ** (max(e, -made.bits) if made.absolute else e)
    assert made.exact(made.number(x)) == x
    assert made.radius is None or made.radius(made.number(x)) == 0


UNDEFINED = [
    "log(x - x)", "1 / (x - x)", "log(-x)", "sqrt(-x)", "root(-x, 3)", "root(-x, 4)",
    "(x - x) / (x - x)", "sin(1 / (x - x))", "cosh(1 / (x - x))", "x + log(-x) * 0",
]  # fmt: skip


@pytest.mark.sample(74)
@every_system
@pytest.mark.parametrize("source", UNDEFINED)
def test_what_is_not_a_number_is_raised_or_not_finite(name: str, digits: int, source: str) -> None:
    conformance.check_undefined(get(name, digits), f"x: {source}", Fraction(1, 3))


@pytest.mark.sample(6)
@every_system
@drawn(60)
@given(x=middling, y=middling.filter(bool))
def test_every_operation_is_rounded_once(name: str, digits: int, x: Fraction, y: Fraction) -> None:
    conformance.check_operations(get(name, digits), x, y)


@every_system
@drawn(30)
@given(x=middling, y=middling)
def test_extremes_are_those_of_the_true_values(
    name: str, digits: int, x: Fraction, y: Fraction
) -> None:
    made = arithmetic.get(name, digits)
    assert ("maximum" in made.functions) == ("minimum" in made.functions)
    assert made.radius is None or "maximum" in made.functions, "an order of balls may be unknown"
    conformance.check_extremes(made, x, y)
    conformance.check_extremes(made, x, x)


# -- functions ------------------------------------------------------------------------------------


def test_the_points_cover_every_function_that_a_hamiltonian_can_need() -> None:
    assert set(conformance.POINTS) | {"root", "inverse"} == set(BALLS)


@pytest.mark.sample(30)
@every_system
@pytest.mark.parametrize("kind", conformance.POINTS)
def test_a_function_is_as_accurate_as_its_arithmetic(name: str, digits: int, kind: str) -> None:
    for point in conformance.POINTS[kind]:
        conformance.check_function(get(name, digits), kind, point)


@every_system
@pytest.mark.parametrize("degree", [2, 3, 5, 7])
def test_a_root_is_as_accurate_as_its_arithmetic(name: str, digits: int, degree: int) -> None:
    for point in conformance.RADICANDS:
        conformance.check_function(get(name, digits), "root", point, degree)


@every_system
def test_cos_and_sin_in_one_call_are_cos_and_sin(name: str, digits: int) -> None:
    made = arithmetic.get(name, digits)
    both = [f for f in ("cos_sin", "sin_cos") if f in made.functions]
    if not both:
        pytest.skip("this arithmetic has no such call")
    for f in both:
        for point in conformance.POINTS["sin"]:
            conformance.check_pair(made, f, point)


@every_system
def test_pi_is_pi(name: str, digits: int) -> None:
    conformance.check_pi(arithmetic.get(name, digits))


# -- runs -----------------------------------------------------------------------------------------

SMALL = [
    pytest.param(Hamiltonian.parse("p**2/2 + q**2/2 + 7*q**4/12"), "lie3", id="duffing"),
    pytest.param(Hamiltonian.parse("p**2/2 + exp(q) + sqrt(q + 3) + atan(p)/9"), "lie2", id="all"),
    pytest.param(Hamiltonian.parse("p**2/2 - cos(q)"), "yoshida4", id="seven shears"),
]
ESCAPING = Hamiltonian.parse("p**2/2 + q**4/4 + log(q + 9)")


def small_run(h: Hamiltonian, scheme: str, name: str, digits: int) -> dict[str, Any]:
    made = run(h, scheme, q="0.5", p="1/3", step_size="1/70", steps=40, arithmetic=name,
               digits=digits, observables=REPORTED, points=7)  # fmt: skip
    return made.model_dump(exclude={"seconds"})


def global_state() -> tuple[Any, ...]:
    """What libraries keep for the process or the thread; gmpy2's has its flags in it."""
    return mpmath.mp.prec, mpmath.iv.prec, flint.ctx.prec, repr(gmpy2.get_context())


@contextmanager
def odd_global_state() -> Iterator[None]:
    """Other global precisions, roundings and ranges than a number system would want."""
    before = mpmath.mp.prec, mpmath.iv.prec
    odd = gmpy2.context(precision=26, round=gmpy2.RoundUp, emax=99, emin=-99, trap_inexact=True)
    try:
        mpmath.mp.prec, mpmath.iv.prec = 20, 22
        with odd, flint.ctx.workprec(24):
            yield
    finally:
        mpmath.mp.prec, mpmath.iv.prec = before


@pytest.mark.sample(3)
@every_system
@pytest.mark.parametrize(("h", "scheme"), SMALL)
def test_a_run_is_repeated_to_the_last_bit_whatever_the_global_precision_which_stays(
    name: str, digits: int, h: Hamiltonian, scheme: str
) -> None:
    before = global_state()
    expected = small_run(h, scheme, name, digits)
    assert expected["status"] == "finished"
    assert global_state() == before
    with odd_global_state():
        changed = global_state()
        assert small_run(h, scheme, name, digits) == expected
        made = arithmetic.get(name, digits)
        assert made.exact(made.number(Fraction(1, 3))) == made.exact(made.number(Fraction(1, 3)))
        conformance.check_number(made, Fraction(1, 3))
        conformance.check_pi(made)
        assert global_state() == changed
    assert global_state() == before


@pytest.mark.sample(5)
@every_system
def test_nothing_global_is_changed_where_a_run_or_its_user_fails(name: str, digits: int) -> None:
    def stop(done: int) -> None:
        raise InterruptedError(done)

    before, made = global_state(), arithmetic.get(name, digits)
    at: dict[str, Any] = {"step_size": 1, "steps": 50, "arithmetic": name, "digits": digits}
    assert run(ESCAPING, "lie2", q=5, p=0, **at).status == "left range"
    with pytest.raises(InterruptedError):
        run(SMALL[0].values[0], "lie2", q=1, p=0, progress=stop, **at)
    with pytest.raises(InterruptedError), made.context(), made.context():
        raise InterruptedError
    with made.context(), arithmetic.get(name, 2 * digits).context(), made.context():
        pass
    assert global_state() == before


@every_system
def test_threads_at_different_precisions_do_not_disturb_each_other(name: str, digits: int) -> None:
    """A second thread enters its context within the first one's, where it can, and leaves later."""
    before = global_state()
    found: dict[int, Fraction] = {}
    entered, left = threading.Event(), threading.Event()

    def third(asked: int, inside: Callable[[], object]) -> None:
        made = arithmetic.get(name, asked)
        one, three = (made.number(Fraction(n)) for n in (1, 3))
        divide = function(made, "x, y: x / y")  # where numbers have no operators
        with made.context():
            inside()
            third = divide(one, three) if made.absolute else one / three
            found[asked] = made.exact(third)

    def second() -> None:
        third(digits + 100, lambda: (entered.set(), left.wait(5)))

    def first() -> None:
        thread.start()
        entered.wait(0.05)  # in vain where one thread at a time is let in

    thread = threading.Thread(target=second)
    third(digits, first)
    left.set()
    thread.join()
    assert global_state() == before
    for asked, value in found.items():
        alone = arithmetic.get(name, asked)
        assert value == alone.exact(
            function(alone, "x, y: x / y")(*map(alone.number, map(Fraction, (1, 3))))
        )


@pytest.mark.parametrize("name", ["", "float32", "mpmath ", "../float64", "__init__"])
def test_an_unknown_arithmetic_is_an_input_error_that_names_the_known(name: str) -> None:
    with pytest.raises(InputError, match=r"^arithmetic=.*float64.*mpmath"):
        arithmetic.get(name, 17)
