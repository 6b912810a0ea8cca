"""Runs of equations without an H, against the steps by themselves, in every number system."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import flint
import mpmath
import pytest

import verify
from verify.arithmetic.arb import rational_ball
from verify.errors import InputError
from verify.hamiltonians.equations import read_system
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.matrix_operations import change_of_determinant
from verify.kernels.step.operations import StepProgram
from verify.kernels.step.tangent_map import statements
from verify.runs import matrix_growth
from verify.runs.requested_run import run
from verify.scenes.results.bounded_value import Value

DIGITS = 60
H, STEPS = Fraction(1, 25), 40
Field = Callable[..., list[Any]]

# Each with names that a kernel's source also has, in an order of their own.
SYSTEMS: dict[str, tuple[str, dict[str, str], Field]] = {
    "prey": (
        "v2_dot = v2*(v1 - 2); v1_dot = v1*(1 - v2)", {"v2": "1", "v1": "2.5"},
        lambda t, u, v: [u * (v - 2), v * (1 - u)],
    ),
    "body": (
        "steps_dot = k*h0/3; k_dot = -2*steps*h0/3; h0_dot = steps*k/3",
        {"steps": "1", "k": "0.5", "h0": "2"},
        lambda t, a, b, c: [b * c / 3, -2 * a * c / 3, a * b / 3],
    ),
    "decay": ("x0_dot = -x0/3 + cos(x0)", {"x0": "0.25"}, lambda t, x: [-x / 3 + mpmath.cos(x)]),
    "driven": (
        "v_dot = -x - v/8 + cos(t); x_dot = v", {"v": "0.5", "x": "0"},
        lambda t, v, x: [-x - v / 8 + mpmath.cos(t), v],
    ),
    "bodies": (
        "v1_dot = x2 - x1**3; v2_dot = x1 - x2**3/2; x1_dot = v1; x2_dot = v2",
        {"v1": "0", "v2": "0.25", "x1": "1", "x2": "0.5"},
        lambda t, v, w, x, y: [y - x**3, x - y**3 / 2, v, w],
    ),
}  # fmt: skip
INTEGRAL = {"prey": "v2 + v1 - log(v2) - 2*log(v1)", "body": "steps**2 + k**2 + h0**2"}


def rk4(field: Field, t: Any, z: Sequence[Any], h: Any) -> list[Any]:
    def moved(k: Sequence[Any], share: Any) -> list[Any]:
        return [x + share * y for x, y in zip(z, k, strict=True)]

    first = field(t, *z)
    second = field(t + h / 2, *moved(first, h / 2))
    third = field(t + h / 2, *moved(second, h / 2))
    last = field(t + h, *moved(third, h))
    slopes = zip(first, second, third, last, strict=True)
    return [x + h / 6 * (a + 2 * b + 2 * c + d) for x, (a, b, c, d) in zip(z, slopes, strict=True)]


def determinant(step: Callable[[Sequence[Any]], list[Any]], z: Sequence[Any]) -> Any:
    """det J by central differences, right to some 35 digits."""
    width, columns = mpmath.mpf(10) ** -20, []
    for k in range(len(z)):
        ahead, back = ([x + (s * width if i == k else 0) for i, x in enumerate(z)] for s in (1, -1))
        pairs = zip(step(ahead), step(back), strict=True)
        columns.append([(x - y) / (2 * width) for x, y in pairs])
    return mpmath.det(mpmath.matrix(columns))


def expected(name: str) -> dict[str, Any]:
    """The last state, Λ and max |ΔJ|."""
    _, start, field = SYSTEMS[name]
    with mpmath.workdps(DIGITS):
        h, z, volume, largest = mpmath.mpf(1) / 25, list(map(mpmath.mpf, start.values())), 1, 0
        for k in range(STEPS):
            det = determinant(lambda y, k=k: rk4(field, k * h, y, h), z)
            volume, largest = volume * det, max(largest, abs(det - 1))
            z = rk4(field, k * h, z, h)
        return dict(zip(start, z, strict=True)) | {"lambda": volume - 1, "delta_j_max": largest}


def holds(value: Value, true: Any) -> bool:
    with mpmath.workdps(DIGITS):
        return bool(abs(mpmath.mpf(value.value) - true) <= mpmath.mpf(value.bound) + 10**-33)


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize(
    ("arithmetic", "digits"), [("float64", 17), ("fixed", 20), ("mpfr", 25), ("ball", 20)]
)
def test_every_value_is_within_its_bound(arithmetic: str, digits: int, name: str) -> None:
    text, start, _ = SYSTEMS[name]
    found = verify.run(text, "rk4", start=start, step_size=H, steps=STEPS, arithmetic=arithmetic,
                       digits=digits)  # fmt: skip
    assert found.arithmetic == arithmetic
    assert found.error_kind == "enclosed"
    true = expected(name)
    assert {*found.values} == {*true, "mse"}
    for key, x in true.items():
        value = found.values[key]
        assert holds(value, x), key
        # Of 4 coordinates ΔJ is a sum of O(h) that cancels to O(h⁵).
        known = 8 if arithmetic == "float64" else 14
        assert Fraction(value.bound) <= abs(value.exact) / 10**known
        with mpmath.workdps(DIGITS):
            planted = x + 3 * mpmath.mpf(value.bound) + mpmath.mpf(10) ** -30
        assert not holds(value, planted), key


@pytest.mark.parametrize("scheme", ["lie2", "rk4"])
def test_the_field_of_an_h_has_the_area_of_the_h(scheme: str) -> None:
    keys: dict[str, Any] = {"step_size": "0.1", "steps": 60, "digits": 20}
    by_h = verify.run("p**2/2 + q**4/4 + p*q/5", scheme, q=1, p="0.5", **keys)
    field = verify.run(
        "v_dot = -x**3 - v/5; x_dot = v + x/5", scheme, start={"v": "0.5", "x": 1}, **keys
    )
    pairs = {"lambda": "lambda", "mse": "mse", "delta_j_max": "delta_j_max", "p": "v", "q": "x"}
    for name, other in pairs.items():
        one, two = by_h.values[name], field.values[other]
        assert abs(one.exact - two.exact) <= Fraction(one.bound) + Fraction(two.bound), name


@pytest.mark.parametrize("name", INTEGRAL)
def test_an_integral_is_followed_and_a_wrong_one_is_seen(name: str) -> None:
    text, start, _ = SYSTEMS[name]
    wrong = INTEGRAL[name].replace("+", "-", 1)
    keys: dict[str, Any] = {"start": start, "step_size": H, "steps": STEPS, "digits": 15}
    found = verify.run(text, "rk4", **keys, keeps=[INTEGRAL[name], wrong, "volume"])
    right, other, volume = found.keeps
    assert right.largest is not None
    assert other.largest is not None
    assert right.largest < Fraction(1, 10**5)
    assert other.largest > Fraction(1, 10)
    assert volume.at_end == found.values["lambda"]


def test_by_ball_arithmetic_it_is_the_same() -> None:
    text, start, _ = SYSTEMS["body"]
    keys: dict[str, Any] = {"start": start, "step_size": H, "steps": STEPS, "digits": 15}
    name = f"integral_error_max: {INTEGRAL['body']}"
    runs = [
        run(read_system(text), "lie2", **keys, arithmetic=each, observables=["lambda", name])
        for each in ("ball", "mpfr", "fixed")
    ]
    for each in runs[1:]:
        assert each.error_kind == "enclosed"
        for key, value in each.values.items():
            other = runs[0].values[key]
            bounds = Fraction(value.bound) + Fraction(other.bound)
            assert abs(value.exact - other.exact) <= bounds, key


def test_the_way_back_of_a_body_that_turns() -> None:
    text, start, _ = SYSTEMS["body"]
    keys: dict[str, Any] = {"start": start, "step_size": H, "steps": STEPS, "digits": 15}
    (turned,) = verify.run(text, "lie2", **keys, reverses="-steps, -k, -h0").keeps
    (wrong,) = verify.run(text, "lie2", **keys, reverses="-steps, k, -h0").keeps
    assert turned.at_end is not None
    assert wrong.at_end is not None
    assert 0 < turned.at_end < Fraction(1, 1000)
    assert wrong.at_end > Fraction(1, 10)


def test_states_are_listed_by_their_names() -> None:
    text, start, _ = SYSTEMS["prey"]
    table = verify.run(text, "lie2", start=start, step_size="0.1", steps=4).orbit
    assert table.columns == ("t", "v2", "v1", "delta_j", "lambda")
    assert table.texts("v1")[0] == "2.5"


PREY = SYSTEMS["prey"][0]
BAD: dict[str, tuple[dict[str, Any], str]] = {
    "q": ({"q": 1, "p": 0}, "q=1: is of an H"),
    "none": ({}, "start: is no values by name"),
    "lacking": ({"start": {"v1": 1}}, "start=v1: has no value of v2"),
    "strange": ({"start": {"v1": 1, "u": 2}}, "start=u: unknown"),
    "no number": ({"start": {"v1": 1, "v2": "x"}}, "v2=x: not a"),
    "energy": ({"start": {"v1": 1, "v2": 2}, "keeps": "energy"}, "a system without H has none"),
    "observable": (
        {"start": {"v1": 1, "v2": 2}, "observables": ["energy_error"]}, "observable=energy_error",
    ),
    "form": ({"start": {"v1": 1, "v2": 2}, "observables": ["symplectic_defect"]}, "observable="),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_what_is_wrong_is_one_line(case: str) -> None:
    keys, problem = BAD[case]
    with pytest.raises(InputError) as caught:
        verify.run(PREY, "lie2", **keys, step_size="0.1", steps=3)
    assert problem in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_h_has_no_start_by_names() -> None:
    with pytest.raises(InputError, match="is of equations; an H has q and p"):
        verify.run("pendulum", "lie2", start={"p": 1, "q": 0}, step_size="0.1", steps=3)


# -- what a kernel and a certificate are made of ---------------------------------------------------


@pytest.mark.parametrize("size", [1, 2, 3, 4, 5])
def test_the_inverse_of_any_matrix_is_no_larger_than_is_said(size: int) -> None:
    """‖M‖/‖M⁻¹‖ ≥ d, and equal at a matrix whose other singular values are alike."""
    nearest = mpmath.inf
    for seed in range(200):
        entries = [Fraction((seed * 37 + 11 * k * k + 5 * k) % 23 - 11, 4) for k in range(size**2)]
        stretched = [x * (20 if k % 7 == seed % 7 else 1) for k, x in enumerate(entries)]
        rows = [stretched[size * k : size * (k + 1)] for k in range(size)]
        matrix = mpmath.matrix([[mpmath.mpf(x.numerator) / x.denominator for x in r] for r in rows])
        det = abs(mpmath.det(matrix))
        if det < 10**-8:
            continue
        records = {
            "growth_top": rational_ball(sum((x * x for x in stretched), Fraction(0))),
            "det_low": flint.arb(mpmath.nstr(det, 25)),
        }
        least = matrix_growth.least_of(size, records)
        singular = mpmath.svd_r(matrix, compute_uv=False)
        share = singular[0] * singular[size - 1] / mpmath.mpf(least.mid().str(20, radius=False))
        if least > 0:
            assert share >= 1 - mpmath.mpf(10) ** -12
            nearest = min(nearest, share)
    assert nearest < 40  # it is no bound that holds for being loose


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_the_determinant_of_m_is_the_determinant(size: int) -> None:
    names = [f"z{k + 1}" for k in range(size)]
    scope: dict[str, Any] = {"approx": float, "det_low": 10.0, "growth": 0.0, "growth_top": 0.0}
    for n in names:
        scope |= {n: 0.0, f"{n}_low": 0.0, f"{n}_high": 0.0}
    entries = {(a, b): float((3 * i * i + 7 * j + i * j) % 5 - 2) for (i, a), (j, b) in
               product(enumerate(names), enumerate(names))}  # fmt: skip
    for (a, b), x in entries.items():
        scope |= {f"m_{a}{b}": x, f"m_{a}{b}_rest": 0.0}
    source = "\n".join(statements(["0.0"] * size**2, names, canonical=False))
    exec(source, scope)  # noqa: S102 - our own source
    rows = [[entries[a, b] for b in names] for a in names]
    assert scope["f_det"] == pytest.approx(float(mpmath.det(mpmath.matrix(rows))))


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_the_change_of_a_determinant_has_no_1_to_cancel_against(size: int) -> None:
    """With entries of 10⁻²⁰ in float64, det(1 + K) − 1 keeps all of its digits."""
    program, slopes = StepProgram(), []
    numbers = [[(2 * i + 3 * j + 1) * 1e-20 for j in range(size)] for i in range(size)]
    for i in range(size):
        slopes.append([program.input(f"k{i}_{j}", static=False) for j in range(size)])
    index = change_of_determinant(program, slopes)
    scope: dict[str, Any] = {
        f"k{i}_{j}": x for i, row in enumerate(numbers) for j, x in enumerate(row)
    }
    lowering = Lowering(program, ())
    before, lines = lowering.lines([index])
    exec("\n".join([*before, *lines]), scope)  # noqa: S102 - our own source
    found = scope[lowering.name(index)]
    with mpmath.workdps(80):
        exact = mpmath.det(mpmath.eye(size) + mpmath.matrix(numbers)) - 1
        assert abs(found - exact) <= 1e-15 * abs(exact)
