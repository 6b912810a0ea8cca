"""The change of any function of the state along a run, against the orbit stepped by itself."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest

import verify
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.observables import find, select
from verify.runs.requested_run import RequestedRun, run
from verify.scenes.results.bounded_value import Value

EACH = [("float64", 17), ("fixed", 20), ("mpfr", 30), ("mpmath", 25), ("ball", 25)]
H, STEPS = Fraction(1, 20), 60
KEPLER_LIKE = "(p1**2 + p2**2)/2 + (q1**2 + q2**2)/2 + (q1**2 + q2**2)**2/8"
START: dict[str, Any] = {"q": [1, 0], "p": [0, "1.25"], "step_size": H, "steps": STEPS}
ANGULAR, WRONG = "q1*p2 - q2*p1", "q1*p2 + q2*p1"
CURVED = "exp(q1/4)*p2 + cos(q2)*p1**2"


def force(q: list[Any]) -> list[Any]:
    r = q[0] ** 2 + q[1] ** 2
    return [-x * (1 + r / 2) for x in q]


def slope_of_force(q: list[Any], v: list[Any]) -> list[Any]:
    r, along = q[0] ** 2 + q[1] ** 2, q[0] * v[0] + q[1] * v[1]
    return [-(w * (1 + r / 2) + x * along) for x, w in zip(q, v, strict=True)]


def lie2(z: list[Any], h: Any) -> list[Any]:
    p, q = z[:2], z[2:]
    f, g = force(q), slope_of_force(q, p)
    after_p = [x + h * y + h * h / 2 * w for x, y, w in zip(p, f, g, strict=True)]
    return after_p + [x + h * y + h * h / 2 * w for x, y, w in zip(q, p, f, strict=True)]


FUNCTIONS: dict[str, Callable[..., Any]] = {
    ANGULAR: lambda p1, p2, q1, q2: q1 * p2 - q2 * p1,
    WRONG: lambda p1, p2, q1, q2: q1 * p2 + q2 * p1,
    CURVED: lambda p1, p2, q1, q2: mpmath.exp(q1 / 4) * p2 + mpmath.cos(q2) * p1**2,
    "H": lambda p1, p2, q1, q2: (p1**2 + p2**2 + q1**2 + q2**2) / 2 + (q1**2 + q2**2) ** 2 / 8,
}


def expected(formula: str) -> tuple[Any, Any]:
    """I − I₀ at the end and max |I − I₀|, by 60 digits."""
    function = FUNCTIONS[formula]
    with mpmath.workdps(60):
        h, z = mpmath.mpf(1) / 20, [mpmath.mpf(0), mpmath.mpf("1.25"), mpmath.mpf(1), mpmath.mpf(0)]
        first, changes = function(*z), []
        for _ in range(STEPS):
            z = lie2(z, h)
            changes.append(function(*z) - first)
        return changes[-1], max(map(abs, changes))


def names_of(formula: str) -> list[str]:
    if formula == "H":
        return ["energy_error", "energy_error_max"]
    return [f"integral_error: {formula}", f"integral_error_max: {formula}"]


def holds(value: Value, true: Any) -> bool:
    with mpmath.workdps(60):
        return bool(abs(mpmath.mpf(value.value) - true) <= mpmath.mpf(value.bound))


@pytest.mark.parametrize("formula", FUNCTIONS)
@pytest.mark.parametrize(("arithmetic", "digits"), EACH)
def test_it_is_within_its_bound_of_the_orbit_s_own(
    arithmetic: str, digits: int, formula: str
) -> None:
    found = run(Hamiltonian.parse(KEPLER_LIKE), "lie2", **START, arithmetic=arithmetic,
                digits=digits, observables=names_of(formula))  # fmt: skip
    assert found.error_kind == "enclosed"
    for name, true in zip(names_of(formula), expected(formula), strict=True):
        value = found.values[name]
        assert holds(value, true), name
        with mpmath.workdps(60):
            bound = mpmath.mpf(value.bound)
            assert bound < mpmath.mpf(10) ** (4 - min(digits, 15)) * abs(true)
            assert not holds(value, true + 3 * bound)  # a planted error of three bounds


def test_a_wrong_integral_is_seen() -> None:
    """It changes by as much as it is large, and that of the motion by the error of the step."""
    found = verify.run(KEPLER_LIKE, "lie2", **START, keeps=[ANGULAR, WRONG], digits=12)
    right, wrong = found.keeps
    assert right.largest is not None
    assert wrong.largest is not None
    assert right.largest < Fraction(1, 1000)
    assert wrong.largest > 1


@pytest.mark.parametrize("arithmetic", ["float64", "mpfr"])
def test_what_a_scheme_is_shown_to_keep_changes_by_0(arithmetic: str) -> None:
    names = [*names_of(ANGULAR), *names_of(WRONG)]
    found = run(Hamiltonian.parse(KEPLER_LIKE), "stormer-verlet", **START, arithmetic=arithmetic,
                observables=names)  # fmt: skip
    assert {*found.exact} == {*names_of(ANGULAR)}
    assert {found.values[name].value for name in names_of(ANGULAR)} == {"0"}
    assert abs(found.values[names_of(WRONG)[1]]) > 1


def test_where_nothing_is_proved_a_change_of_0_has_a_bound_far_below_the_function() -> None:
    """p1**4 is kept where no force acts on p1; it is no integral of degree two."""
    free = Hamiltonian.parse("p1**2/2 + p2**2/2 - cos(q2)")
    found = run(free, "lie2", q=[0, 1], p=["1.5", 0], step_size=H, steps=50, arithmetic="mpfr",
                digits=20, observables=["energy_error", "integral_error: q2 - q2"])  # fmt: skip
    assert found.status == "finished"
    assert found.values["integral_error: q2 - q2"].value == "0"


def test_the_time_is_that_of_the_state() -> None:
    """I = q − t, over many periods of H, which fixed point takes off t."""
    driven = Hamiltonian.parse("p**2/2 + q*cos(t)")
    keys: dict[str, Any] = {"q": 0, "p": 1, "step_size": Fraction(1, 4), "steps": 400, "digits": 15}
    values = []
    for arithmetic in ("fixed", "mpfr", "ball"):
        found = run(driven, "lie2", **keys, arithmetic=arithmetic, observables=names_of("q - t"))
        assert found.arithmetic == arithmetic
        q = found.values["q"]
        for name in names_of("q - t"):
            values.append((name, found.values[name]))
        change = found.values[names_of("q - t")[0]]
        assert abs(change.exact - (q.exact - 100)) <= Fraction(change.bound) + Fraction(q.bound)
    for name, value in values:
        first = next(x for n, x in values if n == name)
        assert abs(value.exact - first.exact) <= Fraction(value.bound) + Fraction(first.bound)


def test_a_function_that_is_not_defined_along_the_run_is_named_in_one_line() -> None:
    keys: dict[str, Any] = {"q": 1, "p": 0, "step_size": "0.1", "steps": 60}
    for options in ({}, {"digits": 20}):
        with pytest.raises(InputError, match=r"^integral=log\(q\): is not defined at every state"):
            verify.run("p**2/2 + q**2/2", "lie2", **keys, **options, keeps="log(q)")
    with pytest.raises(InputError, match=r"^integral=log\(q - 2\): is not defined at the start"):
        verify.run("p**2/2 + q**2/2", "lie2", **keys, keeps="log(q - 2)")


@pytest.mark.parametrize("name", ["integral_error: x", "integral_error: q1*", "integral_error:",
                                  "integral_errors: q1", "integral_error: delta*q1"])  # fmt: skip
def test_a_bad_name_is_refused_in_one_line(name: str) -> None:
    with pytest.raises(InputError) as caught:
        run(Hamiltonian.parse(KEPLER_LIKE), "lie2", **START, observables=[name])
    assert "\n" not in str(caught.value)


def test_names_are_found_and_selected_in_one_order() -> None:
    assert find("integral_error:q*p") is not None
    assert find("lambda") is not None
    assert find("nothing: q") is None
    names = {"integral_error: q*p", "mse", "energy_error", "tangent"}
    assert [x.name for x in select(names)] == ["mse", "energy_error", "integral_error: q*p"]


# -- by default ------------------------------------------------------------------------------------


def test_a_run_shows_the_energy_unless_it_is_told_what_to_show() -> None:
    keys: dict[str, Any] = {"q": 1, "p": 0, "step_size": "0.1", "steps": 5}
    both = {"energy_error", "energy_error_max"}
    assert both <= verify.run("pendulum", "lie2", **keys).values.keys()
    assert not both & verify.run("pendulum", "lie2", **keys, observables=["mse"]).values.keys()
    driven = verify.run("p**2/2 + q*cos(t)", "lie2", **keys)
    assert driven.values
    assert not both & driven.values.keys()
    assert not both & run(Hamiltonian.parse("p**2/2 + q"), "lie1", **keys).values.keys()


def test_the_energy_by_the_way_asks_for_no_digits() -> None:
    """H − H₀ cancels; the run keeps the precision that the state and Λ need."""
    keys: dict[str, Any] = {"q": 1, "p": 0, "step_size": "0.001", "steps": 50, "digits": 33,
                            "arithmetic": "fixed"}  # fmt: skip
    by_the_way = verify.run("pendulum", "lie4", **keys).values["energy_error_max"]
    wanted = verify.run("pendulum", "lie4", **keys, keeps="energy").values["energy_error_max"]
    assert len(by_the_way.value) < len(wanted.value)
    assert abs(by_the_way.exact - wanted.exact) <= Fraction(by_the_way.bound)


def test_where_h_is_not_defined_a_run_goes_on_without_its_energy() -> None:
    keys: dict[str, Any] = {"q": 1, "p": 0, "step_size": "0.1", "steps": 30}
    for options in ({}, {"digits": 20}):
        found = verify.run("p**2/2 + log(q)", "stormer-verlet", **keys, **options)
        assert found.status == "finished"
        assert found.left_domain
        assert {*found.values} == {"p", "q", "delta_j_max", "mse", "lambda"}


def test_the_energy_makes_no_run_leave_the_fastest_arithmetic() -> None:
    """H is beyond 2^15 on an orbit on which a step is not; there the greatest is left out."""
    steep = Hamiltonian.parse("p**2/2 + 100*q + q**2/1000")
    keys: dict[str, Any] = {"q": 400, "p": 0, "step_size": "1/1000", "steps": 70_000}
    aside = ("energy_error", "energy_error_max")
    with_energy = RequestedRun(steep, "lie2", **keys, arithmetic="auto", digits=20, aside=aside)
    assert with_energy.arithmetic == "fixed"
    assert with_energy.kernel_run.aside == {"energy_error"}
    small = RequestedRun(steep, "lie2", **(keys | {"q": 2}), arithmetic="auto", aside=aside)
    assert small.arithmetic == "fixed"
    assert small.kernel_run.aside == {*aside}
