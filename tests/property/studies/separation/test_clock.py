"""float64's clock as a part of rounding: held against a run by hand, and where it rounds nothing.

By hand the step of lie2 for H = p²/2 − (1 + ε cos 2t) cos q and its Jacobian are written out, and
iterated in mpmath at 60 digits: at the exact times, and at those that Python's own t += h gives.
"""

from fractions import Fraction

import mpmath
import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.results.separation import SeparationResult
from verify.scenes.results.separation_parts import PartsInTime
from verify.studies.separation.truncation_and_rounding import separate

FORMULA = "p**2/2 - (1 + eps*cos(2*t))*cos(q)"
STEPS = 400


def by_hand(p: object, q: object, h: object, eps: object, times: list[object]) -> mpmath.mpf:
    """Λ of lie2 at these times, in mpmath."""
    with mpmath.workdps(60):
        p, q, h, eps = (
            mpmath.mpf(x.numerator) / x.denominator for x in map(Fraction, (p, q, h, eps))
        )
        product = mpmath.mpf(1)
        for time in map(Fraction, times):
            t = mpmath.mpf(time.numerator) / time.denominator
            a, b = 1 + eps * mpmath.cos(2 * t), -2 * eps * mpmath.sin(2 * t)
            s, c = mpmath.sin(q), mpmath.cos(q)
            # p' = −a sin q, p'' = −b sin q − a p cos q; q' = p, q'' = −a sin q
            half = h * h / 2
            jacobian = (
                1 - half * a * c,
                -h * a * c - half * (b * c - a * p * s),
                h,
                1 - half * a * c,
            )
            p, q = p - h * a * s - half * (b * s + a * p * c), q + h * p - half * a * s
            product *= jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2]
        return product - 1


def exact_times(t0: Fraction, h: Fraction) -> list[object]:
    return [t0 + k * h for k in range(STEPS)]


def clock_times(t0: float, h: float) -> list[object]:
    found: list[object] = []
    for _ in range(STEPS):
        found.append(t0)
        t0 += h
    return found


def separated(step_size: str, t0: str, digits: int = 12) -> SeparationResult:
    hamiltonian = Hamiltonian.parse(FORMULA, {"eps": "1/2"})
    return separate(hamiltonian, "lie2", q="1.5", p=0, step_size=step_size, steps=STEPS, t0=t0,
                    digits=digits)  # fmt: skip


@pytest.mark.parametrize(("step_size", "t0"), [("1/10", "1/3"), ("0.03", "-7"), ("1/7", "1000.1")])
def test_truncation_input_and_clock_are_those_of_runs_by_hand(step_size: str, t0: str) -> None:
    h, start = Fraction(step_size), Fraction(t0)
    truth = by_hand(0, 1.5, h, 0.5, exact_times(start, h))
    inputs = by_hand(0, 1.5, float(h), 0.5, exact_times(Fraction(float(start)), Fraction(float(h))))
    clock = by_hand(0, 1.5, float(h), 0.5, clock_times(float(start), float(h)))
    found = separated(step_size, t0)
    assert found.plain is not None
    parts = found.plain.parts
    assert isinstance(parts, PartsInTime)
    for value, wanted in (
        (parts.truncation, truth),
        (parts.input, inputs - truth),
        (parts.clock, clock - inputs),
    ):
        with mpmath.workdps(60):
            assert abs(mpmath.mpf(value.value) - wanted) <= 2 * mpmath.mpf(value.bound)
            assert mpmath.mpf(value.bound) < abs(wanted) / 10**9  # a digit that is printed is known
    assert abs(Fraction(parts.clock.value)) > 10 * abs(Fraction(parts.clock.bound))


def test_the_parts_add_up_and_the_clock_is_in_both_ways() -> None:
    found = separated("1/10", "1/3", 17)
    for way in (found.plain, found.closed_form):
        assert way is not None
        values = {name: Fraction(getattr(way.parts, name).value) for name in way.parts.of_rounding}
        slack = sum(Fraction(getattr(way.parts, name).bound) for name in (*values, "total"))
        assert abs(sum(values.values()) - Fraction(way.parts.total.value)) <= slack
        assert list(values) == ["input", "clock", "trajectory", "determinant", "product"]
        assert {"clock", "total"} < set(way.growth)


def test_where_no_addition_rounds_it_is_exactly_0_and_the_run_is_that_of_verify_run() -> None:
    found = separated("1/8", "-3/4")
    assert found.plain is not None
    assert isinstance(found.plain.parts, PartsInTime)
    assert (found.plain.parts.clock.value, found.plain.parts.clock.bound) == ("0", "0")
    hamiltonian = Hamiltonian.parse(FORMULA, {"eps": "1/2"})
    direct = run(hamiltonian, "lie2", q="1.5", p=0, step_size="1/8", steps=STEPS, t0="-3/4",
                 observables=("lambda_plain",))  # fmt: skip
    value = direct.values["lambda_plain"]
    apart = abs(Fraction(found.plain.parts.lambda_working.value) - Fraction(value.value))
    assert apart <= Fraction(value.bound) + Fraction(1, 10**15)


def test_of_an_h_without_t_there_is_no_clock() -> None:
    found = separate(Hamiltonian.parse("p**2/2 - cos(q)"), "lie2", q="1.5", p=0, step_size="0.1",
                     steps=20)  # fmt: skip
    assert found.plain is not None
    assert not isinstance(found.plain.parts, PartsInTime)
    assert "clock" not in found.plain.growth
    assert found.plain.error_kind == "enclosed"
