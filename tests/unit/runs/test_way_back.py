"""The way back of a run: N steps, turned, N steps, turned, held against the steps by themselves."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest

import verify
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.results.bounded_value import Value

NAME = "way_back: -p, q"
KEYS: dict[str, Any] = {"q": 1, "p": "0.25", "step_size": "0.1", "steps": 40}


def taylor3(p: Any, q: Any, h: Any) -> tuple[Any, Any]:
    """lie3 of the pendulum: p' = −sin q, and its derivatives along the flow."""
    s, c = mpmath.sin(q), mpmath.cos(q)
    first, second, third = -s, -c * p, s * p * p + c * s
    return (
        p + h * first + h**2 / 2 * second + h**3 / 6 * third,
        q + h * p + h**2 / 2 * first + h**3 / 6 * second,
    )


def expected() -> Any:
    """The distance from (0.25, 1), by 60 digits."""
    with mpmath.workdps(60):
        h, start = mpmath.mpf(1) / 10, (mpmath.mpf("0.25"), mpmath.mpf(1))
        p, q = start
        for _ in range(2):
            for _ in range(40):
                p, q = taylor3(p, q, h)
            p = -p
        return mpmath.sqrt((p - start[0]) ** 2 + (q - start[1]) ** 2)


def holds(value: Value, true: Any) -> bool:
    with mpmath.workdps(60):
        return bool(abs(mpmath.mpf(value.value) - true) <= mpmath.mpf(value.bound))


def pendulum(scheme: str, arithmetic: str, digits: int = 17, name: str = NAME) -> Any:
    return run(Hamiltonian.parse("p**2/2 - cos(q)"), scheme, **KEYS, arithmetic=arithmetic,
               digits=digits, observables=[name])  # fmt: skip


@pytest.mark.parametrize(
    ("arithmetic", "digits"), [("float64", 17), ("fixed", 20), ("mpfr", 30), ("ball", 12)]
)
def test_it_is_within_its_bound_of_the_steps_by_themselves(arithmetic: str, digits: int) -> None:
    found = pendulum("lie3", arithmetic, digits)
    assert found.error_kind == "enclosed"
    value = found.values[NAME]
    assert holds(value, expected())
    assert Fraction(value.bound) < abs(value.exact) / 1000
    assert not holds(value, expected() + 3 * mpmath.mpf(value.bound))  # a planted error


def test_a_reversible_scheme_comes_back_by_proof_and_in_float64_to_rounding() -> None:
    assert pendulum("stormer-verlet", "mpfr").values[NAME] == 0
    assert pendulum("stormer-verlet", "mpfr").exact == (NAME,)
    rounded = pendulum("stormer-verlet", "float64")
    assert rounded.exact == ()
    assert abs(rounded.values[NAME]) < Fraction(1, 10**13)


@pytest.mark.parametrize(
    ("arithmetic", "digits"), [("float64", 17), ("fixed", 20), ("mpfr", 30), ("ball", 12)]
)
def test_steps_of_minus_h_lead_back_within_the_bound(arithmetic: str, digits: int) -> None:
    with mpmath.workdps(60):
        h, start = mpmath.mpf(1) / 10, (mpmath.mpf("0.25"), mpmath.mpf(1))
        p, q = start
        for size in (h, -h):
            for _ in range(40):
                p, q = taylor3(p, q, size)
        true = mpmath.sqrt((p - start[0]) ** 2 + (q - start[1]) ** 2)
    found = pendulum("lie3", arithmetic, digits, "way_back: -h")
    assert found.error_kind == "enclosed"
    value = found.values["way_back: -h"]
    assert holds(value, true)
    assert not holds(value, true + 3 * mpmath.mpf(value.bound))  # a planted error
    assert not holds(value, expected() * (1 + mpmath.mpf(10) ** -3))


