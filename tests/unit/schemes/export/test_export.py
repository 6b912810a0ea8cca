"""Exported code, executed: p', q', J and ΔJ are those of the exact map."""

import ctypes
import math
import re
import shutil
import subprocess
from collections.abc import Callable
from typing import Any

import mpmath
import pytest
import sympy

import verify
from tests.helpers.maps import by_formulas
from verify import InputError, schemes
from verify.algebra.formula import symbol
from verify.algebra.symbols import H_STEP
from verify.calls.inputs import hamiltonian_from
from verify.schemes.maps.parts import parts_of

Functions = tuple[Callable[..., Any], Callable[..., Any], Callable[..., Any]]
JULIA = ("sin", "cos", "tan", "exp", "log", "sqrt", "atan", "sinh", "cosh")
H_VALUE = 0.125  # doubles, as all of these
POINTS = {1: (0.625, -0.75), 2: (0.625, -0.375, -0.75, 0.5)}  # of p, then of q, by degrees
DELTA, TIME = 1.5, 0.375
COUPLED = "(p1**2 + p2**2)/2 - cos(q1)*cos(q2) + q1*q2/3"
DRIVEN = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"
OWN = "p_next = p - h*q**3/(1 + h**2*q**2); q_next = q + h*p_next/3"
CASES = [
    ("duffing", "lie2"),
    ("duffing", "rk4"),
    ("duffing", "yoshida4"),
    ("pendulum", "blanes-moan4"),
    ("pendulum", "rk4"),
    ("pendulum", "lie4"),
    ("p**2/2 + atan(q)*p**3 + sqrt(q**2 + 2)", "lie1"),
    ("p**2/2 + exp(q/3)*cosh(p) + 1/(q**2 + pi)", "lie2"),
    ("p**2/6 + q**4/4", OWN),
    (DRIVEN, "lie2"),
    (DRIVEN, "rk4"),
    (DRIVEN, "stormer-verlet"),
    ("p**2/(2 + t**2) + q**4/4 - q*exp(-t)", "yoshida4"),
    (COUPLED, "lie2"),
    (COUPLED, "stormer-verlet"),
    ("henon-heiles", "yoshida4"),
    ("henon-heiles", "explicit-midpoint"),
    ("(p1*q2 + p2)**2/2 + q1*q2*exp(p1/2)", "lie1"),
    ("(p1**2 + p2**2)/2 + q1**2*q2*cos(t)", "stormer-verlet"),
]


def known(system: str, name: str) -> list[mpmath.mpf]:
    """p', q', the entries of J, and ΔJ at the point with 40 digits, by sympy alone."""
    step_map = schemes.get(name).step_map(hamiltonian_from(system))
    z = [symbol(x) for x in step_map.hamiltonian.coordinates]
    size = len(z)
    with mpmath.workdps(40):
        point = [mpmath.mpf(x) for x in POINTS[step_map.degrees]]
        delta = {symbol("delta"): sympy.Rational(3, 2), symbol("t"): sympy.Rational(3, 8)}
        jacobian = mpmath.eye(size)
        for part in parts_of(step_map) or (step_map.flat,):
            moved = [part.ring.expression(x).subs(delta) for x in part.elements]
            slopes = [x.diff(y) for x in moved for y in z]
            read = sympy.lambdify((*z, H_STEP), [*moved, *slopes], "mpmath")
            values = read(*point, mpmath.mpf(H_VALUE))
            own = [values[k : k + size] for k in range(size, len(values), size)]
            jacobian = mpmath.matrix(own) * jacobian
            point = values[:size]
        return [*point, *jacobian, mpmath.det(jacobian) - 1]


def python_code(system: str, name: str) -> Functions:
    made: dict[str, Any] = {}
    exec(verify.export(system, name, "python"), made)  # noqa: S102 - that is what is tested
    return made["step"], made["step_jacobian"], made["step_delta_j"]


def julia_code(system: str, name: str) -> Functions:
    """Its lines, which are assignments alone, read as Python's."""
    text = verify.export(system, name, "julia")
    text = re.sub(r"^const ", "", text, flags=re.MULTILINE)
    text = re.sub(r"^function (.*)$", r"def \1:", text, flags=re.MULTILINE)
    assert text.count("def ") == len(re.findall(r"^end$", text, flags=re.MULTILINE)) == 3
    text = re.sub(r"^end$", "", text, flags=re.MULTILINE).replace("^", "**")
    made: dict[str, Any] = {name: getattr(math, name) for name in JULIA}
    exec(text, made)  # noqa: S102
    return made["step"], made["step_jacobian"], made["step_delta_j"]


@pytest.fixture(scope="module")
def c_code(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, str], Functions]:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("c")
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-shared", "-fPIC"]

    def functions(system: str, name: str) -> Functions:
        own = f"step{CASES.index((system, name))}"
        source, library = folder / f"{own}.c", folder / f"{own}.so"
        source.write_text(verify.export(system, name, "c", name=own))
        subprocess.run([compiler, *flags, str(source), "-o", str(library), "-lm"], check=True)
        loaded, size = ctypes.CDLL(str(library)), len(hamiltonian_from(system).coordinates)
        return (
            _filled(getattr(loaded, own), size),
            _filled(getattr(loaded, f"{own}_jacobian"), size**2),
            _returned(getattr(loaded, f"{own}_delta_j")),
        )

    return functions


def _filled(function: Any, count: int) -> Callable[..., list[float]]:
    def call(*values: float) -> list[float]:
        out = (ctypes.c_double * count)()
        function(*map(ctypes.c_double, values), out)
        return list(out)

    return call


def _returned(function: Any) -> Callable[..., float]:
    function.restype = ctypes.c_double
    return lambda *values: float(function(*map(ctypes.c_double, values)))


