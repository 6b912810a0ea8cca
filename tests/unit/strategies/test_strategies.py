"""Hamiltonians that are drawn are what was asked for; what is drawn is the same again."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import strategies as st

from tests.helpers.sampled.drawing import fuzzed, shrunk
from verify import Hamiltonian
from verify import strategies as s
from verify.algebra.formula import symbol
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.flow_recognition import uncouple

P, Q = symbol("p"), symbol("q")
KINDS = ("polynomial", "trigonometric", "exponential", "rational")
every_kind = pytest.mark.parametrize("kind", KINDS)
POINTS = [(("0.3", "-0.8", "1.2"), ("0.7", "0.4", "-0.5")),
          (("-1.1", "0.6", "0.9"), ("0.2", "-1.3", "0.8"))]  # fmt: skip


def mixed(h: Hamiltonian) -> bool:
    """Whether H has both some p and some q in a term: a ∂²H/∂p∂q is not zero at a point."""
    n, variables = h.degrees, [symbol(name) for name in h.coordinates]
    slopes = (h.exact.diff(p).diff(q) for p, q in product(variables[:n], variables[n:]))
    functions = [function_of(slope, variables) for slope in slopes]
    return any(abs(f(*p[:n], *q[:n])) > 1e-40 for f, (p, q) in product(functions, POINTS))


def function_of(
    expression: sympy.Expr, variables: Sequence[sympy.Symbol] = (P, Q)
) -> Callable[..., Any]:
    """The expression in numbers of 60 digits."""
    function = sympy.lambdify(variables, expression, "mpmath")

    def value(*point: Any) -> Any:
        with mpmath.workdps(60):
            return function(*map(mpmath.mpf, point))

    return value


@pytest.mark.parametrize("degrees", [1, 2, 3])
def test_what_is_drawn_is_of_so_many_degrees_and_reads_back(degrees: int) -> None:
    for h in fuzzed(s.hamiltonians(degrees=degrees, terms=2), 20):
        assert h.degrees == degrees
        assert Hamiltonian.parse(h.formula, dict(h.values)) == h


# -- kinds ------------------------------------------------------------------------------------


def kind_of(expression: sympy.Expr) -> str:
    """By sympy's own eyes, which is not how they are made."""
    if expression.is_polynomial(P, Q):
        return "polynomial"
    if expression.is_rational_function(P, Q):
        return "rational"
    return "trigonometric" if expression.has(sympy.sin, sympy.cos) else "exponential"


@pytest.mark.sample(3)
@every_kind
def test_a_kind_is_what_it_says(kind: str) -> None:
    for h in fuzzed(s.hamiltonians([kind]), 30):
        assert kind_of(h.exact) == kind, h
        assert h.exact.free_symbols <= {P, Q}
        assert h.exact.free_symbols, f"{h} is constant"
        assert not h.parameters


SORTS: dict[str, tuple[dict[str, Any], int]] = {
    **{kind: ({"kinds": [kind]}, 15) for kind in KINDS},
    "two degrees": ({"degrees": 2, "terms": 2}, 10),
    "three degrees": ({"degrees": 3, "terms": 2}, 10),
}


@pytest.mark.sample(7)
@pytest.mark.parametrize(("sort", "count"), SORTS.values(), ids=SORTS)
@pytest.mark.parametrize("separable", [True, False])
def test_the_ring_finds_separable_what_was_asked_to_be(
    sort: dict[str, Any], count: int, separable: bool
) -> None:
    for h in fuzzed(s.hamiltonians(**sort, separable=separable), count):
        field, _ = canonical_field(h)
        assert field.separable is separable, h
        assert mixed(h) is not separable, h  # without the ring


def test_both_are_drawn_where_it_is_not_said() -> None:
    drawn = [canonical_field(h)[0].separable for h in fuzzed(s.hamiltonians(), 100)]
    assert 20 <= drawn.count(True) <= 80


def test_coupled_and_not_is_what_was_asked_for() -> None:
    for h in fuzzed(s.hamiltonians(degrees=2, terms=2, coupled=True), 10):
        assert len(uncouple(h)) == 1, h
    for h in fuzzed(s.hamiltonians(degrees=3, terms=2, coupled=False), 10):
        assert len(uncouple(h)) == 3, h
    either = [len(uncouple(h)) for h in fuzzed(s.hamiltonians(degrees=2, terms=2), 40)]
    assert 8 < either.count(1) < 36


def test_no_denominator_vanishes_on_the_real_plane() -> None:
    for h in fuzzed(s.hamiltonians(["rational"]), 35):
        denominator = sympy.fraction(sympy.together(h.exact))[1]
        for factor, _ in sympy.factor_list(denominator)[1]:
            form = sympy.Poly(factor, P, Q)
            # A square plus a positive number: its least value is at the one critical point, or
            # along the line through it.
            assert form.total_degree() == 2
            hessian = sympy.hessian(factor, (P, Q))
            assert hessian.is_positive_semidefinite
            assert all(factor.diff(x).subs({P: 0, Q: 0}) == 0 for x in (P, Q))
            assert factor.subs({P: 0, Q: 0}) > 0


def test_limits_hold() -> None:
    for h in fuzzed(s.hamiltonians(["polynomial"], degree=3, terms=2, size=5, separable=True), 150):
        form = sympy.Poly(h.exact, P, Q)
        assert form.total_degree() <= 3
        assert len(form.terms()) <= 2
        assert all(max(abs(c.p), c.q) <= 5 for c in form.coeffs())


