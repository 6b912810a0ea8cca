"""The exact flow of many points at once, held against `exact_solution` point by point."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from verify.arithmetic.batch import Batch, MixedError, choose, in_groups, some
from verify.arithmetic.float_context import WIDE, FloatContext
from verify.errors import InputError
from verify.flows import extrapolation_of_many as flow_of_many
from verify.flows import points as module
from verify.flows.extrapolation import NoFlowError
from verify.flows.points import Points, exact_points
from verify.flows.solution import exact_solution
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.motion import Motion

ALL = systems.all_systems()
REGIMES = [(name, regime) for name, system in ALL.items() for regime in system.regimes]
TIMES = (Fraction(3, 4), Fraction(-1, 3), Fraction(0))
LONG = (Fraction(50), Fraction(100), Fraction(200))
PENDULUM = "p**2/2 - cos(q)"
SOFT = "p**2/2 + q**2/2 - q**4/4"
HARD = "p**2/2 + q**2/2 + q**4/4"
SEXTIC = "p**2/2 + q**6/6"


def cloud(p: float, q: float, count: int = 12, radius: float = 1 / 32) -> tuple[Any, Any]:
    """The point itself and others about it."""
    rng = np.random.default_rng(3)
    apart = rng.uniform(-radius, radius, (2, count))
    apart[:, 0] = 0
    return p + apart[0], q + apart[1]


def largest_error(h: Hamiltonian, p: Any, q: Any, times: Any, found: Points) -> float:
    """The largest error of all, by `exact_solution` with 25 digits."""
    worst = Fraction(0)
    for k, time in enumerate(times):
        for i, (x, y) in enumerate(zip(p, q, strict=True)):
            true = exact_solution(h, p=Fraction(x), q=Fraction(y), time=time, digits=25)
            worst = max(worst, abs(Fraction(found.p[k, i]) - true.p))
            worst = max(worst, abs(Fraction(found.q[k, i]) - true.q))
    return float(worst)


def size(*arrays: Any) -> float:
    return max(float(np.abs(x).max()) for x in arrays)


# -- every system ---------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "regime"), REGIMES, ids=map("-".join, REGIMES))
def test_a_cloud_about_each_example_is_carried_within_the_bound(name: str, regime: str) -> None:
    values, p0, q0 = ALL[name].regime(regime)
    h = ALL[name].hamiltonian(values)
    p, q = cloud(float(p0), float(q0), 6 if ALL[name].flow else 3)
    found = exact_points(h, p, q, TIMES)
    error = largest_error(h, p, q, TIMES, found)
    assert error <= found.bound
    most = 4e-12 if (name, regime) == ("toda", "wide") else 4e-14  # its modulus is nearly 1
    assert found.bound <= most * max(size(p, q, found.p, found.q), 1 / 32)
    assert found.p.shape == found.q.shape == (len(TIMES), len(p))
    assert np.array_equal(found.p[2], p)


LONG_LIVED = [
    ("pendulum", "libration"), ("pendulum", "rotation"), ("pendulum", "libration-elsewhere"),
    ("duffing", "hard"), ("duffing", "soft-inside"), ("double-well", "left-well"),
    ("double-well", "over-the-barrier"), ("cubic", "well"), ("quartic", "oscillation"),
    ("harmonic", "oscillation"), ("twist", "rotation"), ("morse", "bound"), ("morse", "free"),
    ("toda", "oscillation"), ("parabola", "oscillation"), ("toda-oscillator", "oscillation"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "regime"), LONG_LIVED, ids=map("-".join, LONG_LIVED))
def test_long_times_cost_no_digits_away_from_separatrices(name: str, regime: str) -> None:
    values, p0, q0 = ALL[name].regime(regime)
    h = ALL[name].hamiltonian(values)
    closed = ALL[name].flow is not None
    times = LONG if closed else (Fraction(60),)
    p, q = cloud(float(p0), float(q0), 2)
    found = exact_points(h, p, q, times)
    assert not found.alone
    assert largest_error(h, p, q, times, found) <= found.bound
    assert found.bound <= 1e-12 * size(p, q, found.p, found.q)


# -- mixed batches --------------------------------------------------------------------------------


@pytest.mark.parametrize("formula", [PENDULUM, "p**2/2 + (q**2 - 1)**2/4", HARD])
def test_a_batch_may_go_every_way_at_once(formula: str) -> None:
    """Both sides of a separatrix and near it, on it, at rest and nearly at rest."""
    h = Hamiltonian.parse(formula)
    p = np.array([0.0, 1e-9, 0.0, 2.0, 2 + 1e-13, 2 - 1e-13, 2.5, -3.0, 0.3, 0.0, -0.0, 1e-200])
    q = np.array([0.0, 0.0, 1e-12, 0.0, 0.0, 0.0, 0.5, 1.0, 1.5, 1.0, 3.0, 0.0])
    times = (Fraction(5, 2), Fraction(-20))
    found = exact_points(h, p, q, times)
    assert largest_error(h, p, q, times, found) <= found.bound <= 1e-9


def test_near_rest_the_error_is_small_against_the_orbit() -> None:
    h = Hamiltonian.parse(HARD)
    p, q = cloud(0.0, 0.0, 10, 1e-6)
    found = exact_points(h, p, q, LONG)
    assert largest_error(h, p, q, LONG, found) <= found.bound <= 1e-12 * 1e-6


def test_points_that_float64_cannot_tell_are_found_one_by_one() -> None:
    """On both sides of the pendulum's separatrix, nearer to it than p² is rounded."""
    h = Hamiltonian.parse(PENDULUM)
    edge = 2 * np.cos(0.5)
    p = np.array([1.0, np.nextafter(edge, 3), np.nextafter(edge, 1), edge / 2])
    times = (Fraction(60),)
    found = exact_points(h, p, np.ones(4), times)
    assert found.alone == (1, 2)
    assert found.q[0, 1] > 6 > 3.2 > found.q[0, 2]
    assert largest_error(h, p, np.ones(4), times, found) <= found.bound <= 1e-12


