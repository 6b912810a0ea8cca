"""What is drawn is what was asked for, and its shrunk form can be read."""

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import Phase, find, given, settings
from hypothesis import strategies as st

from verify import Hamiltonian, InputError, Scene, Scheme
from verify import schemes as catalogue
from verify import strategies as s
from verify.algebra.formula import symbol
from verify.scenes.values import InitialValue

P, Q = symbol("p"), symbol("q")
KINDS = ("polynomial", "trigonometric", "exponential", "rational")
every_kind = pytest.mark.parametrize("kind", KINDS)
_QUIET = settings(database=None, deadline=None)


def fuzzed(strategy: st.SearchStrategy[Any], count: int, seed: int = 0) -> list[Any]:
    """What `count` strings of random bytes give; fewer where some are not taken."""
    found: list[Any] = []

    @_QUIET
    @given(strategy)
    def test(drawn: Any) -> None:
        found.append(drawn)

    source = random.Random(seed)  # noqa: S311 - the same ones each time
    for _ in range(count):
        test.hypothesis.fuzz_one_input(source.randbytes(4096))
    return found


def shrunk(strategy: st.SearchStrategy[Any], holds: Callable[[Any], bool] = lambda _: True) -> Any:
    # What else fails is not asked for: to explain it takes four times as long as to find it.
    phases = (Phase.generate, Phase.shrink)
    own = settings(_QUIET, max_examples=2000, derandomize=True, phases=phases)
    return find(strategy, holds, settings=own)


def mixed(expression: sympy.Expr) -> bool:
    """Whether H_pq is not zero at some point, by mpmath."""
    h_pq = function_of(expression.diff(P).diff(Q))
    return any(abs(h_pq(*point)) > 1e-40 for point in (("0.3", "0.7"), ("-1.1", "0.2")))


def function_of(expression: sympy.Expr) -> Callable[[Any, Any], Any]:
    """The expression in numbers of 60 digits."""
    function = sympy.lambdify((P, Q), expression, "mpmath")

    def value(p: Any, q: Any) -> Any:
        with mpmath.workdps(60):
            return function(mpmath.mpf(p), mpmath.mpf(q))

    return value


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


@pytest.mark.sample(3)
@every_kind
@pytest.mark.parametrize("separable", [True, False])
def test_the_ring_finds_separable_what_was_asked_to_be(kind: str, separable: bool) -> None:
    for h in fuzzed(s.hamiltonians([kind], separable=separable), 15):
        field, _ = h.field()
        assert field.separable() is separable, h
        assert mixed(h.exact) is not separable, h  # without the ring


def test_both_are_drawn_where_it_is_not_said() -> None:
    drawn = [h.field()[0].separable() for h in fuzzed(s.hamiltonians(), 100)]
    assert 20 <= drawn.count(True) <= 80


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


def least_on_circle(value: Callable[[Any, Any], Any], radius: int) -> Any:
    angles = [2 * mpmath.pi * k / 36 for k in range(36)]
    return min(value(radius * mpmath.cos(a), radius * mpmath.sin(a)) for a in angles)


@pytest.mark.sample(3)
@every_kind
def test_bounded_grows_in_every_direction(kind: str) -> None:
    for h in fuzzed(s.hamiltonians([kind], bounded=True), 10):
        near, far = (least_on_circle(function_of(h.exact), r) for r in (10**3, 10**4))
        assert 0 < 10 * near < far, h


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
    pendulum, quartic = (Hamiltonian.parse(f"p**2/2 + {v}").exact for v in ("cos(q)", "q**4"))
    near, far = (least_on_circle(function_of(pendulum), r) for r in (10**3, 10**4))
    assert not 0 < 10 * near < far
    assert not grows_along(pendulum, (0, 1))
    assert all(grows_along(quartic, ray) for ray in ((1, 0), (0, -1), (1, 1), (-3, 1)))


def test_quadratic_forms_of_each_sort_occur() -> None:
    found = {"elliptic": 0, "hyperbolic": 0, "parabolic": 0}
    for h in fuzzed(s.hamiltonians(), 200):
        if h.exact.is_polynomial() and sympy.Poly(h.exact, P, Q).total_degree() == 2:
            sign = sympy.sign(sympy.hessian(h.exact, (P, Q)).det())
            found[{1: "elliptic", -1: "hyperbolic", 0: "parabolic"}[int(sign)]] += 1
    assert min(found.values()) >= 6, found


# -- parameters -------------------------------------------------------------------------------


