"""The growth law of Λ against runs of random Hamiltonians on random bounded orbits.

What is predicted must differ from what is measured by the proved order of the remainder: over
[0, T] with T fixed, remainder / h^order stays bounded as h is halved, and a law with one thing in
it changed does not do that.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath
import pytest
from hypothesis import assume, event, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import monomial, rationals
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane.growth_law import GrowthLaw, growth_law
from verify.runs.requested_run import run
from verify.scenes.results.run import RunResult
from verify.studies import growth_prediction as growth
from verify.studies.growth_prediction import compute_average, predict_runs

TIME = 6
STEP_SIZES = tuple(Fraction(1, n) for n in (25, 50, 100, 400))
MOST = 2  # by which it may grow; one order less would make it 8 and 6
NOISE = 1e-6
Case = tuple[str, str, Fraction, Fraction]  # H, scheme, q, p
LIE = ("lie1", "lie2", "lie3", "lie4")


@st.composite
def wells(draw: st.DrawFn) -> str:
    """A polynomial with a minimum near 0, in general neither even in p nor a sum T(p) + V(q)."""
    a, b = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    terms = [f"{a}*p**2/2", f"{b}*q**2/2", "(p**2 + q**2)**2/8"]
    degree = st.tuples(st.integers(0, 3), st.integers(0, 3)).filter(lambda e: 2 <= sum(e) <= 4)
    for powers in draw(st.lists(degree, min_size=1, max_size=2, unique=True)):
        terms.append(monomial(draw(rationals(4)) / 8, "pq", powers))
    return " + ".join(terms)


@st.composite
def pendulums(draw: st.DrawFn) -> str:
    """Periodic in q: orbits that swing, and orbits that go round."""
    a, b = draw(st.integers(1, 2)), draw(rationals(3)) / 4
    return f"p**2/2 - {a}*cos(q) + ({b})*sin(2*q) + ({draw(rationals(3)) / 8})*p*sin(q)"


def cases(hamiltonians: st.SearchStrategy[str], most: int) -> st.SearchStrategy[Case]:
    at = st.integers(-most, most).map(lambda n: Fraction(n, 10))
    return st.tuples(hamiltonians, st.sampled_from(LIE), at, at)


@cache
def runs_of(case: Case) -> list[RunResult]:
    """One for each step size: the same whatever law they are held against."""
    formula, scheme, q, p = case
    hamiltonian = Hamiltonian.parse(formula)
    return [
        run(hamiltonian, scheme, q=q, p=p, step_size=h, steps=int(TIME / h), arithmetic="mpfr",
            digits=30, observables=("lambda",))
        for h in STEP_SIZES
    ]  # fmt: skip


def remainders(case: Case) -> list[float] | None:
    """(measured − predicted log(1 + Λ)) / h^order for each step size; None: no closed orbit."""
    formula, scheme, q, p = case
    hamiltonian = Hamiltonian.parse(formula)
    mean = compute_average(hamiltonian, scheme, q=q, p=p, digits=15)
    if mean.average is None:
        return None
    runs = runs_of(case)
    if any(each.status != "finished" for each in runs):
        return None
    found = predict_runs(hamiltonian, mean, runs)
    with mpmath.workdps(40):
        gaps = []
        for h, each in zip(STEP_SIZES, found, strict=True):
            sums = mpmath.mpf(each.boundary.value) + mpmath.mpf(each.secular.value)
            gap = mpmath.log1p(mpmath.mpf(each.measured.value)) - sums
            gaps.append(float(gap / mpmath.mpf(float(h)) ** (mean.power + 1)))
    return gaps


def stays_bounded(gaps: list[float]) -> bool:
    """Whether remainder / h^order has a limit: it stays bounded, or its differences shrink.

    One order less makes that 8 and 6 times as large; either may be small by accident.
    """
    first, second, third, last = gaps
    bounded = abs(last) <= MOST * max(abs(first), abs(second)) + NOISE
    change = max(abs(second - first), abs(third - second))
    return bounded or abs(last - third) <= MOST * change + NOISE


def hold(case: Case) -> None:
    gaps = remainders(case)
    assume(gaps is not None)
    assert gaps is not None
    event(case[1])
    assert stays_bounded(gaps), (case, gaps)


@pytest.mark.left_to_ci
@drawn(20)
@given(case=cases(wells(), 8))
def test_in_a_random_well_the_remainder_has_the_proved_order(case: Case) -> None:
    hold(case)


@pytest.mark.left_to_ci
@drawn(12)
@given(case=cases(pendulums(), 20))
def test_swinging_or_going_round_the_remainder_has_the_proved_order(case: Case) -> None:
    hold(case)


# -- controls -------------------------------------------------------------------------------------

SKEW = "p**2/2 + q**2/2 + q**3/5 + p*q**2/4 + p**4/8"
CONTROL: dict[str, Case] = {
    "lie1": (SKEW, "lie1", Fraction(1, 2), Fraction(3, 10)),
    "lie2": (SKEW, "lie2", Fraction(1, 2), Fraction(3, 10)),
    "lie3": (SKEW, "lie3", Fraction(1, 2), Fraction(3, 10)),
    "lie4": (SKEW, "lie4", Fraction(1, 2), Fraction(3, 10)),
    "round": ("p**2/2 - cos(q) + p*sin(q)/3", "lie2", Fraction(1), Fraction(2)),
}


def scaled(element: tuple[Any, Any] | None, factor: Fraction) -> tuple[Any, Any]:
    assert element is not None
    ring, x = element
    return ring, x * factor.numerator / factor.denominator


def times(name: str, factor: Fraction) -> Callable[[GrowthLaw], GrowthLaw]:
    return lambda law: replace(law, **{name: scaled(getattr(law, name), factor)})


WRONG: dict[str, Callable[[GrowthLaw], GrowthLaw]] = {
    "G-with-the-wrong-sign": times("potential", Fraction(-1)),
    "G-too-great": times("potential", Fraction(101, 100)),
    "without-G": times("potential", Fraction(0)),
    "without-half-X-G": times("leading", Fraction(0)),
    "X-G-for-half-X-G": times("leading", Fraction(2)),
    "g-too-great": times("g", Fraction(11, 10)),
    "g-with-the-wrong-sign": times("g", Fraction(-1)),
}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("case", CONTROL.values(), ids=CONTROL)
def test_the_controls_law_itself_holds(case: Case) -> None:
    gaps = remainders(case)
    assert gaps is not None
    assert stays_bounded(gaps), gaps


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["lie2", "lie4", "round"])
@pytest.mark.parametrize("change", WRONG.values(), ids=WRONG)
def test_a_law_with_one_thing_changed_is_caught(
    monkeypatch: pytest.MonkeyPatch, name: str, change: Callable[[GrowthLaw], GrowthLaw]
) -> None:
    caught(monkeypatch, name, change)


@pytest.mark.parametrize("name", ["lie1", "lie3"])
@pytest.mark.parametrize("wrong", ["g-too-great", "g-with-the-wrong-sign"])
def test_a_law_without_potential_with_g_changed_is_caught(
    monkeypatch: pytest.MonkeyPatch, name: str, wrong: str
) -> None:
    caught(monkeypatch, name, WRONG[wrong])


@pytest.mark.parametrize(("name", "other"), [("lie2", "lie4"), ("lie4", "lie2"), ("lie1", "lie3")])
def test_the_law_of_another_order_is_caught(
    monkeypatch: pytest.MonkeyPatch, name: str, other: str
) -> None:
    law = growth_law(Hamiltonian.parse(SKEW), other)
    caught(monkeypatch, name, lambda own: replace(law, power=own.power))


def caught(
    monkeypatch: pytest.MonkeyPatch, name: str, change: Callable[[GrowthLaw], GrowthLaw]
) -> None:
    def changed(hamiltonian: Hamiltonian, scheme: str) -> GrowthLaw:
        return change(growth_law(hamiltonian, scheme))

    monkeypatch.setattr(growth, "growth_law", changed)
    gaps = remainders(CONTROL[name])
    assert gaps is not None
    assert not stays_bounded(gaps), gaps


# -- long times -----------------------------------------------------------------------------------


def relative(result: RunResult, hamiltonian: Hamiltonian) -> float:
    mean = compute_average(hamiltonian, result.scheme, q=result.q, p=result.p, digits=15)
    (found,) = predict_runs(hamiltonian, mean, [result])
    assert found.difference is not None
    return abs(float(found.difference.value))


@pytest.mark.parametrize(
    "steps", [2000, 20_000, pytest.param(100_000, marks=pytest.mark.left_to_ci)]
)
@pytest.mark.parametrize("q", ["0.5", "1.5"])
def test_over_long_times_the_relative_difference_is_of_order_h(q: str, steps: int) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 - cos(q)")
    result = run(hamiltonian, "lie2", q=q, p=0, step_size="0.01", steps=steps)
    assert relative(result, hamiltonian) < 0.01


def test_it_matters_where_the_run_ended() -> None:
    """At T = 2000 the phase is off; the boundary part is taken at the run's own end."""
    hamiltonian = Hamiltonian.parse("p**2/2 - cos(q)")
    result = run(hamiltonian, "lie2", q="1.5", p=0, step_size="0.04", steps=50_000)
    elsewhere = {**result.values, "q": result.values["p"], "p": result.values["q"]}
    wrong = result.model_copy(update={"values": elsewhere})
    assert relative(result, hamiltonian) < 0.01 < 0.05 < relative(wrong, hamiltonian)
