"""The exact flow of many points at once, held against `exact_solution` point by point."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from flint import fmpq

from verify.arithmetic.float_context import WIDE
from verify.errors import InputError
from verify.flows import extrapolation_of_many as flow_of_many
from verify.flows import points as module
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.points import Points, exact_points
from verify.flows.solution import exact_solution, solution_from
from verify.hamiltonians import flow_recognition, systems
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import Motion

ALL = systems.all_systems()
STILL = {name: system for name, system in ALL.items() if not system.time_dependent}
REGIMES = [(name, regime) for name, system in STILL.items() for regime in system.regimes]
TIMES = (Fraction(3, 4), Fraction(-1, 3), Fraction(0))
LONG = (Fraction(50), Fraction(100), Fraction(200))
PENDULUM = "p**2/2 - cos(q)"
SOFT = "p**2/2 + q**2/2 - q**4/4"
HARD = "p**2/2 + q**2/2 + q**4/4"
SEXTIC = "p**2/2 + q**6/6"
HENON_HEILES = systems.get("henon-heiles").hamiltonian({})


def cloud(p: float, q: float, count: int = 12, radius: float = 1 / 32) -> tuple[Any, Any]:
    """The point itself and others about it."""
    rng = np.random.default_rng(3)
    apart = rng.uniform(-radius, radius, (2, count))
    apart[:, 0] = 0
    return p + apart[0], q + apart[1]


def carried(h: Hamiltonian, p: Any, q: Any, times: Any) -> Points:
    return exact_points(h, {"p": p, "q": q}, times)


def largest_error(h: Hamiltonian, p: Any, q: Any, times: Any, found: Points) -> float:
    """The least that the largest error can be, by `exact_solution` with 25 digits."""
    worst = Fraction(0)
    for k, time in enumerate(times):
        for i, (x, y) in enumerate(zip(p, q, strict=True)):
            true = exact_solution(h, p=Fraction(x), q=Fraction(y), time=time, digits=25)
            worst = max(worst, abs(Fraction(found.points["p"][k, i]) - true.p) - true.bound)
            worst = max(worst, abs(Fraction(found.points["q"][k, i]) - true.q) - true.bound)
    return float(worst)


def cloud_in_degrees(count: int = 5) -> dict[str, Any]:
    rng = np.random.default_rng(3)
    return {name: rng.uniform(-0.2, 0.2, count) for name in HENON_HEILES.coordinates}


def size(*arrays: Any) -> float:
    return max(float(np.abs(x).max()) for x in arrays)


# -- every system ---------------------------------------------------------------------------------


@pytest.mark.sample(10)
@pytest.mark.parametrize(("name", "regime"), REGIMES, ids=map("-".join, REGIMES))
def test_a_cloud_about_each_example_is_carried_within_the_bound(name: str, regime: str) -> None:
    values, p0, q0 = ALL[name].regime(regime)
    h = ALL[name].hamiltonian(values)
    p, q = cloud(float(p0), float(q0), 6 if ALL[name].flow else 3)
    found = carried(h, p, q, TIMES)
    error = largest_error(h, p, q, TIMES, found)
    assert error <= found.bound
    most = 1.2e-16 if ALL[name].flow else 4e-14
    assert found.bound <= most * max(size(p, q, found.points["p"], found.points["q"]), 1 / 32)
    assert found.points["p"].shape == found.points["q"].shape == (len(TIMES), len(p))
    assert np.array_equal(found.points["p"][2], p)


def test_in_n_degrees_of_freedom_many_points_are_where_each_is() -> None:
    given, time = cloud_in_degrees(), Fraction(7, 2)
    found = exact_points(HENON_HEILES, given, [time])
    assert found.bound < 1e-13
    for i in range(5):
        start = {name: Fraction(float(x[i])) for name, x in given.items()}
        true = solution_from(HENON_HEILES, start, time, 25)
        for name, x in true.point.items():
            assert abs(Fraction(float(found.points[name][0][i])) - x) <= Fraction(found.bound)


LONG_LIVED = [
    ("pendulum", "libration"), ("pendulum", "rotation"), ("pendulum", "libration-elsewhere"),
    ("duffing", "hard"), ("duffing", "soft-inside"), ("double-well", "left-well"),
    ("double-well", "over-the-barrier"), ("cubic", "well"), ("quartic", "oscillation"),
    ("harmonic", "oscillation"), ("twist", "rotation"), ("morse", "bound"), ("morse", "free"),
    ("toda", "oscillation"), ("parabola", "oscillation"), ("toda-oscillator", "oscillation"),
]  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(("name", "regime"), LONG_LIVED, ids=map("-".join, LONG_LIVED))
def test_long_times_cost_no_digits_away_from_separatrices(name: str, regime: str) -> None:
    values, p0, q0 = ALL[name].regime(regime)
    h = ALL[name].hamiltonian(values)
    closed = ALL[name].flow is not None
    times = LONG if closed else (Fraction(60),)
    p, q = cloud(float(p0), float(q0), 2)
    found = carried(h, p, q, times)
    assert not found.outliers
    assert largest_error(h, p, q, times, found) <= found.bound
    assert found.bound <= 1e-12 * size(p, q, found.points["p"], found.points["q"])


# -- mixed batches --------------------------------------------------------------------------------


@pytest.mark.parametrize("formula", [PENDULUM, "p**2/2 + (q**2 - 1)**2/4", HARD])
def test_a_batch_may_go_every_way_at_once(formula: str) -> None:
    """Both sides of a separatrix and near it, on it, at rest and nearly at rest."""
    h = Hamiltonian.parse(formula)
    p = np.array([0.0, 1e-9, 0.0, 2.0, 2 + 1e-13, 2 - 1e-13, 2.5, -3.0, 0.3, 0.0, -0.0, 1e-200])
    q = np.array([0.0, 0.0, 1e-12, 0.0, 0.0, 0.0, 0.5, 1.0, 1.5, 1.0, 3.0, 0.0])
    times = (Fraction(5, 2), Fraction(-20))
    found = carried(h, p, q, times)
    assert largest_error(h, p, q, times, found) <= found.bound <= 1e-9


def test_near_rest_the_error_is_small_against_the_orbit() -> None:
    h = Hamiltonian.parse(HARD)
    p, q = cloud(0.0, 0.0, 10, 1e-6)
    found = carried(h, p, q, LONG)
    assert largest_error(h, p, q, LONG, found) <= found.bound <= 1e-12 * 1e-6


def test_points_that_float64_cannot_tell_are_told() -> None:
    """On both sides of the pendulum's separatrix, nearer to it than p² is rounded."""
    h = Hamiltonian.parse(PENDULUM)
    edge = 2 * np.cos(0.5)
    p = np.array([1.0, np.nextafter(edge, 3), np.nextafter(edge, 1), edge / 2])
    times = (Fraction(60),)
    found = carried(h, p, np.ones(4), times)
    assert found.points["q"][0, 1] > 6 > 3.2 > found.points["q"][0, 2]
    assert largest_error(h, p, np.ones(4), times, found) <= found.bound <= 1e-14