def check(functions: Functions, system: str, name: str) -> None:
    step, jacobian, delta_j = functions
    exact = hamiltonian_from(system)
    time = (TIME,) if exact.time_dependent else ()
    more = (DELTA,) if system == "duffing" else ()
    given = (*POINTS[exact.degrees], *time, H_VALUE, *more)
    wanted = known(system, name)
    found = [*step(*given), *jacobian(*given)]
    for own, exact in zip(found, wanted, strict=False):
        assert abs(own - exact) < 1e-14
    # det J − 1 would lose what cancels; its own formula does not.
    assert abs(delta_j(*given) - wanted[-1]) < max(1e-13 * abs(wanted[-1]), 1e-30)


@pytest.mark.sample(3)
@pytest.mark.parametrize(("system", "name"), CASES)
@pytest.mark.parametrize("language", [python_code, julia_code])
def test_the_code_is_the_map(
    language: Callable[[str, str], Functions], system: str, name: str
) -> None:
    check(language(system, name), system, name)


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize(("system", "name"), CASES)
def test_the_c_code_is_the_map(
    c_code: Callable[[str, str], Functions], system: str, name: str
) -> None:
    check(c_code(system, name), system, name)


def test_a_planted_error_in_the_code_is_seen() -> None:
    step, jacobian, delta_j = python_code("duffing", "lie2")
    wrong = [
        (lambda *x: (step(*x)[0] + 1e-13, step(*x)[1]), jacobian, delta_j),
        (step, lambda *x: [*jacobian(*x)][::-1], delta_j),
        (step, jacobian, lambda *x: delta_j(*x) * (1 + 1e-12)),
    ]
    for functions in wrong:
        with pytest.raises(AssertionError):
            check(functions, "duffing", "lie2")
    step, jacobian, delta_j = python_code(COUPLED, "lie2")
    check((step, jacobian, delta_j), COUPLED, "lie2")
    with pytest.raises(AssertionError):  # a Jacobian by columns
        check((step, lambda *x: transposed(jacobian(*x)), delta_j), COUPLED, "lie2")


def transposed(entries: Any) -> list[Any]:
    return [entries[4 * b + a] for a in range(4) for b in range(4)]


def test_names_that_mean_something_else_there_are_changed() -> None:
    text = verify.export("p**2/2 + lambda1*q**2 + x0*q + c0*q**3", "lie2", "python")
    made: dict[str, Any] = {}
    exec(text, made)  # noqa: S102
    assert len(made["step"](1.0, 2.0, 0.1, 1.0, 1.0, 1.0)) == 2
    assert "def step(p, q, h, c0, lambda1, x0):" in text
    code = verify.export("p**2/2 + double*q**2 + step*q**4", "lie2", "c")
    assert "double double_, double step_, double *out" in code
    for name in ("2x", "double", "a-b", "sin"):
        with pytest.raises(InputError, match="is no name for a function"):
            verify.export("duffing", "lie2", "c", name=name)


def test_what_is_not_in_closed_form_is_refused() -> None:
    with pytest.raises(InputError, match="given by equations"):
        verify.export("pendulum", "implicit-midpoint")
    assert "q_next" in verify.export("harmonic", "implicit-midpoint"), "of linear equations it is"
    with pytest.raises(InputError, match=r"language=cobol: unknown.*c, julia, latex, python"):
        verify.export("pendulum", "lie2", "cobol")


def test_a_text_of_the_users_stays_in_its_comment() -> None:
    made = by_formulas(hamiltonian_from("p**2/2 + q**2/2"), "p - h*q", "q + h*p_next")
    assert verify.export("p**2/2 + q**2/2", made).startswith("# One step of the scheme p_next = ")
    text = "p_next = p - (h*\nq); q_next = q + h*p_next"
    for language, mark in (("c", "//"), ("python", "#"), ("julia", "#"), ("latex", "%")):
        lines = verify.export("p**2/2 + q**2/2", text, language).splitlines()
        assert all(line.startswith(mark) for line in lines[:2]), language


def test_latex_has_the_parts_the_jacobian_and_delta_j() -> None:
    text = verify.export("duffing", "lie2", "latex")
    assert text.count(r"\begin{align*}") == text.count(r"\end{align*}") == 1
    assert r"\Delta J &= 3 \delta h^{3} p q + " in text
    assert r"J &= \left[\begin{matrix}" in text
    text = verify.export("pendulum", "yoshida4", "latex")
    rows = re.findall(r"^  (\S+) &=", text, flags=re.MULTILINE)
    assert rows == ["p_{1}", "q_{1}", "p_{2}", "q_{2}", "p_{3}", "q'", "p'"]
    assert text.count("{") == text.count("}")
    assert "in [6.7560359597982881" in text


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("name", "order"), [("lie2", 2), ("stormer-verlet", 2), ("forest-ruth", 4)]
)
def test_exported_python_is_a_scheme_in_time_of_its_order(name: str, order: int) -> None:
    """As an integrator of one's own, traced again from its text; and frozen it is none."""
    step = python_code(DRIVEN, name)[0]
    found = verify.check(DRIVEN, step, order=order)
    assert (found.verdict.holds, found.convergence_order) == (True, order)
    frozen = verify.check(DRIVEN, lambda p, q, t, h: step(p, q, 0.0 * t, h), order=order)
    assert frozen.verdict.value == "REFUTED"


def test_a_parameter_called_like_a_name_of_the_code_is_no_clock() -> None:
    """t is time, at its place before h, and says so in the head."""
    code = verify.export("p**2/2 - cos(q - omega*t)", "lie1", "python")
    assert "def step(p, q, t, h, omega):" in code
    assert "J is taken at a fixed t" in code
    assert "fixed t" not in verify.export("p**2/2 - cos(q)", "lie1", "python")