# -- bounded ----------------------------------------------------------------------------------


ANGLES = [2 * mpmath.pi * k / 36 for k in range(36)]
CIRCLE = [(mpmath.cos(a), mpmath.sin(a)) for a in ANGLES]
# Along the axes and the diagonals, of which couplings are made.
RAYS = [(1, 0, 0, 0), (0, 0, 0, -1), (0, 0, 1, 1), (0, 0, 1, -1), (1, -1, 0, 0), (1, 1, 1, 1)]
DIRECTIONS: dict[str, tuple[dict[str, Any], list[Any]]] = {
    **{kind: ({"kinds": [kind]}, CIRCLE) for kind in KINDS},
    "two degrees": ({"degrees": 2, "terms": 3}, RAYS),
}


def grows_tenfold(h: Hamiltonian, rays: Sequence[Any]) -> bool:
    """Whether H is positive at 10³ along each ray, and more than ten times that at 10⁴."""
    value = function_of(h.exact, [symbol(name) for name in h.coordinates])
    ends = [[value(*(r * x for x in ray)) for r in (10**3, 10**4)] for ray in rays]
    return all(0 < 10 * near < far for near, far in ends)


@pytest.mark.sample(4)
@pytest.mark.parametrize(("sort", "rays"), DIRECTIONS.values(), ids=DIRECTIONS)
def test_bounded_grows_in_every_direction(sort: dict[str, Any], rays: list[Any]) -> None:
    for h in fuzzed(s.hamiltonians(**sort, bounded=True), 10):
        assert grows_tenfold(h, rays), h


def grows_along(h: sympy.Expr, ray: tuple[int, int]) -> bool:
    """Whether H grows without bound along the ray, as far as two points far out tell."""
    value = function_of(h)
    near, far = (value(ray[0] * r, ray[1] * r) for r in (10**3, 10**5))
    return bool(far > near + 10)


@every_kind
def test_not_bounded_does_not_grow_along_some_ray(kind: str) -> None:
    lines = [(-k, 1) for k in range(-3, 4) if k] + [(k, -1) for k in range(-3, 4) if k]
    rays = [(1, 0), (-1, 0), (0, 1), (0, -1), *lines]
    for h in fuzzed(s.hamiltonians([kind], bounded=False), 12):
        # p + kq = const, where a parabolic form is constant, with a linear term in one direction
        assert not all(grows_along(h.exact, ray) for ray in rays), h


def test_what_tells_growth_tells_the_two_apart() -> None:
    """Controls of the checks above: a pendulum among the bounded, a quartic among the others."""
    pendulum, quartic = (Hamiltonian.parse(f"p**2/2 + {v}") for v in ("cos(q)", "q**4"))
    assert not grows_tenfold(pendulum, CIRCLE)
    assert not grows_along(pendulum.exact, (0, 1))
    assert all(grows_along(quartic.exact, ray) for ray in ((1, 0), (0, -1), (1, 1), (-3, 1)))


def test_quadratic_forms_of_each_sort_occur() -> None:
    found = {"elliptic": 0, "hyperbolic": 0, "parabolic": 0}
    for h in fuzzed(s.hamiltonians(), 200):
        if h.exact.is_polynomial() and sympy.Poly(h.exact, P, Q).total_degree() == 2:
            sign = sympy.sign(sympy.hessian(h.exact, (P, Q)).det())
            found[{1: "elliptic", -1: "hyperbolic", 0: "parabolic"}[int(sign)]] += 1
    assert min(found.values()) >= 6, found


# -- parameters -------------------------------------------------------------------------------


IN_TIME = {"terms": 2, "time_dependent": True}


@pytest.mark.parametrize(
    ("sort", "count"),
    [({}, 100), ({"degrees": 2, **IN_TIME}, 8), ({"degrees": 3, **IN_TIME}, 8)],
    ids=["plane", "two degrees in time", "three degrees in time"],
)
def test_parameters_have_values_and_none_is_left(sort: dict[str, Any], count: int) -> None:
    for h in fuzzed(s.hamiltonians(**sort, with_parameters=True), count):
        assert h.time_dependent is bool(sort.get("time_dependent"))
        assert h.parameters
        assert not h.symbols
        assert set(h.parameters) <= {"a", "b"}


def test_parameters_are_drawn_for_names_and_for_a_hamiltonian() -> None:
    h = Hamiltonian.parse("p**2/2 + delta*q**4 + a*q")
    for drawn in (s.parameters(h), s.parameters(["a", "delta"])):
        for values in fuzzed(drawn, 50):
            assert set(values) == {"a", "delta"}
            assert all(type(x) is Fraction and 0 < abs(x) <= 9 for x in values.values())
            assert not h.with_values(values).symbols
    assert shrunk(s.parameters(["a"])) == {"a": Fraction(1)}


# -- how it is drawn --------------------------------------------------------------------------


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "strategy",
    [s.scenes(), s.hamiltonians(with_parameters=True), s.initial_values(extreme=True)],
    ids=["scenes", "hamiltonians", "extreme"],
)
def test_random_bytes_are_taken_and_give_the_same_again(strategy: st.SearchStrategy[Any]) -> None:
    first = fuzzed(strategy, 80, seed=7)
    assert len(first) >= 76
    assert first[:20] == fuzzed(strategy, 20, seed=7)[:20]
    assert first[:20] != fuzzed(strategy, 20, seed=8)[:20]