# -- where there is no answer ---------------------------------------------------------------------


@pytest.mark.parametrize("formula", [SOFT, "p**2/2 + q**2/2 - q**3/3", "-p**2/2 - q**2/2 + q**4/4"])
def test_a_point_that_blows_up_is_named(formula: str) -> None:
    h = Hamiltonian.parse(formula)
    p, q = np.array([0.0, 0.3, 0.0, 0.2]), np.array([0.1, 0.3, 1.5, -0.2])
    with pytest.raises(NoFlowError, match=r"^point 2, q = 1\.5, .* blows up at t = "):
        carried(h, p, q, (Fraction(1), Fraction(30)))
    with pytest.raises(NoFlowError, match=r"^point 2, q = 1\.5, .* blows up at t = −"):
        carried(h, p, q, (Fraction(-30),))
    early = (Fraction(1), Fraction(-1))
    found = carried(h, p, q, early)
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
                carried(h, np.array([x]), np.array([y]), (time,))
        else:
            carried(h, np.array([x]), np.array([y]), (time,))


def test_a_numerical_flow_that_ends_names_the_point() -> None:
    h = Hamiltonian.parse("p**2/2 - q**6/6")
    with pytest.raises(NoFlowError, match=r"^point 1: .* at about t = "):
        carried(h, np.array([0.0, 1.0]), np.array([0.1, 1.0]), (Fraction(5),))
    escaping = {**cloud_in_degrees(1), "q2": np.array([5.0])}
    with pytest.raises(NoFlowError, match="point 0"):
        exact_points(HENON_HEILES, escaping, [Fraction(50)])


def test_what_leaves_float64_is_said_to() -> None:
    h = Hamiltonian.parse("p**2/2 - q**2/2")
    with pytest.raises(NoFlowError, match=r"^point 0, .* beyond float64"):
        carried(h, np.array([1.0]), np.array([1.0]), (Fraction(1000),))


def test_bad_input_is_refused() -> None:
    one, two = np.zeros(1), np.zeros(2)
    with pytest.raises(InputError, match=r"^parameter=delta"):
        carried(ALL["duffing"].hamiltonian(), one, one, TIMES)
    with pytest.raises(InputError, match=r"^points="):
        carried(Hamiltonian.parse(PENDULUM), one, two, TIMES)
    with pytest.raises(InputError, match=r"^points="):
        carried(Hamiltonian.parse(PENDULUM), one, one * np.nan, TIMES)


