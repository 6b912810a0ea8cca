"""The accumulated defect of structures along a run, against the map of all steps by itself."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import pytest

import verify
from verify.errors import InputError
from verify.hamiltonians.equations import read_system
from verify.kernels.run_changes import UndefinedError
from verify.kernels.stepping import KernelRun
from verify.observables import find
from verify.runs.requested_run import run
from verify.scenes.results.bounded_value import Value

EACH = [("float64", 17), ("fixed", 20), ("mpfr", 30), ("mpmath", 25), ("ball", 25)]
H, STEPS = Fraction(1, 20), 40
Numbers = Sequence[Any]


def rk4(field: Callable[..., Numbers], z: Numbers, t: Any, h: Any) -> list[Any]:
    def move(slopes: Numbers, share: Any) -> list[Any]:
        return [x + h * share * k for x, k in zip(z, slopes, strict=True)]

    half = mpmath.mpf(1) / 2
    a = field(*z, t)
    b = field(*move(a, half), t + h / 2)
    c = field(*move(b, half), t + h / 2)
    d = field(*move(c, 1), t + h)
    return [x + h * (k + 2 * u + 2 * v + w) / 6
            for x, k, u, v, w in zip(z, a, b, c, d, strict=True)]  # fmt: skip


def prey(u: Any, v: Any, _: Any) -> Numbers:
    return u * (v - 2), v * (1 - u)


def damped(v: Any, x: Any, _: Any) -> Numbers:
    return -mpmath.sin(x) - v / 3, v


def body(x: Any, y: Any, z: Any, _: Any) -> Numbers:
    return -y * z / 6, x * z / 3, -x * y / 6


def driven(v: Any, x: Any, t: Any) -> Numbers:
    return -v / 2 + mpmath.cos(t) * x**2, v


def two(p1: Any, p2: Any, q1: Any, q2: Any, _: Any) -> Numbers:
    return -q1 - 2 * q1 * q2, -q2 - q1**2, p1, p2


def quartic(p: Any, q: Any, _: Any) -> Numbers:
    return -(q**3) / 2, p


class Case(NamedTuple):
    """A system, the field by itself, the text, and the defect of z_0, z_N and M with t_N = T."""

    system: str
    field: Callable[..., Numbers]
    start: dict[str, str]
    text: str
    defect: Callable[[Numbers, Numbers, Any, Any], Any]


def plane(weight: Callable[..., Any], factor: Callable[[Any], Any] = lambda T: 1) -> Any:
    """The entry of a form `weight` dz_1∧dz_2, relative to nothing."""
    return lambda z, w, m, T: weight(*w, T) * mpmath.det(m) - factor(T) * weight(*z, 0)


def greatest(matrix: Any) -> Any:
    return max(abs(matrix[a, b]) for a in range(matrix.rows) for b in range(a + 1, matrix.rows))


def cross(x: Any, y: Any, z: Any) -> Any:
    return mpmath.matrix([[0, z, -y], [-z, 0, x], [y, -x, 0]])


def masses(z: Numbers, w: Numbers, m: Any, T: Any) -> Any:
    form = mpmath.matrix(4, 4)
    form[0, 2], form[2, 0], form[1, 3], form[3, 1] = 2, -2, 1, -1
    return greatest(m.T * form * m - form)


PREY = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
DAMPED = "v_dot = -sin(x) - v/3; x_dot = v"
BODY = "x_dot = -y*z/6; y_dot = z*x/3; z_dot = -x*y/6"
DRIVEN = "v_dot = -v/2 + cos(t)*x**2; x_dot = v"
HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2"
UV = {"u": "1", "v": "2.5"}
VX = {"v": "0.25", "x": "1"}
AREA = plane(lambda u, v, _: 1 / (u * v))
CASES = {
    "form": Case(PREY, prey, UV, "form = du^dv/(u*v)", AREA),
    "density": Case(PREY, prey, UV, "density = 1/(u*v)",
                    lambda z, w, m, T: z[0] * z[1] / (w[0] * w[1]) * mpmath.det(m) - 1),
    "bracket": Case(PREY, prey, UV, "poisson = 0, u*v; -u*v, 0",
                    lambda z, w, m, T: z[0] * z[1] * mpmath.det(m) - w[0] * w[1]),
    "degenerate": Case(BODY, body, {"x": "1", "y": "0.5", "z": "-0.75"},
                       "poisson = 0, z, -y; -z, 0, x; y, -x, 0",
                       lambda z, w, m, T: greatest(m * cross(*z) * m.T - cross(*w))),
    "factor": Case(DAMPED, damped, VX, "factor = exp(-h/3); form = dv^dx",
                   plane(lambda *_: 1, lambda T: mpmath.exp(-T / 3))),
    "time": Case(DRIVEN, driven, VX, "form = exp(t/2)*dv^dx",
                 plane(lambda v, x, t: mpmath.exp(mpmath.mpf(t) / 2))),
    "timed": Case(DRIVEN, driven, VX, "density = exp(t/2)",
                  lambda z, w, m, T: mpmath.exp(T / 2) * mpmath.det(m) - 1),
    "masses": Case(HENON, two, {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1"},
                   "form = 2*dp1^dq1 + dp2^dq2", masses),
    "plane": Case("p**2/2 + q**4/8", quartic, {"p": "0.25", "q": "1"}, "form = (1 + q**2)*dp^dq",
                  plane(lambda p, q, _: 1 + q**2)),
}  # fmt: skip


def expected(case: Case) -> Any:
    """The defect by 120 digits; M is the difference quotient of the map of all steps."""
    with mpmath.workdps(120):
        h, first = mpmath.mpf(1) / 20, [mpmath.mpf(x) for x in case.start.values()]

        def steps(z: Numbers) -> Numbers:
            for k in range(STEPS):
                z = rk4(case.field, z, k * h, h)
            return z

        size, width = len(first), mpmath.mpf(10) ** -40
        matrix = mpmath.matrix(size, size)
        for b in range(size):
            ends = []
            for sign in (1, -1):
                moved = [*first]
                moved[b] += sign * width
                ends.append(steps(moved))
            for a in range(size):
                matrix[a, b] = (ends[0][a] - ends[1][a]) / (2 * width)
        return case.defect(first, steps(first), matrix, STEPS * h)


TRUE = {name: expected(case) for name, case in CASES.items()}


def arguments(case: Case) -> dict[str, Any]:
    """The start of a run, which of p and q is a list but in the plane."""
    if "_dot" in case.system:
        return {"start": case.start}
    if len(case.start) == 2:
        return {**case.start}
    return {x: [v for n, v in case.start.items() if n[0] == x] for x in "qp"}


def measure(case: Case, arithmetic: str, digits: int, scheme: str = "rk4") -> Any:
    return run(read_system(case.system), scheme, **arguments(case), step_size=H, steps=STEPS,
               arithmetic=arithmetic, digits=digits,
               observables=[f"accumulated_defect: {case.text}"])  # fmt: skip


def holds(value: Value, true: Any) -> bool:
    with mpmath.workdps(120):
        return bool(abs(mpmath.mpf(value.value) - true) <= mpmath.mpf(value.bound))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("arithmetic", "digits"), EACH)
def test_it_is_within_its_bound_of_the_map_of_all_steps(
    arithmetic: str, digits: int, name: str
) -> None:
    case, true = CASES[name], TRUE[name]
    found = measure(case, arithmetic, digits)
    assert (found.error_kind, found.arithmetic) == ("enclosed", arithmetic)
    value = found.values[f"accumulated_defect: {case.text}"]
    assert holds(value, true)
    with mpmath.workdps(120):
        bound = mpmath.mpf(value.bound)
        # float64 has its rounding, about 10^-15 of the size of the form.
        least = mpmath.mpf(10) ** -13 if arithmetic == "float64" else 0
        assert bound <= max(least, mpmath.mpf(10) ** (1 - digits) * abs(true))
        assert not holds(value, true + 3 * bound)  # a planted error of three bounds
