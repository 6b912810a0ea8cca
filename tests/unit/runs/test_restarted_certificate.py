"""Runs whose flow contracts volume to almost nothing, held against the steps by themselves."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import pytest

import verify
from verify import arithmetic as number_systems
from verify.hamiltonians.equations import read_system
from verify.kernels.stepping import KernelRun
from verify.runs import matrix_growth
from verify.runs.a_posteriori_bound import certify
from verify.runs.restarted_certificate import METHOD
from verify.scenes.results.bounded_value import Value

Numbers = Sequence[Any]


class Case(NamedTuple):
    """Equations, the field by itself, the start, and how many steps of which size."""

    text: str
    field: Callable[..., Numbers]
    start: dict[str, str]
    steps: int
    h: str = "1/50"


CASES = {
    "damped": Case("v_dot = -sin(x) - 20*v; x_dot = v",
                   lambda v, x: (-mpmath.sin(x) - 20 * v, v), {"v": "1/4", "x": "1"}, 300),
    "cycle": Case("v_dot = (1 - x**2)*v - x; x_dot = v",
                  lambda v, x: ((1 - x**2) * v - x, v), {"v": "1/4", "x": "1"}, 2500),
    "lorenz": Case("x_dot = 10*(y - x); y_dot = x*(28 - z) - y; z_dot = x*y - 8*z/3",
                   lambda x, y, z: (10 * (y - x), x * (28 - z) - y, x * y - 8 * z / 3),
                   {"x": "1", "y": "1", "z": "20"}, 250),
}  # fmt: skip


def rk4(field: Callable[..., Numbers], z: Numbers, h: Any) -> list[Any]:
    def move(slopes: Numbers, share: Any) -> list[Any]:
        return [x + share * k for x, k in zip(z, slopes, strict=True)]

    a = field(*z)
    b = field(*move(a, h / 2))
    c = field(*move(b, h / 2))
    d = field(*move(c, h))
    return [x + h * (k + 2 * u + 2 * v + w) / 6
            for x, k, u, v, w in zip(z, a, b, c, d, strict=True)]  # fmt: skip


def expected(case: Case) -> list[Any]:
    """The last state, by 80 digits."""
    with mpmath.workdps(80):
        z = [mpmath.mpf(Fraction(x).numerator) / Fraction(x).denominator
             for x in case.start.values()]  # fmt: skip
        for _ in range(case.steps):
            z = rk4(case.field, z, mpmath.mpf(1) / 50)
        return z


def holds(value: Value, true: Any) -> bool:
    with mpmath.workdps(80):
        return bool(abs(mpmath.mpf(value.value) - true) <= mpmath.mpf(value.bound))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(
    ("arithmetic", "digits"),
    [("float64", 17), ("mpfr", 25), pytest.param("fixed", 20, marks=pytest.mark.left_to_ci)],
)
def test_its_bounds_are_rigorous_and_hold(name: str, arithmetic: str, digits: int) -> None:
    case = CASES[name]
    found = verify.run(case.text, "rk4", start=case.start, step_size=case.h, steps=case.steps,
                       arithmetic=arithmetic, digits=digits)  # fmt: skip
    assert (found.error_kind, found.arithmetic) == ("enclosed", arithmetic)
    if arithmetic != "float64":
        assert found.error_method == METHOD
    for coordinate, true in zip(case.start, expected(case), strict=True):
        value = found.values[coordinate]
        assert holds(value, true), coordinate
        with mpmath.workdps(80):
            assert not holds(value, true + 3 * mpmath.mpf(value.bound))  # a planted error
    # In balls the same run has enclosures of another kind.
    balls = verify.run(case.text, "rk4", start=case.start, step_size=case.h, steps=case.steps,
                       arithmetic="ball", digits=12)  # fmt: skip
    for name_, value in found.values.items():
        near = balls.values[name_]
        apart = abs(value.exact - near.exact)
        assert apart <= Fraction(value.bound) + Fraction(near.bound), name_


def test_a_damped_form_keeps_its_factor_to_the_end() -> None:
    """Λ is e^−40 from −1 there; the defect of dv∧dx has its digits."""
    keys: dict[str, Any] = {"start": {"v": "1/4", "x": "1"}, "step_size": "1/10", "steps": 800,
                            "form": "dv^dx", "factor": "exp(-h/2)", "digits": 12}  # fmt: skip
    text = "v_dot = -sin(x) - v/2; x_dot = v"
    found, balls = (verify.run(text, "rk4", **keys, arithmetic=x) for x in ("mpfr", "ball"))
    assert (found.error_kind, found.error_method) == ("enclosed", METHOD)
    value, near = found.keeps[0].at_end, balls.keeps[0].at_end
    assert value is not None
    assert near is not None
    assert abs(value.exact - near.exact) <= Fraction(value.bound) + Fraction(near.bound)
    assert 0 < abs(value.exact) < Fraction(1, 10**17)
    assert Fraction(value.bound) < Fraction(1, 10**20)


def test_what_is_left_at_the_end_of_a_section_counts_in_the_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The negative control: a start that is off by 10^-25 is off by e^20 times that at the end."""
    text, off = "x_dot = x; y_dot = -20*y", Fraction(1, 10**25)
    inputs = {"x": Fraction(0), "y": Fraction(1), "h": Fraction(1, 50), "t": Fraction(0)}
    run = KernelRun(read_system(text), "rk4", inputs, 1000, frozenset(), 0)
    x, y = run.coordinates
    box = {x: (Fraction(0), off), y: (Fraction(1), Fraction(0))}
    run, arithmetic = run.from_box(box).restarting(128), number_systems.get("mpfr", 40)
    outcome = run.run(arithmetic, tangent=True)
    h = inputs["h"]
    true = off * (1 + h + h**2 / 2 + h**3 / 6 + h**4 / 24) ** 1000
    assert outcome.values[x] == 0
    assert true < (certify(run, arithmetic, outcome) or {})[x] < 10 * true
    follow = matrix_growth.follow

    def forgetful(sections: Any, first: Any, *more: Any) -> Any:
        pairs = [follow([section], first, *more) for section in sections]
        return max(top for top, _ in pairs), sum(total for _, total in pairs)

    monkeypatch.setattr(matrix_growth, "follow", forgetful)
    assert true > (certify(run, arithmetic, outcome) or {})[x]


def test_a_series_has_its_points(monkeypatch: pytest.MonkeyPatch) -> None:
    case = CASES["damped"]
    keys: dict[str, Any] = {"start": case.start, "step_size": case.h, "steps": case.steps,
                            "arithmetic": "mpfr", "digits": 15, "points": 30}  # fmt: skip
    found = verify.run(case.text, "rk4", **keys)
    assert found.error_method == METHOD
    assert len(found.series) == 30
    monkeypatch.setattr("verify.runs.digits_on_demand.certify_restarted", lambda *_: iter(()))
    estimated = verify.run(case.text, "rk4", **keys)
    assert (estimated.error_kind, estimated.series[:5]) == ("estimated", found.series[:5])


def test_of_a_hamiltonian_nothing_begins_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any) -> None:
        raise AssertionError

    monkeypatch.setattr("verify.runs.digits_on_demand.certify_restarted", fail)
    found = verify.run("p**2/2 - cos(q)", "lie2", q=3, p=0, step_size="0.1", steps=300, digits=12)
    assert found.status == "finished"