def test_parameters_have_values_and_none_is_left() -> None:
    for h in fuzzed(s.hamiltonians(with_parameters=True), 100):
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


# -- numbers ----------------------------------------------------------------------------------


def test_initial_values_are_exact_and_within_reach() -> None:
    drawn = fuzzed(s.initial_values(most="3/2"), 200)
    numbers = [x for value in drawn for x in (value.q, value.p)]
    assert all(type(x) is Fraction and abs(x) <= Fraction(3, 2) for x in numbers)
    assert any(x < 0 for x in numbers)
    assert any(x.denominator == 3 for x in numbers), "one that no float holds"
    assert all(abs(x.q) <= Fraction(1, 10**9) for x in fuzzed(s.initial_values(most="1e-9"), 20))


def test_extreme_initial_values_are_so() -> None:
    numbers = [x for value in fuzzed(s.initial_values(extreme=True), 400)
               for x in (value.q, value.p)]  # fmt: skip
    assert any(0 < abs(x) < Fraction(1, 10**200) for x in numbers)
    assert any(abs(x) > 10**200 for x in numbers)
    assert 0 in numbers
    assert any(0 < abs(x - round(x)) < Fraction(1, 10**50) and round(x) for x in numbers)
    assert any(x.denominator > 10**30 and abs(x) <= 2 for x in numbers)


@pytest.mark.parametrize(
    ("least", "most"),
    [("1/1000", "1/10"), ("1e-300", "1e300"), ("0.02", "0.05"), ("1/7", "1/7"), (2, 3)],
)
def test_step_sizes_keep_to_their_ends(least: Any, most: Any) -> None:
    drawn = fuzzed(s.step_sizes(least=least, most=most), 200)
    assert len(drawn) == 200
    assert all(type(h) is Fraction and Fraction(least) <= h <= Fraction(most) for h in drawn)


def test_step_sizes_have_several_forms() -> None:
    denominators = {h.denominator for h in fuzzed(s.step_sizes(), 200)}
    assert 100 in denominators
    assert 128 in denominators
    assert any(d % 3 == 0 for d in denominators)


# -- schemes ----------------------------------------------------------------------------------

TWISTED = Hamiltonian.parse("p**2/2 + q**2/2 + p*q**2")


def names(strategy: st.SearchStrategy[Scheme]) -> set[str]:
    return {scheme.name for scheme in fuzzed(strategy, 400)}


def test_every_scheme_is_drawn_and_lie_more_often() -> None:
    drawn = [scheme.name for scheme in fuzzed(s.schemes(), 900)]
    assert set(drawn) == set(catalogue.names())
    assert drawn.count("lie2") > 1.5 * drawn.count("rk4")


def test_schemes_are_those_that_take_the_hamiltonian() -> None:
    taken = set()
    for name in catalogue.names():
        try:
            catalogue.get(name).step_map(TWISTED)
        except InputError:
            continue
        taken.add(name)
    assert names(s.schemes(hamiltonian=TWISTED)) == taken
    assert taken < set(catalogue.names())


def test_what_only_looks_mixed_is_seen_to_be_separable() -> None:
    square = Hamiltonian.parse("(p + q)**2/2 - p*q")
    assert "stormer-verlet" in names(s.schemes(hamiltonian=square))


def test_schemes_by_what_they_claim() -> None:
    found = [catalogue.get(name) for name in catalogue.names()]
    drawn = names(s.schemes(order=4, explicit=True, symmetric=True, area_preserving=True))
    of_order_4 = [x for x in found if x.order == 4 and x.explicit and x.symmetric]
    assert drawn == {x.name for x in of_order_4 if x.area_preserving}
    assert drawn
    assert names(s.schemes(names=["lie7", "kick 1; drift 1"])) == {"lie7", "kick 1; drift 1"}
    own = "p_next = p - h*a*q; q_next = q + h*p_next"
    assert names(s.schemes(names=["lie2", own], hamiltonian=TWISTED)) == {"lie2"}


# -- scenes -----------------------------------------------------------------------------------


def valid(scene: Scene) -> Scene:
    """The same, looked at as one that is read from a file."""
    return Scene.model_validate(scene.model_dump(exclude_defaults=True))


def test_scenes_are_valid() -> None:
    drawn = fuzzed(s.scenes(steps=(3, 5)), 40)
    for scene in drawn:
        assert valid(scene) == scene
        assert scene.exact_hamiltonian().symbols == ()
        assert scene.grid is not None
        assert scene.grid.steps in (3, 4, 5)
        assert len(scene.schemes) == len(scene.grid.step_sizes) == 1
    assert any(scene.parameters for scene in drawn)