# -- where there is no answer ---------------------------------------------------------------------


@pytest.mark.parametrize("formula", [SOFT, "p**2/2 + q**2/2 - q**3/3", "-p**2/2 - q**2/2 + q**4/4"])
def test_a_point_that_blows_up_is_named(formula: str) -> None:
    h = Hamiltonian.parse(formula)
    p, q = np.array([0.0, 0.3, 0.0, 0.2]), np.array([0.1, 0.3, 1.5, -0.2])
    with pytest.raises(NoFlowError, match=r"^point 2, q = 1\.5, .* blows up at t = "):
        exact_points(h, p, q, (Fraction(1), Fraction(30)))
    with pytest.raises(NoFlowError, match=r"^point 2, q = 1\.5, .* blows up at t = −"):
        exact_points(h, p, q, (Fraction(-30),))
    early = (Fraction(1), Fraction(-1))
    found = exact_points(h, p, q, early)
    assert largest_error(h, p, q, early, found) <= found.bound <= 1e-13


@pytest.mark.parametrize(
    "formula", [SOFT, "p**2/2 + q**2/2 - q**3/3", "3*p**2 + q - q**3/3 - q**4"]
)
def test_the_same_points_blow_up_as_by_exact_algebra(formula: str) -> None:
    h = Hamiltonian.parse(formula)
    time = Fraction(2)
    p, q = cloud(0.2, 0.3, 25, 2.0)
    for x, y in zip(p, q, strict=True):
        try:
            exact_solution(h, p=Fraction(x), q=Fraction(y), time=time, digits=15)
        except NoFlowError:
            with pytest.raises(NoFlowError, match=r"^point 0, .* blows up at t = "):
                exact_points(h, np.array([x]), np.array([y]), (time,))
        else:
            exact_points(h, np.array([x]), np.array([y]), (time,))


def test_a_numerical_flow_that_ends_names_the_point() -> None:
    h = Hamiltonian.parse("p**2/2 - q**6/6")
    with pytest.raises(NoFlowError, match=r"^point 1: .* at about t = "):
        exact_points(h, np.array([0.0, 1.0]), np.array([0.1, 1.0]), (Fraction(5),))


def test_what_leaves_float64_is_said_to() -> None:
    h = Hamiltonian.parse("p**2/2 - q**2/2")
    with pytest.raises(NoFlowError, match=r"^point 0, .* beyond float64"):
        exact_points(h, np.array([1.0]), np.array([1.0]), (Fraction(1000),))


def test_bad_input_is_refused() -> None:
    one, two = np.zeros(1), np.zeros(2)
    with pytest.raises(InputError, match=r"^parameter=delta"):
        exact_points(ALL["duffing"].hamiltonian(), one, one, TIMES)
    with pytest.raises(InputError, match=r"^points="):
        exact_points(Hamiltonian.parse(PENDULUM), one, two, TIMES)
    with pytest.raises(InputError, match=r"^points="):
        exact_points(Hamiltonian.parse(PENDULUM), one, one * np.nan, TIMES)


def test_no_points_and_no_times_are_no_error() -> None:
    none = np.zeros(0)
    assert exact_points(Hamiltonian.parse(PENDULUM), none, none, TIMES).p.shape == (3, 0)
    assert exact_points(Hamiltonian.parse(SEXTIC), none, none, TIMES).p.shape == (3, 0)
    assert exact_points(Hamiltonian.parse(PENDULUM), none + 1, none, ()).p.shape == (0, 0)


# -- planted errors -------------------------------------------------------------------------------


def late(motion: Motion) -> Any:
    return lambda mp, t: motion.state(mp, t * (1 + 1e-11) if isinstance(mp, FloatContext) else t)


def bent(motion: Motion) -> Any:
    def state(mp: Any, t: Any) -> Any:
        p, q = motion.state(mp, t)
        return (p, q * (1 + 1e-11)) if isinstance(mp, FloatContext) else (p, q)

    return state


