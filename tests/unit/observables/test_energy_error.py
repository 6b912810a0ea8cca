"""max |H − H₀| of a run, against the orbit stepped by itself, in every number system."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.observables import by_name
from verify.runs.requested_run import run
from verify.scenes.results.run import RunResult

H = Fraction(1, 20)
STEPS = 60


def lie2(f: Any, z: Any, h: Any) -> Any:
    """One step for H = p²/2 + V(q), by hand."""
    p, q = z
    return p + h * f(q) + h * h / 2 * f(q, 1) * p, q + h * p + h * h / 2 * f(q)


def pendulum(q: Any, derivative: int = 0) -> Any:
    return -mpmath.cos(q) if derivative else -mpmath.sin(q)


def expected() -> Any:
    """The greatest |H − H₀| of lie2 for the pendulum from q = 1.5, p = 0.25."""
    with mpmath.workdps(60):
        h = mpmath.mpf(H.numerator) / H.denominator
        z = mpmath.mpf("0.25"), mpmath.mpf("1.5")
        first = z[0] ** 2 / 2 - mpmath.cos(z[1])
        largest = mpmath.mpf(0)
        for _ in range(STEPS):
            z = lie2(pendulum, z, h)
            largest = max(largest, abs(z[0] ** 2 / 2 - mpmath.cos(z[1]) - first))
        return largest


def pendulum_run(arithmetic: str, digits: int, **given: Any) -> RunResult:
    keys = {"q": Fraction(3, 2), "p": Fraction(1, 4), "step_size": H, "steps": STEPS}
    return run(Hamiltonian.parse("p**2/2 - cos(q)"), "lie2", **keys, arithmetic=arithmetic,
               digits=digits, observables=["energy_error_max"], **given)  # fmt: skip


EACH = [("float64", 17), ("fixed", 20), ("mpfr", 30), ("mpmath", 25), ("ball", 25)]


@pytest.mark.parametrize(("arithmetic", "digits"), EACH)
def test_it_is_within_its_bound_of_the_orbit_s_own(arithmetic: str, digits: int) -> None:
    found = pendulum_run(arithmetic, digits).values["energy_error_max"]
    with mpmath.workdps(60):
        value, bound = mpmath.mpf(found.value), mpmath.mpf(found.bound)
        assert abs(value - expected()) <= bound
        assert bound < mpmath.mpf(10) ** (3 - min(digits, 15)) * expected()
        assert abs(value + 10 * bound - expected()) > bound  # a planted error of ten bounds


def test_what_certifies_it_is_rigorous() -> None:
    for arithmetic in ("fixed", "mpfr", "ball"):
        assert pendulum_run(arithmetic, 20).error_kind == "enclosed"


def test_the_last_state_counts() -> None:
    """A ball that rises out of the box of all states but the last, where H is steepest."""
    exact = Hamiltonian.parse("p**2/2 + exp(q)")
    keys: dict[str, Any] = {"q": 0, "p": 4, "step_size": 1, "steps": 1}
    found = {}
    for arithmetic in ("mpfr", "ball"):
        asked = {"arithmetic": arithmetic, "digits": 20, "observables": ["energy_error_max"]}
        found[arithmetic] = run(exact, "lie2", **keys, **asked).values["energy_error_max"]
    apart = abs(Fraction(found["mpfr"].value) - Fraction(found["ball"].value))
    assert apart <= Fraction(found["mpfr"].bound) + Fraction(found["ball"].bound)
    assert Fraction(found["mpfr"].value) > 1


def test_in_two_degrees_it_is_that_of_the_plane_for_uncoupled_motion() -> None:
    """Of two pendulums of which one hangs at rest."""
    both = Hamiltonian.parse("(p1**2 + p2**2)/2 - cos(q1) - cos(q2)")
    found = run(both, "lie2", q=[Fraction(3, 2), 0], p=[Fraction(1, 4), 0], step_size=H,
                steps=STEPS, arithmetic="mpfr", digits=25,
                observables=["energy_error_max"]).values["energy_error_max"]  # fmt: skip
    one = pendulum_run("mpfr", 25).values["energy_error_max"]
    apart = abs(Fraction(found.value) - Fraction(one.value))
    assert apart <= Fraction(found.bound) + Fraction(one.bound)


def test_there_is_none_of_an_h_that_depends_on_time() -> None:
    driven = Hamiltonian.parse("p**2/2 + q**2/2 + q*cos(t)")
    with pytest.raises(InputError, match="energy_error_max: is for an H that"):
        run(driven, "lie2", q=1, p=0, step_size=H, steps=3, observables=["energy_error_max"])


def test_a_left_range_tells_no_value() -> None:
    found = run(Hamiltonian.parse("p**2/2 - q**4"), "lie2", q=3, p=4, step_size=1, steps=50,
                observables=["energy_error_max"])  # fmt: skip
    assert found.status == "left range"
    assert not found.values


def test_every_observable_is_shown_under_a_name_of_its_own() -> None:
    labels = [each.label for each in by_name().values()]
    assert len(set(labels)) == len(labels) == len(by_name())
    assert [each.order for each in by_name().values()] == sorted(
        x.order for x in by_name().values()
    )