def test_scenes_of_given_parts_have_them_and_are_valid() -> None:
    verlet = s.schemes(names=["stormer-verlet"])
    duffing = st.just(Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4"))
    both = s.scenes(hamiltonians=s.hamiltonians(separable=True), schemes=verlet)
    for strategy in (s.scenes(schemes=verlet), s.scenes(hamiltonians=duffing), both):
        drawn = fuzzed(strategy, 15)
        assert len(drawn) == 15
        assert all(valid(scene) == scene for scene in drawn)
    own = s.schemes(names=["p_next = p - h*q; q_next = q + h*p_next"])
    starts = st.just(InitialValue(q=1, p=0))
    drawn = fuzzed(s.scenes(schemes=own, initial_values=starts, step_sizes=st.just("1/8")), 8)
    assert {(x.grid.initial_values, x.grid.step_sizes) for x in drawn} == {
        ((InitialValue(q=1, p=0),), (Fraction(1, 8),))
    }
    with_values = fuzzed(s.scenes(hamiltonians=duffing), 5)
    assert all(set(scene.parameters) == {"delta"} for scene in with_values)


def test_scenes_in_time_are_valid_and_begin_at_drawn_times() -> None:
    own = s.scenes(hamiltonians=s.hamiltonians(time_dependent=True), initial_times=st.just("1/3"))
    lies = s.scenes(schemes=s.schemes(names=["lie2", "ruth3"]), time_dependent=True)
    for strategy in (s.scenes(time_dependent=True), lies, own):
        drawn = fuzzed(strategy, 12)
        assert len(drawn) >= 11
        assert all(valid(scene) == scene for scene in drawn)
        assert all(scene.exact_hamiltonian().time_dependent for scene in drawn)
        assert len({scene.t0 for scene in drawn}) > 5 or {scene.t0 for scene in drawn} == {
            Fraction(1, 3)
        }


def test_a_scene_without_t_draws_no_time() -> None:
    """So that scene K of seed S is what it was before there were any with t."""
    never = st.nothing()
    assert len(fuzzed(s.scenes(initial_times=never), 40)) == 40
    assert not fuzzed(s.scenes(initial_times=never, time_dependent=True), 40)


def test_what_does_not_fit_is_rejected_not_drawn() -> None:
    verlet = s.schemes(names=["stormer-verlet"])
    assert not fuzzed(s.scenes(hamiltonians=st.just(TWISTED), schemes=verlet), 20)


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


def uses(function: Any) -> Callable[[Hamiltonian], bool]:
    return lambda h: bool(h.exact.has(function))


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("strategy", "holds", "simplest"),
    [
        (s.hamiltonians(), lambda _: True, "p**2/2 + q**2/2"),
        (s.hamiltonians(bounded=False), lambda _: True, "p**2/2 - q**2/2"),
        (s.hamiltonians(separable=False, bounded=False), lambda _: True, "p*q"),
        (s.hamiltonians(degree=1), lambda _: True, "p/2"),
        (s.hamiltonians(["trigonometric"]), lambda _: True, "p**2/2 + cos(q)"),
        (s.hamiltonians(["rational"]), lambda _: True, "p**2/2 + 1/(q**2 + 1)"),
        (s.hamiltonians(), uses(sympy.cos), "p**2/2 + cos(q)"),
        (s.hamiltonians(), lambda h: mixed(h.exact), "p**2/2 + p*q/2 + q**2/2"),
        (s.hamiltonians(["polynomial"]), lambda h: h.exact.diff(Q, 3) != 0, "p**2/2 + q**4/2"),
        (s.hamiltonians(bounded=True), lambda h: h.exact.coeff(P**2) > 3, "4*p**2 + q**2/2"),
    ],
)
def test_a_hamiltonian_shrinks_to_what_can_be_read(
    strategy: st.SearchStrategy[Hamiltonian], holds: Callable[[Any], bool], simplest: str
) -> None:
    assert shrunk(strategy, holds).formula == simplest


def test_a_scene_shrinks_to_the_oscillator_and_one_step() -> None:
    found = shrunk(s.scenes(), lambda x: x.schemes == ("stormer-verlet",) and x.grid.steps > 4)
    assert found.hamiltonian == "p**2/2 + q**2/2"
    assert found.grid.steps == 5
    assert found.grid.step_sizes == (Fraction(1, 10),)
    assert found.grid.initial_values == (InitialValue(q=0, p=0),)