@pytest.mark.parametrize("wrong", [late, bent])
@pytest.mark.parametrize("formula", [PENDULUM, HARD])
def test_a_closed_form_that_is_slightly_wrong_is_seen(
    formula: str, wrong: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = module.closed_form

    def planted(*arguments: Any) -> Any:
        motion, parameters = right(*arguments)
        return Motion(wrong(motion), motion.method), parameters

    monkeypatch.setattr(module, "closed_form", planted)
    with pytest.raises(NoFlowError, match=r"is wrong by .* was estimated"):
        exact_points(Hamiltonian.parse(formula), *cloud(0.3, 1.0), (Fraction(10),))


def test_the_parameter_of_another_system_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    other = Hamiltonian.parse("p**2/2 + q**2/2 + (1 + 1/10**10)*q**4/4")
    right = module.closed_form
    monkeypatch.setattr(module, "closed_form", lambda _, p, q: right(other, p, q))
    with pytest.raises(NoFlowError, match=r"is wrong by .* was estimated"):
        exact_points(Hamiltonian.parse(HARD), *cloud(0.3, 1.0), (Fraction(10),))


def test_a_numerical_flow_at_another_time_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = flow_of_many.follow

    def planted(h: Any, p: Any, q: Any, times: Any, columns: int) -> Any:
        return right(h, p, q, [t * (1 + Fraction(1, 10**11)) for t in times], columns)

    monkeypatch.setattr(module, "follow", planted)
    with pytest.raises(NoFlowError, match=r"is wrong by .* was estimated"):
        exact_points(Hamiltonian.parse(SEXTIC), *cloud(0.3, 1.0), (Fraction(3),))


def test_digits_that_a_formula_loses_are_seen_point_by_point(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What float64 loses at one point only sends that point to be found alone."""
    right = module.closed_form

    def planted(*arguments: Any) -> Any:
        motion, parameters = right(*arguments)

        def state(mp: Any, t: Any) -> Any:
            p, q = motion.state(mp, t)
            lossy = isinstance(q, Batch) and len(q.values) == 12
            if lossy and not mp.wide:
                q.values[7] += 1e-9
            return p, q

        return Motion(state, motion.method), parameters

    monkeypatch.setattr(module, "closed_form", planted)
    h, (p, q) = Hamiltonian.parse(PENDULUM), cloud(0.3, 1.0)
    found = exact_points(h, p, q, TIMES[:1])
    assert found.alone == (7,)
    assert largest_error(h, p, q, TIMES[:1], found) <= found.bound <= 1e-14


def test_without_a_wider_float_all_are_found_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "WIDE", FloatContext())
    h, (p, q) = Hamiltonian.parse(PENDULUM), cloud(0.3, 1.0)
    found = exact_points(h, p, q, TIMES)
    assert found.alone == tuple(range(12))
    assert largest_error(h, p, q, TIMES, found) <= found.bound <= 1e-14


# -- batches --------------------------------------------------------------------------------------


def test_a_comparison_that_does_not_decide_is_mixed() -> None:
    x = Batch(np.array([1.0, -2.0, 3.0]))
    assert x > -3
    assert not x > 3
    assert some(x < 0)
    with pytest.raises(MixedError) as info:
        bool(x > 0)
    assert info.value.mask.tolist() == [True, False, True]
    assert choose(x > 0, x, -x).values.tolist() == [1.0, 2.0, 3.0]
    assert choose(True, 1, 2) == 1


def test_groups_are_split_until_each_takes_one_way() -> None:
    x, ways = np.array([1.0, -2.0, 3.0, 0.5]), {}

    def evaluate(group: Any) -> None:
        batch = Batch(x[group])
        ways[tuple(group)] = ("big" if batch > 2 else "small") if batch > 0 else "negative"

    in_groups(4, evaluate, lambda _: None)
    assert ways == {(1,): "negative", (0, 3): "small", (2,): "big"}


def test_a_rational_is_rounded_once_to_the_long_double() -> None:
    third = Fraction(1, 3)
    wide = WIDE.rational(third)
    high = Fraction(float(wide))
    low = Fraction(float(wide - wide.dtype.type(float(wide))))
    assert abs(high + low - third) <= third * Fraction(float(WIDE.eps))


def test_carlsons_and_legendres_integrals_are_those_of_mpmath() -> None:
    import mpmath

    x, y, z = 0.25, 1.5 + 2j, 1.5 - 2j
    assert abs(complex(WIDE.elliprf(x, y, z)) - complex(mpmath.elliprf(x, y, z))) < 1e-15
    assert abs(complex(WIDE.elliprf(0.0, 1.0, 2.0)) - complex(mpmath.elliprf(0, 1, 2))) < 1e-15
    for m in (0.0, 0.3, 0.999):
        assert abs(float(WIDE.ellipk(m)) - float(mpmath.ellipk(m))) < 1e-14