def test_a_symmetric_scheme_comes_back_by_minus_h_by_proof_and_euler_does_not() -> None:
    found = pendulum("stormer-verlet", "mpfr", 17, "way_back: -h")
    assert (found.values["way_back: -h"].value, found.exact) == ("0", ("way_back: -h",))
    assert pendulum("symplectic-euler", "mpfr", 17, "way_back: -h").values["way_back: -h"] > 0
    (symmetric,) = verify.run("pendulum", "lie3", **KEYS, keeps="symmetric").keeps
    assert symmetric.at_end is not None


@pytest.mark.parametrize("arithmetic", ["fixed", "mpfr", "ball"])
@pytest.mark.parametrize("t0", ["0", "5000"])
def test_the_way_back_by_minus_h_goes_back_in_time(arithmetic: str, t0: str) -> None:
    """p′ = cos 3t, q′ = p by lie2: each step is known, and so is the way back."""
    driven = Hamiltonian.parse("p**2/2 - q*cos(3*t)")
    found = run(driven, "lie2", **KEYS, t0=t0, digits=15, arithmetic=arithmetic,
                observables=["way_back: -h"])  # fmt: skip
    with mpmath.workdps(60):
        first, h = mpmath.mpf(t0), mpmath.mpf(1) / 10
        start = z = (mpmath.mpf("0.25"), mpmath.mpf(1))
        for k, sign in [(k, 1) for k in range(40)] + [(k, -1) for k in range(40, 0, -1)]:
            t, step = first + k * h, sign * h
            force, slope = mpmath.cos(3 * t), -3 * mpmath.sin(3 * t)
            p, q = z
            z = (p + step * force + step**2 / 2 * slope, q + step * p + step**2 / 2 * force)
        true = mpmath.sqrt(sum((a - b) ** 2 for a, b in zip(z, start, strict=True)))
    assert found.arithmetic == arithmetic
    assert holds(found.values["way_back: -h"], true)
    assert not holds(found.values["way_back: -h"], true * (1 + mpmath.mpf(10) ** -9))


def test_a_wrong_turn_does_not_come_back() -> None:
    """ρ = (−p, −q) turns the pendulum's flow round nowhere."""
    assert pendulum("stormer-verlet", "mpfr", 17, "way_back: p, q").values["way_back: p, q"] > 1


def test_without_a_certificate_two_precisions_are_compared() -> None:
    found = run(Hamiltonian.parse("p**2/2 + q**4/4 + p*q/8"), "gauss2", **KEYS, digits=15,
                arithmetic="mpfr", observables=["way_back: -p, q"])  # fmt: skip
    assert found.error_kind == "estimated"
    assert found.values[NAME].bound != "0"


def test_a_scheme_that_breaks_down_has_no_way_back() -> None:
    found = run(Hamiltonian.parse("p**2/2 - q**4"), "lie2", q=3, p=4, step_size=1, steps=50,
                observables=[NAME])  # fmt: skip
    assert found.status == "left range"
    assert not found.values


@pytest.mark.parametrize("formulas", ["-p", "-p, q, q", "-p, x", "-2*p, q", "p + q, q", "-p,"])
def test_what_is_no_involution_is_refused_in_one_line(formulas: str) -> None:
    with pytest.raises(InputError) as caught:
        pendulum("lie2", "float64", 17, f"way_back: {formulas}")
    assert "\n" not in str(caught.value)


def test_there_is_none_of_a_system_that_depends_on_time() -> None:
    with pytest.raises(InputError, match="do not depend on t"):
        run(Hamiltonian.parse("p**2/2 + q*cos(t)"), "lie2", **KEYS, observables=[NAME])


def test_in_python_it_is_named_reversible() -> None:
    (by_default,) = verify.run("pendulum", "lie3", **KEYS, digits=20, keeps="reversible").keeps
    (turned,) = verify.run("pendulum", "lie3", **KEYS, digits=20, reverses="p, -q").keeps
    assert by_default.at_end is not None
    assert by_default.largest is None
    assert holds(by_default.at_end, expected())
    # The pendulum and the scheme are odd: with −1 both involutions are one.
    assert turned.at_end == by_default.at_end
