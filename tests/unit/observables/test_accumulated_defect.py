"""The accumulated defect of structures along a run, against the map of all steps by itself."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import flint
import mpmath
import pytest

import verify
from verify import arithmetic as number_systems
from verify.errors import InputError
from verify.hamiltonians.equations import read_system
from verify.kernels.run_changes import UndefinedError
from verify.kernels.stepping import KernelRun
from verify.runs.a_posteriori_bound import _Certificate, certify
from verify.runs.requested_run import run
from verify.scenes.results.bounded_value import Value

EACH = [("float64", 17), ("fixed", 20), ("mpfr", 30), ("mpmath", 25), ("ball", 25)]
QUICK = ("form", "plane")  # of the kernels that take long to compile
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


@pytest.mark.parametrize(
    ("arithmetic", "digits", "name"),
    [
        pytest.param(
            arithmetic, digits, name,
            marks=[pytest.mark.left_to_ci] if arithmetic == "fixed" and name not in QUICK else [],
        )
        for arithmetic, digits in EACH
        for name in CASES
    ],
)  # fmt: skip
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


@pytest.mark.parametrize(("name", "part"), [("factor", "error_of_matrix"),
                                            ("constant", "bound_of_product")])  # fmt: skip
def test_without_the_error_of_the_matrix_or_of_the_product_the_bound_does_not_hold(
    monkeypatch: pytest.MonkeyPatch, name: str, part: str
) -> None:
    """Of a form or density that does not depend on z all of the error is theirs."""
    constant = Case(PREY, prey, UV, "density = 2", lambda z, w, m, T: mpmath.det(m) - 1)
    case = {"constant": constant, **CASES}[name]
    true, arithmetic = expected(case), number_systems.get("mpfr", 15)
    inputs = {n: Fraction(x) for n, x in case.start.items()} | {"h": H, "t": Fraction(0)}
    text = f"accumulated_defect: {case.text}"
    kernel_run = KernelRun(read_system(case.system), "rk4", inputs, STEPS, frozenset({text}), 0)
    outcome = kernel_run.run(arithmetic, tangent=True)

    def bound() -> Any:
        error = (certify(kernel_run, arithmetic, outcome) or {})[text]
        return mpmath.mpf(error.numerator) / error.denominator

    with mpmath.workdps(60):
        value = outcome.values[text]
        error = abs(mpmath.mpf(value.numerator) / value.denominator - true)
        assert error <= bound()
        monkeypatch.setattr(_Certificate, part, property(lambda _: flint.arb(0))
                            if part == "error_of_matrix" else lambda _: flint.arb(0))  # fmt: skip
        assert error > bound()


@pytest.mark.parametrize("arithmetic", ["float64", "mpfr"])
def test_what_a_scheme_is_shown_to_keep_is_0_and_the_rest_is_not(arithmetic: str) -> None:
    """Symplectic Euler of u and v keeps du∧dv/(uv), and not du∧dv."""
    euler = "u_next = u/(1 - h*(v - 2)); v_next = v*(1 + h*(1 - u_next))"
    right, wrong = (
        verify.run(PREY, euler, start=UV, step_size=H, steps=STEPS, arithmetic=arithmetic, form=x)
        for x in ("du^dv/(u*v)", "du^dv")
    )
    (kept,), (lost,) = right.keeps, wrong.keeps
    assert kept.at_end == 0
    assert right.exact == ("accumulated_defect: form = (1/(u*v))*du^dv",)
    assert lost.at_end is not None
    assert abs(lost.at_end) > Fraction(1, 100)
    assert wrong.exact == ()


def test_a_wrong_factor_is_seen() -> None:
    """The form shrinks by e^(−T/3), T = 2: with another factor the defect is their difference."""
    keys: dict[str, Any] = {"start": VX, "step_size": H, "steps": STEPS, "form": "dv^dx"}
    right, wrong = (
        verify.run(DAMPED, "rk4", **keys, factor=f"exp(-h/{n})").keeps[0].at_end for n in (3, 2)
    )
    assert right is not None
    assert wrong is not None
    assert abs(right) < Fraction(1, 10**6)
    with mpmath.workdps(30):
        gap = mpmath.exp(-mpmath.mpf(2) / 3) - mpmath.exp(-1)
    assert float(wrong) == pytest.approx(float(gap), rel=1e-5)


def test_a_parameter_has_its_value() -> None:
    keys: dict[str, Any] = {"start": VX, "step_size": H, "steps": STEPS, "digits": 20}
    symbolic = verify.run(DAMPED.replace("v/3", "gamma*v"), "rk4", parameters={"gamma": "1/3"},
                          form="dv^dx", factor="exp(-gamma*h)", **keys)  # fmt: skip
    (value,) = (x.at_end for x in symbolic.keeps)
    assert value is not None
    assert holds(value, TRUE["factor"])


def test_without_a_certificate_it_is_estimated_by_a_rerun() -> None:
    """The midpoint rule solves equations; it keeps the length, and not the bracket."""
    found = measure(CASES["degenerate"], "mpfr", 15, "implicit-midpoint")
    assert found.error_kind == "estimated"
    value = found.values[f"accumulated_defect: {CASES['degenerate'].text}"]
    assert 0 < value < Fraction(1, 1000)


def test_a_long_float64_run_is_held_against_a_compensated_one() -> None:
    keys: dict[str, Any] = {"start": UV, "step_size": "0.01", "steps": 200_001}
    form, volume = verify.run(PREY, "rk4", **keys, form="du^dv/(u*v)", density="1/(u*v)").keeps
    assert form.at_end is not None
    assert volume.at_end is not None
    bound = Fraction(form.at_end.bound) + Fraction(volume.at_end.bound)
    assert 0 < bound < abs(form.at_end.exact) / 100
    assert abs(form.at_end.exact - volume.at_end.exact * Fraction("0.4")) < bound


def test_a_structure_that_is_not_defined_at_an_end_is_named_in_one_line() -> None:
    keys: dict[str, Any] = {"q": 1, "p": 0, "step_size": "0.1", "steps": 20}
    for start, options in ((1, {}), (1, {"digits": 20}), (0, {})):
        with pytest.raises(UndefinedError, match=r"^keeps=density = .*: is not defined at the st"):
            verify.run("p**2/2 + q**2/2", "lie2", **{**keys, "q": start}, **options,
                       density="log(q)")  # fmt: skip


@pytest.mark.parametrize("text", ["", "form", "form = du^dw", "form = du^dv; density = u", "u",
                                  "form = u; form = v", "density = 0*u", "poisson = 0, 1; 1, 0",
                                  "factor = exp(-h)", "form = du^dv; factor = 1 - h"])  # fmt: skip
def test_a_bad_text_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(InputError) as caught:
        run(read_system(PREY), "rk4", start=UV, step_size=H, steps=1,
            observables=[f"accumulated_defect: {text}"])  # fmt: skip
    assert "\n" not in str(caught.value)
    assert "--" not in str(caught.value)


def test_a_run_without_it_carries_no_matrix() -> None:
    """The kernels of area and of the symplectic form are as they were."""
    inputs = {"u": Fraction(1), "v": Fraction(1), "h": H, "t": Fraction(0)}
    for name, matrix in (("lambda", False), ("accumulated_defect: form = du^dv", True)):
        outcome = KernelRun(read_system(PREY), "rk4", inputs, 1, frozenset({name}), 0).run(
            number_systems.get("mpfr", 20)
        )
        assert outcome.kernel is not None
        assert bool(outcome.kernel.matrix) is matrix
