"""Short runs against the same steps done with sympy's reader and mpmath alone, for any H.

J is taken by differences, W as MᵀΩM − Ω from the product M of all J, in 400 digits; so what the
kernels carry without cancellation is seen from the other side.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
import sympy
from hypothesis import assume, example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import plain, polynomials, rationals, trigonometric
from tests.helpers.stepping.steps_by_differences import (
    State,
    Step,
    columns_of,
    field,
    form_of,
    function_of,
    implicit_midpoint,
    lie,
    mp,
    rk4,
    verlet,
)
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.observables import REPORTED, names
from verify.scenes.results.run import RunResult

DIGITS = 40


@dataclass(frozen=True)
class Case:
    """A run of H by a scheme from z, and the same step in mpmath."""

    text: str
    scheme: str
    step: Callable[[State, Any], State]  # (z, h) ↦ z'
    start: Sequence[Fraction]
    h: Fraction
    steps: int
    digits: int = DIGITS

    @property
    def coordinates(self) -> tuple[str, ...]:
        return Hamiltonian.parse(self.text).coordinates

    def run(self, arithmetic: str, observables: Sequence[str]) -> RunResult:
        n = len(self.start) // 2
        p, q = self.start[:n], self.start[n:]
        point: dict[str, Any] = {"p": p, "q": q} if n > 1 else {"p": p[0], "q": q[0]}
        return run(Hamiltonian.parse(self.text), self.scheme, **point, step_size=self.h,
                   steps=self.steps, arithmetic=arithmetic, digits=self.digits,
                   observables=observables)  # fmt: skip


def case_of(text: str, scheme: str, step: Step, *rest: Any, **more: Any) -> Case:
    slopes = field(function_of(text, Hamiltonian.parse(text).coordinates))
    return Case(text, scheme, lambda z, h: step(slopes, z, h), *rest, **more)


def number(x: Fraction) -> Any:
    return mp.mpf(x.numerator) / x.denominator


def expected(case: Case) -> dict[str, Any]:
    """Every observable and the last state, to twice the digits and more."""
    energy, size = function_of(case.text, case.coordinates), len(case.start)
    z, h = list(map(number, case.start)), number(case.h)
    first, whole, lam = energy(*z), mp.eye(size), mp.mpf(1)
    changes, products, defects, energies = [], [], [], []
    for _ in range(case.steps):
        columns = columns_of(lambda y: case.step(y, h), z)
        jacobian = mp.matrix(columns).T
        whole, change = jacobian * whole, mp.det(jacobian) - 1
        lam, z = lam * (1 + change), case.step(z, h)
        changes.append(change)
        products.append(abs(lam - 1))
        defects += map(abs, form_of(columns).values())
        energies.append(energy(*z) - first)
    total = form_of(whole.T.tolist()).values()
    return dict(zip(case.coordinates, z, strict=True)) | {
        "lambda": lam - 1, "lambda_plain": lam - 1, "lambda_max": max(products),
        "mse": sum(x**2 for x in changes) / case.steps, "delta_j_max": max(map(abs, changes)),
        "symplectic_defect_max": max(defects), "symplectic_defect": max(map(abs, total)),
        "energy_error": energies[-1], "energy_error_max": max(map(abs, energies)),
    }  # fmt: skip


def assert_true(
    result: RunResult, true: dict[str, Any], case: Case, observables: Sequence[str]
) -> None:
    assert result.status == "finished"
    assert set(result.values) == {*case.coordinates, *observables}
    for name, value in result.values.items():
        x, bound = true[name], number(Fraction(value.bound))
        size = abs(x)
        tiny = mp.mpf(10) ** (-2 * case.digits) * (1 + size)
        assert abs(number(Fraction(value.value)) - x) <= bound + tiny, name
        if result.arithmetic != "float64":
            scale = max(1, size) if name == "lambda_plain" else size
            assert bound <= mp.mpf(10) ** (5 - case.digits) * scale, name


# -- any H that is drawn --------------------------------------------------------------------------

starts = st.tuples(rationals(5), rationals(5), st.sampled_from([Fraction(1, 7), Fraction(3, 100)]))


@drawn(30)
@given(text=polynomials(degree=4), eta=st.sampled_from([1, 2, 3]), at=starts)
def test_a_polynomial_h_is_stepped_as_mpmath_steps_it(
    text: str, eta: int, at: tuple[Fraction, Fraction, Fraction]
) -> None:
    assert_stepped(text, eta, at, 10**6)


@drawn(20)
@example(  # ΔJ ≡ 0, and its product is 1 but for rounding
    text="(-1/3)*q**1 + (1)*cos((2)*p + (2)*q)", eta=2,
    at=(Fraction(-1), Fraction(-3, 2), Fraction(1, 7)),
)  # fmt: skip
@given(text=trigonometric(), eta=st.sampled_from([1, 2]), at=starts)
def test_a_trigonometric_h_is_stepped_as_mpmath_steps_it(
    text: str, eta: int, at: tuple[Fraction, Fraction, Fraction]
) -> None:
    assert_stepped(text, eta, at, 10**4)


def assert_stepped(text: str, eta: int, at: tuple[Fraction, Fraction, Fraction], most: int) -> None:
    case = case_of(text, f"lie{eta}", lie(eta), at[:2], at[2], 2)
    true = expected(case)
    assume(max(abs(true["p"]), abs(true["q"])) < most)
    assert_true(case.run("mpmath", REPORTED), true, case, REPORTED)


# -- every function, maps of one's own, n degrees of freedom --------------------------------------

FORMULAS = {
    "exp": "p**2/2 + exp(-q**2) + q*p/9",
    "hyperbolic": "cosh(p)/3 + sinh(q) + tanh(p*q)",
    "root": "sqrt(1 + p**2) + q**2*(q + 9)**(1/3)",
    "log": "p**2/2 + log(1 + q**2) + atan(p - q)",
    "tan": "p**2/2 + tan(q/3) + pi*q**2",
    "inverse": "p**2/(2 + q**2) + q**4/(1 + p**2)",
}
MAPS = {
    "h-inside": "p_next = p*cos(h) - q*sin(h) + h**3*p**2; q_next = q*cos(h) + p*sin(h)",
    "implicit-like": "p_next = (p - h*sin(q))/(1 + h**2*p**2); q_next = q + h*p_next",
    "decaying": "p_next = exp(-h**2)*p - h*q; q_next = q + h*p/sqrt(1 + h**2)",
}
IN_PLANE = (Fraction(2, 7), Fraction(3, 5)), Fraction(1, 9), 5
POINT = [Fraction(n, d) for n, d in ((3, 7), (-2, 5), (1, 8), (4, 9), (-7, 11), (1, 3))]
HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
MIXED = "(p1*q2 + p2)**2/2 + q1*q2*exp(p1/2) + q1**2"
ARC = "(p1**2 + p2**2)/2 - 1/sqrt((q1 + 2)**2 + q2**2)"
CHAIN = "(p1**2 + p2**2 + p3**2)/2 - cos(q1 - q2) - cos(q2 - q3)*q1"
SEVERAL: dict[str, tuple[str, str, Step]] = {
    "henon-lie1": (HENON, "lie1", lie(1)),
    "henon-lie2": (HENON, "lie2", lie(2)),
    "mixed-lie2": (MIXED, "lie2", lie(2)),
    "arc-lie2": (ARC, "lie2", lie(2)),
    "henon-rk4": (HENON, "rk4", rk4),
    "chain-lie1": (CHAIN, "lie1", lie(1)),
    "henon-verlet": (HENON, "stormer-verlet", verlet),
    "mixed-midpoint": (MIXED, "implicit-midpoint", implicit_midpoint),
}


def of_map(text: str) -> Case:
    formulas = dict(part.strip().split(" = ") for part in text.split(";"))
    p_next = plain(formulas["p_next"])
    q_next = plain(formulas["q_next"]).subs(sympy.Symbol("p_next"), p_next)
    p, q = (function_of(x, ("p", "q", "h")) for x in (p_next, q_next))
    return Case("p**2/2 + q**2/2", text, lambda z, h: [p(*z, h), q(*z, h)], *IN_PLANE)


def several(text: str, scheme: str, step: Step) -> Case:
    start = POINT[: len(Hamiltonian.parse(text).coordinates)]
    return case_of(text, scheme, step, start, Fraction(1, 20), 5, digits=25)


CASES = {
    **{name: case_of(text, "lie2", lie(2), *IN_PLANE) for name, text in FORMULAS.items()},
    **{name: of_map(text) for name, text in MAPS.items()},
    **{name: several(*each) for name, each in SEVERAL.items()},
}
PLANE, EVERY = ("float64", "mpmath"), ("float64", "mpfr", "mpmath", "ball", "fixed")
IN_CI = [pytest.mark.left_to_ci, pytest.mark.sample(4)]
RUNS = [
    *((PLANE, name, [pytest.mark.sample(2)]) for name in FORMULAS),
    *((PLANE, name, []) for name in MAPS),
    *((EVERY, name, IN_CI) for name in SEVERAL),
]


@cache
def true_values(name: str) -> dict[str, Any]:
    return expected(CASES[name])


@pytest.mark.parametrize(
    ("arithmetic", "name"),
    [
        pytest.param(system, name, marks=marks, id=f"{system}-{name}")
        for systems, name, marks in RUNS
        for system in systems
    ],
)
def test_every_value_is_that_of_the_same_steps_by_mpmath(arithmetic: str, name: str) -> None:
    case = CASES[name]
    observables = names(planar=len(case.start) == 2)
    result = case.run(arithmetic, observables)
    assert_true(result, true_values(name), case, observables)
    if arithmetic != "float64":
        printed = {n: x.value for n, x in result.values.items() if Fraction(x.value)}
        lengths = {n: len(text.strip("-").partition("e")[0]) for n, text in printed.items()}
        assert min(lengths.values()) >= case.digits - 5, lengths
    if arithmetic in ("mpfr", "fixed") and case.scheme != "implicit-midpoint":
        assert result.error_kind == "enclosed"
        assert "a-posteriori" in result.error_method


@pytest.mark.parametrize("scheme", ["p_next = p + h*p_next; q_next = q", "p_next = p; p_next = q"])
def test_a_map_that_is_not_explicit_is_an_input_error(scheme: str) -> None:
    with pytest.raises(InputError, match=r"p_next|scheme"):
        run(Hamiltonian.parse("p**2/2"), scheme, q=1, p=0, step_size="0.1", steps=1)


def test_a_product_that_rounds_to_1_is_not_said_to_be_exactly_1() -> None:
    """ΔJ = 3 h² is lost in 1 + ΔJ at 40 digits, and at 55."""
    h = Hamiltonian.parse("p**2/2 + q**4/4")
    found = run(h, "lie1", q="1", p="0", step_size="1e-40", steps=2, arithmetic="mpmath",
                digits=17, observables=["lambda_plain"])  # fmt: skip
    value = found.values["lambda_plain"]
    true = Fraction(6) / 10**80
    assert abs(Fraction(value.value) - true) <= Fraction(value.bound)
    assert Fraction(value.bound) < Fraction(1, 10**20)


def test_a_map_that_preserves_volume_alone_has_a_defect() -> None:
    """p1 is stretched and p2 shrunk: det J = 1, and S has entries of the size of h."""
    scheme = "p1_next = p1*(1 + h); p2_next = p2/(1 + h); q1_next = q1; q2_next = q2"
    result = run(Hamiltonian.parse(HENON), scheme, q=[1, 2], p=[1, 2], step_size="1/10", steps=3,
                 arithmetic="mpfr", digits=20, observables=names(planar=False))  # fmt: skip
    # W is diagonal: (1 + h)³ − 1, and (1 + h)⁻³ − 1.
    assert Fraction(result.values["lambda"].value) == 0
    assert Fraction(result.values["symplectic_defect_max"].value) == Fraction(1, 10)
    defect = Fraction(result.values["symplectic_defect"].value)
    assert abs(defect - Fraction(331, 1000)) < 1e-18
