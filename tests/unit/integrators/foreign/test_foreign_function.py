"""Steps in C and Fortran, and programs: right ones are measured, and each misdeed is named."""

import subprocess
import time
from pathlib import Path

import pytest

from tests.helpers.programs.compilers import library, needed
from tests.helpers.programs.judged import judged
from tests.paths import ROOT
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.foreign.foreign_function import is_library, step_of_library
from verify.integrators.results import Claims, Finding
from verify.integrators.user_code.user_map import DOUBLE, NumberType, type_of
from verify.verdict import Verdict

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
BAD = str(ROOT / "tests" / "helpers" / "programs" / "bad_program.py")
STEP = """
#include <math.h>
void step(int n, {t}, {h}, {type} *p, {type} *q)
{{
    for (int i = 0; i < n; i++) {{
        p[i] -= {size} / 2 * {sin}(q[i]);
        q[i] += {size} * p[i];
        p[i] -= {size} / 2 * {sin}(q[i]);
    }}
}}
"""
OF_C = {
    "double": STEP.format(t="double t", h="double h", type="double", size="h", sin="sin"),
    "long-double": STEP.format(
        t="long double t", h="long double h", type="long double", size="h", sin="sinl"
    ),
    "float128": STEP.format(
        t="const __float128 *t", h="const __float128 *h", type="__float128", size="*h", sin="sinq"
    ).replace("<math.h>", "<quadmath.h>"),
}
# Of double-doubles by sums and products that are exact but for the last bits.
OF_TWO = """
#include <math.h>
typedef struct { double hi, lo; } dd;
static dd sum(double a, double b)
{ double s = a + b, z = s - a; return (dd){s, (a - (s - z)) + (b - z)}; }
static dd add(dd a, dd b)
{ dd s = sum(a.hi, b.hi), t = sum(a.lo, b.lo); s = sum(s.hi, s.lo + t.hi);
  return sum(s.hi, s.lo + t.lo); }
static dd mul(dd a, dd b)
{ double p = a.hi * b.hi; return sum(p, fma(a.hi, b.hi, -p) + (a.hi * b.lo + a.lo * b.hi)); }
void step(int n, const double *t, const double *h, double *p, double *q)
{
    dd x = {p[0], p[1]}, y = {q[0], q[1]}, s = {h[0], h[1]}, half = {h[0] / -2, h[1] / -2};
    x = add(x, mul(half, mul(y, mul(y, y))));
    y = add(y, mul(s, x));
    x = add(x, mul(half, mul(y, mul(y, y))));
    p[0] = x.hi; p[1] = x.lo; q[0] = y.hi; q[1] = y.lo;
}
"""
NOISE = {"double": 1e-11, "long-double": 1e-14, "float128": 1e-26, "double-double": 1e-22}


def checked(path: str, name: str, claims: Claims, formula: str = "p**2/2 - cos(q)") -> Finding:
    kind: NumberType = type_of(name)
    step = step_of_library(f"{path}:step", 1, kind, 60)
    return judged(step, claims, hamiltonian=formula)


@pytest.mark.left_to_ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("name", OF_C)
def test_a_step_in_c_is_measured_to_the_digits_of_its_type(name: str, tmp_path: Path) -> None:
    begun = time.perf_counter()
    path = library(tmp_path, "step.c", OF_C[name], "-lm", "-lquadmath")
    found = checked(path, name, Claims(order=2, symplectic=True))
    assert found.verdict is Verdict.MEASURED, found.reason
    assert found.convergence_order == 2
    assert found.probe_error is not None
    assert found.probe_error < NOISE[name]
    assert time.perf_counter() - begun < 30, "5 s are meant; tests share the processor"
    assert checked(path, name, Claims(order=3)).verdict is Verdict.REFUTED


@pytest.mark.left_to_ci
def test_a_step_of_double_doubles_is_measured_to_their_digits(tmp_path: Path) -> None:
    path = library(tmp_path, "step.c", OF_TWO, "-ffp-contract=off", "-lm")
    found = checked(path, "double-double", Claims(order=2, symplectic=True), "p**2/2 + q**4/4")
    assert found.verdict is Verdict.MEASURED, found.reason
    assert found.probe_error is not None
    assert found.probe_error < NOISE["double-double"]


@pytest.mark.left_to_ci
def test_what_a_double_does_not_show_a_longer_number_does(tmp_path: Path) -> None:
    """An area defect of 10⁻¹⁵ of each step."""
    spoilt = "\n    p[0] *= 1 + 1e-15 * {h};\n}}\n".format
    for name, size, verdict in (
        ("double", "h", Verdict.MEASURED), ("float128", "*h", Verdict.REFUTED),
    ):  # fmt: skip
        source = OF_C[name].rstrip().removesuffix("}") + spoilt(h=size).replace("}}", "}")
        path = library(tmp_path, f"{name}.c", source, "-lm", "-lquadmath")
        found = checked(path, name, Claims(area_preserving=True))
        assert found.verdict is verdict, (name, found.reason)