def test_no_points_and_no_times_are_no_error() -> None:
    def shape(formula: str, p: Any, q: Any, times: Any) -> Any:
        return carried(Hamiltonian.parse(formula), p, q, times).points["p"].shape

    none = np.zeros(0)
    assert shape(PENDULUM, none, none, TIMES) == (3, 0)
    assert shape(SEXTIC, none, none, TIMES) == (3, 0)
    assert shape(PENDULUM, none + 1, none, ()) == (0, 0)
    assert shape(PENDULUM, np.ones(2), np.ones(2), ()) == (0, 2)


# -- planted errors -------------------------------------------------------------------------------


def late(motion: Motion) -> Any:
    return lambda t: motion.state(t * (1 + fmpq(1, 10**11)))


def bent(motion: Motion) -> Any:
    return lambda t: (motion.state(t)[0], motion.state(t)[1] * (1 + fmpq(1, 10**11)))


@pytest.fixture(autouse=True)
def nothing_remembered() -> None:
    """Points that a planted error has moved are not those of another test."""
    forget()


def forget() -> None:
    module._closed_form_evaluator.cache_clear()
    module._motions.cache_clear()


@pytest.mark.parametrize("wrong", [late, bent])
@pytest.mark.parametrize("formula", [PENDULUM, HARD])
def test_a_closed_form_that_is_slightly_wrong_is_beyond_the_bound(
    formula: str, wrong: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The control of all that is held against `largest_error`, by the numerical flow."""
    right = flow_recognition.motions
    h, (p, q), times = Hamiltonian.parse(formula), cloud(0.3, 1.0, 3), (Fraction(10),)
    assert by_numerical_flow(h, p, q, times[0], carried(h, p, q, times))

    def planted(hamiltonian: Hamiltonian) -> Any:
        def motion(*start: Fraction) -> Any:
            true: Any = right(hamiltonian)(*start)
            return replace(true, state=wrong(true))

        return motion

    monkeypatch.setattr(flow_recognition, "motions", planted)
    forget()
    assert not by_numerical_flow(h, p, q, times[0], carried(h, p, q, times))


def test_a_motion_is_made_once_for_all_times(monkeypatch: pytest.MonkeyPatch) -> None:
    h, (p, q), right = Hamiltonian.parse(HARD), cloud(0.3, 1.0, 5), flow_recognition.motions
    alone = carried(h, p, q, LONG)
    forget()
    made = []

    def counted(hamiltonian: Hamiltonian) -> Any:
        return lambda *start: made.append(start) or right(hamiltonian)(*start)

    monkeypatch.setattr(flow_recognition, "motions", counted)
    for k, time in enumerate(LONG):
        found = carried(h, p, q, [time])
        assert np.array_equal(found.points["p"][0], alone.points["p"][k])
        assert np.array_equal(found.points["q"][0], alone.points["q"][k])
    assert made == [(Fraction(x), Fraction(y)) for x, y in zip(p, q, strict=True)]


def by_numerical_flow(h: Hamiltonian, p: Any, q: Any, time: Fraction, found: Points) -> bool:
    """Whether all points are within their bound of what the numerical flow finds."""
    flow = NumericalFlow(canonical_field(h)[0], 25)
    ours, errors = (found.points["p"], found.points["q"]), []
    for i in range(len(p)):
        z = flow.follow((flow.number(Fraction(p[i])), flow.number(Fraction(q[i]))), time)
        true = [flow.arithmetic.exact(x) for x in z]
        errors += [abs(Fraction(x[0, i]) - y) for x, y in zip(ours, true, strict=True)]
    return max(errors) <= found.bound + Fraction(1, 10**20)


@pytest.mark.parametrize(
    ("h", "points"),
    [
        (Hamiltonian.parse(SEXTIC), dict(zip("pq", cloud(0.3, 1.0), strict=True))),
        (HENON_HEILES, cloud_in_degrees()),
    ],
    ids=["plane", "degrees"],
)
def test_a_numerical_flow_at_another_time_is_seen(
    h: Hamiltonian, points: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    right = flow_of_many.follow

    def planted(h: Any, points: Any, times: Any, columns: int, t0: Any) -> Any:
        return right(h, points, [t * (1 + Fraction(1, 10**11)) for t in times], columns, t0)

    monkeypatch.setattr(module, "follow", planted)
    with pytest.raises(NoFlowError, match=r"is wrong by .* was estimated"):
        exact_points(h, points, (Fraction(3),))


def test_a_rational_is_rounded_once_to_the_long_double() -> None:
    third = Fraction(1, 3)
    wide = WIDE.rational(third)
    high = Fraction(float(wide))
    low = Fraction(float(wide - wide.dtype.type(float(wide))))
    assert abs(high + low - third) <= third * Fraction(float(WIDE.eps))
