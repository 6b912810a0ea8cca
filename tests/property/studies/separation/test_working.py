"""Separations of drawn runs: what is known without a run, what has no value, interruptions.

Oracles are closed forms and the float64 run of `verify run`.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.separations import (
    KNOWN,
    Remembering,
    area_chains,
    only,
    separated,
    starts,
    step_sizes,
)
from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.execution.keeper import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.requested_run import run
from verify.studies.separation.chain import PARTS, QUANTITIES, Chain, Link
from verify.studies.separation.determinants import WORKING, Determinants
from verify.studies.separation.mixed_run import MixedRun
from verify.studies.separation.truncation_and_rounding import separate

few = drawn(10)
some = drawn(14)


# -- what is not run ------------------------------------------------------------------------------


@some
@given(st.integers(1, 4), st.integers(1, 9), starts, starts, step_sizes, st.integers(1, 60))
def test_a_constant_delta_j_has_a_closed_truncation_and_no_trajectory_part(
    eta: int, b: int, p: Fraction, q: Fraction, h: Fraction, steps: int
) -> None:
    """det J = |R(i h √b)|²; Λ₀ = det^N − 1."""
    start = {"p": p, "q": q, "h": h}
    found, advanced = separated(f"p**2/2 + {b}*q**2/2", f"lie{eta}", start, steps, 17, "mpfr")
    for k, at in ((0, h), (1, Fraction(float(h)))):
        real = sum(
            (-1) ** (n // 2) * (b * at * at) ** (n // 2) / Fraction(math.factorial(n))
            for n in range(0, eta + 1, 2)
        )
        odd = sum(
            (-1) ** (n // 2) * (b * at * at) ** (n // 2) * at / Fraction(math.factorial(n))
            for n in range(1, eta + 1, 2)
        )
        det = real**2 + b * odd**2
        link = found.plain.links[k]
        for n, x in zip(found.plain.marks, link.trail, strict=True):
            assert abs(x - (det**n - 1)) <= link.bound
    assert found.plain.final("trajectory") == (0, 0)
    assert found.plain.links[0].method == "ΔJ is constant"
    assert sum(advanced) == steps, "the float64 run alone"


@few
@given(
    st.sampled_from(KNOWN),
    st.sampled_from(["symplectic-euler", "stormer-verlet", "ruth3"]),
    starts,
    starts,
    step_sizes,
    st.integers(1, 60),
)
def test_a_map_of_determinant_1_has_rounding_alone(
    text: str, scheme: str, p: Fraction, q: Fraction, h: Fraction, steps: int
) -> None:
    found, advanced = separated(text, scheme, {"p": p, "q": q, "h": h}, steps, 17, "mpfr")
    for chain in (found.plain, found.closed_form):
        assert chain is not None
        for part in ("truncation", "input", "trajectory"):
            assert chain.final(part) == (0, 0)
        assert chain.links[0].method == "ΔJ ≡ 0"
    assert found.closed_form is not None
    assert found.closed_form.final("total") == (0, 0)
    assert sum(advanced) == steps


@few
@given(
    st.sampled_from(KNOWN),
    starts,
    starts,
    st.sampled_from([Fraction(1, 8), Fraction(1, 10)]),
    st.integers(2, 40),
    st.booleans(),
)
def test_each_run_is_told_as_it_advances(
    text: str, p: Fraction, q: Fraction, h: Fraction, steps: int, binary: bool
) -> None:
    """The run beside float64, one from the exact inputs, and one from the rounded ones."""
    if binary:
        p, q = Fraction(round(p * 64), 64), Fraction(round(q * 64), 64)
    same = all(Fraction(float(x)) == x for x in (p, q, h))
    found, advanced = separated(text, "lie2", {"p": p, "q": q, "h": h}, steps, 17, "mpfr")
    assert (found.plain.links[0] is found.plain.links[1]) == same
    assert sum(advanced) == (2 if same else 3) * steps
    single, _ = separated(text, "lie2", {"p": p, "q": q, "h": h}, 1, 17, "mpfr")
    assert single.plain.links[1] is single.plain.links[2], "after one step it has no part yet"
    assert single.plain.final("trajectory") == (0, 0)


@few
@given(
    starts,
    starts,
    st.fractions(min_value="1/9", max_value=2, max_denominator=9),
    step_sizes,
    st.integers(1, 30),
)
def test_the_second_link_is_the_first_of_the_rounded_inputs(
    p: Fraction, q: Fraction, delta: Fraction, h: Fraction, steps: int
) -> None:
    def chain(of: Callable[[Fraction], Fraction]) -> Chain:
        values = {"delta": of(delta)}
        hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", values)
        start = {"p": of(p), "q": of(q), "h": of(h)}
        return area_chains(hamiltonian, "lie2", start, steps, 25, "mpfr").plain

    one, other = chain(lambda x: x), chain(lambda x: Fraction(float(x)))
    for a, b in zip(one.links[1].trail, other.links[0].trail, strict=True):
        assert abs(a - b) <= one.links[1].bound + other.links[0].bound
    assert one.links[4].trail == other.links[4].trail
    assert other.links[0] is other.links[1]


# -- what has no value ----------------------------------------------------------------------------

ESCAPING = ("p**2/2 - q**4/4", "p**2/2 - q**6", "p**2/2 - exp(q)", "p**2/2 + q**3")


@few
@given(
    st.sampled_from(ESCAPING),
    st.integers(2, 9),
    st.sampled_from([20, 60, 9000, 60_000]),
    st.sampled_from(["1/2", "1/20"]),
    st.sampled_from(["mpfr", "auto"]),
)
def test_where_float64_leaves_its_range_is_told_as_by_the_run_alone(
    text: str, q: int, steps: int, h: str, name: str
) -> None:
    """With more than 2048 steps a checkpoint has several, among which the last good is found."""
    at: dict[str, Any] = {"q": q, "p": 1, "step_size": h, "steps": steps}
    hamiltonian = Hamiltonian.parse(text)
    found = separate(hamiltonian, "lie2", **at, arithmetic=name)
    alone = run(hamiltonian, "lie2", **at, arithmetic="float64", observables=("lambda_plain",))
    if alone.status == "left range":
        assert (found.status, found.plain, found.closed_form) == ("left range", None, None)
        assert found.failed_step is not None
        assert found.failed_step == alone.failed_step
        assert found.reason
        assert found.error_method == "none"
        shorter = separate(
            hamiltonian, "lie2", **at | {"steps": max(found.failed_step - 2, 1)}, arithmetic=name
        )
        assert shorter.status == "finished" or found.failed_step <= 2
    else:
        assert found.status != "left range"


@pytest.mark.parametrize("name", ["q", "p", "step_size"])
def test_an_input_beyond_float64_is_named(name: str) -> None:
    at: dict[str, Any] = {"q": 1, "p": 1, "step_size": "1/2", "steps": 3} | {
        name: Fraction(10) ** 400
    }
    found = separate(Hamiltonian.parse("p**2/2 + q**2/2"), "lie2", **at)
    assert (found.status, found.failed_step) == ("left range", 1)
    assert f"{'h' if name == 'step_size' else name} is beyond the range" in found.reason


@few
@given(st.integers(2, 30), st.integers(3, 9))
def test_a_determinant_below_0_leaves_the_closed_form_out(steps: int, h: int) -> None:
    """lie1 on p²/2 − q²/2: det J = 1 − h², by which every Λ is below −1 for an odd N."""
    text = "p**2/2 - q**2/2 + q**3/100"
    found, _ = separated(
        text,
        "lie1",
        {"p": Fraction(0), "q": Fraction(1, 100), "h": Fraction(h, 2)},
        steps,
        17,
        "mpfr",
    )
    assert found.closed_form is None
    assert found.plain.final("lambda_working")[0] != 0


# -- interruptions --------------------------------------------------------------------------------


@cache
def number_system(name: str) -> Arithmetic:
    return number_systems.get(name, 40)


def went(link: Link | None) -> tuple[Any, ...]:
    return () if link is None else (link.trail, link.bound, link.kind, link.method)


@few
@given(
    st.sampled_from(KNOWN),
    st.sampled_from(["mpfr", "mpmath"]),
    st.integers(2, 40),
    st.integers(0, 39),
)
def test_a_run_that_is_interrupted_goes_on_to_the_same_bits(
    text: str, name: str, steps: int, after: int
) -> None:
    start = {"p": Fraction(1, 3), "q": Fraction(2, 3), "h": Fraction(1, 10)}
    keeper, made = Remembering(), number_system(name)
    told: list[int] = []

    def interrupting(done: int) -> None:
        told.append(done)
        if sum(told) > after:
            raise KeyboardInterrupt

    def working(of: Keeper) -> MixedRun:
        kernel_run = KernelRun(Hamiltonian.parse(text), "lie2", start, steps, WORKING, 10, of)
        return MixedRun(Determinants(), kernel_run, follow=True)

    once = run_alone(working(Keeper(None, "")).step_through(made, lambda _: None))
    if after < steps:
        with pytest.raises(KeyboardInterrupt):
            run_alone(working(keeper).step_through(made, interrupting))
    rest: list[int] = []
    again = run_alone(working(keeper).step_through(made, rest.append))
    # The step that was told last was not kept.
    assert sum(rest) == (steps - sum(told[:-1]) if after < steps else steps)
    for link in ("trajectory", "factors", "plain", "closed_factors", "closed_form"):
        assert went(only(getattr(again, link))) == went(only(getattr(once, link)))
    assert set(PARTS) < set(QUANTITIES)