# glibc has a `step` too, an old one: the library's own is meant.
CALLS_ITSELF = """
void step(int n, double t, double h, double *p, double *q)
{ p[0] -= h * q[0]; q[0] += h * p[0]; }
void twice(int n, double t, double h, double *p, double *q)
{ step(n, t, h / 2, p, q); step(n, t + h / 2, h / 2, p, q); }
void first_half_only(int n, double t, double h, double *p, double *q)
{ step(n, t, h / 2, p, q); }
"""


def test_a_library_calls_its_own_step_and_not_glibcs(tmp_path: Path) -> None:
    path, harmonic = library(tmp_path, "own.c", CALLS_ITSELF), Hamiltonian.parse("(p**2 + q**2)/2")
    claims = Claims(order=1, symplectic=True)
    found = judged(step_of_library(f"{path}:twice", 1, DOUBLE, 60), claims, hamiltonian=harmonic)
    assert (found.verdict, found.convergence_order) == (Verdict.MEASURED, 1), found.reason
    half = step_of_library(f"{path}:first_half_only", 1, DOUBLE, 60)
    assert judged(half, claims, hamiltonian=harmonic).verdict is Verdict.REFUTED


def test_a_library_is_loaded_beside_a_sanitizer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Which ends a program that loads with RTLD_DEEPBIND."""
    command = [needed("gcc"), "-print-file-name=libasan.so"]
    sanitizer = subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    if not Path(sanitizer).is_file():
        pytest.skip("gcc has no sanitizer here")
    path = library(tmp_path, "step.c", OF_C["double"], "-lm")
    monkeypatch.setenv("LD_PRELOAD", sanitizer)
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")
    step = step_of_library(f"{path}:step", 1, DOUBLE, 60)
    monkeypatch.delenv("LD_PRELOAD")
    assert step.evaluate((0.5, 0.25), 0.0, 0.0) == (0.5, 0.25)


HENON = """
module henon
    use, intrinsic :: iso_c_binding
contains
    subroutine step(n, t, h, p, q) bind(c)
        integer(c_int), value :: n
        real(c_double), value :: t, h
        real(c_double), intent(inout) :: p(n), q(n)
        p = p + h/2*force(q)
        q = q + h*p
        p = p + h/2*force(q)
    end subroutine
    pure function force(q) result(f)
        real(c_double), intent(in) :: q(:)
        real(c_double) :: f(size(q))
        f(1) = -q(1) - 2*q(1)*q(2)
        f(2) = -q(2) - q(1)**2 + q(2)**2
    end function
end module
"""


def test_a_step_in_fortran_is_judged_in_two_degrees_of_freedom(tmp_path: Path) -> None:
    energy = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
    exact, claims = Hamiltonian.parse(energy), Claims(order=2, symplectic=True)
    path = library(tmp_path, "henon.f90", HENON)
    found = judged(step_of_library(f"{path}:step", 2, DOUBLE, 60), claims, hamiltonian=exact)
    assert found.verdict is Verdict.MEASURED, found.reason
    assert (found.convergence_order, found.symplectic) == (2, True)
    wrong = HENON.replace("q = q + h*p", "q = q + h*p; p(1) = p(1) + h**3*q(2)")
    path = library(tmp_path, "wrong.f90", wrong)
    found = judged(step_of_library(f"{path}:step", 2, DOUBLE, 60), claims, hamiltonian=exact)
    assert found.verdict is Verdict.REFUTED
    assert found.symplectic is False


def test_a_compiled_module_of_fortran_stays_in_the_folder_of_its_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sources, elsewhere = tmp_path / "sources", tmp_path / "elsewhere"
    sources.mkdir()
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    library(sources, "henon.f90", HENON)
    assert (sources / "henon.mod").exists()
    assert list(elsewhere.iterdir()) == []


# -- bad input ------------------------------------------------------------------------------------


def test_a_library_that_does_not_load_is_told(tmp_path: Path) -> None:
    junk = tmp_path / "junk.so"
    junk.write_text("no library")
    with pytest.raises(InputError, match="does not load"):
        step_of_library(f"{junk}:step", 1, DOUBLE, 60)
    with pytest.raises(InputError, match="no file"):
        step_of_library(f"{tmp_path}/none.so:step", 1, DOUBLE, 60)
    path = library(tmp_path, "step.c", OF_C["double"], "-lm")
    with pytest.raises(InputError, match="there is no stop in it; is step meant"):
        step_of_library(f"{path}:stop", 1, DOUBLE, 60)
    for target in (path, f"{path}:", f"{path}:a-b"):
        with pytest.raises(InputError, match=r"LIB\.so:SYMBOL"):
            step_of_library(target, 1, DOUBLE, 60)


@pytest.mark.parametrize(
    ("target", "library_"),
    [("./a.so:step", True), ("liba.so.1:step", True), ("a.dylib:s", True), ("a.py:step", False),
     ("so:step", False), ("a:step", False)],
)  # fmt: skip
def test_a_library_is_known_by_its_name(target: str, library_: bool) -> None:
    assert is_library(target) is library_
