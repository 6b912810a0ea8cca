"""Which functions a library has, and what is said where the one that is asked is not among them."""

from pathlib import Path

import pytest

from tests.helpers.programs.compilers import library
from tests.unit.integrators.foreign.programs import HERE, library_step, said
from verify.errors import InputError
from verify.integrators.foreign.foreign_function import functions_of, prototype, step_of_library
from verify.integrators.user_code.user_map import (
    DOUBLE,
    DOUBLE_DOUBLE,
    FLOAT128,
    LONG_DOUBLE,
    NumberType,
)

TAKES = "(int n, double t, double h, double *p, double *q)"
IN_C = f"static void hidden(void) {{}} void step{TAKES} {{ hidden(); }} void kick(void) {{}} int x;"
IN_CPP = f"""
namespace physics {{ struct step {{}}; void init(step) {{}} }}
namespace physics {{ namespace deep {{ void kick{TAKES} {{}} }} }}
void stepper(double) {{}}
void drift{TAKES} {{}}
extern "C" void right{TAKES} {{}}
"""
IN_FORTRAN = """
subroutine Step(n, t, h, p, q)
  integer :: n
  double precision :: t, h, p(n), q(n)
  p = p - h*q
end subroutine
module steps
contains
  subroutine kick(n, t, h, p, q)
    integer :: n
    double precision :: t, h, p(n), q(n)
    p = p - h*q
  end subroutine
end module
"""
BY_POINTER = "void step(int *n, double *t, double *h, double *p, double *q) { p[*n - 1] -= *h; }"


def refused(path: str, symbol: str) -> str:
    with pytest.raises(InputError) as caught:
        step_of_library(f"{path}:{symbol}", 1, DOUBLE, 60)
    assert f"wanted: void {symbol}{TAKES}" in str(caught.value)
    return caught.value.problem


def test_the_functions_are_those_that_the_library_defines_for_others(tmp_path: Path) -> None:
    assert functions_of(library(tmp_path, "step.c", IN_C)) == ["kick", "step"]
    (tmp_path / "text.so").write_text("no library")
    assert functions_of(str(tmp_path / "text.so")) == []
    cut = Path(library(tmp_path, "cut.c", IN_C))
    cut.write_bytes(cut.read_bytes()[:5000])
    assert functions_of(str(cut)) == []


def test_a_name_that_cpp_has_written_asks_for_extern_c(tmp_path: Path) -> None:
    path = library(tmp_path, "step.cpp", IN_CPP)
    assert 'is how C++ writes drift: declare it extern "C"' in refused(path, "drift")
    assert "_ZN7physics4deep4kickE" in refused(path, "kick")
    assert 'extern "C"' in refused(path, "kick")
    with library_step(f"{path}:right", 1) as function:
        assert function(*HERE) == HERE[:2]


def test_a_name_that_only_contains_the_one_asked_for_is_not_taken_for_it(tmp_path: Path) -> None:
    """`stepper`, and a function of a class `step`. glibc's old `step` is not called either."""
    problem = refused(library(tmp_path, "step.cpp", IN_CPP), "step")
    assert "there is no step in it" in problem
    assert 'extern "C"' not in problem


@pytest.mark.parametrize("symbol", ["step", "Step", "kick"])
def test_a_name_that_fortran_has_written_asks_for_bind_c(symbol: str, tmp_path: Path) -> None:
    problem = refused(library(tmp_path, "step.f90", IN_FORTRAN), symbol)
    assert f"is how Fortran writes {symbol}: declare it bind(c)" in problem
    assert "by value" in problem


def test_near_names_are_listed(tmp_path: Path) -> None:
    path = library(tmp_path, "step.c", IN_C)
    assert "there is no stp in it; is step meant? it has: step, kick" in refused(path, "stp")
    many = library(tmp_path, "many.c", "\n".join(f"void f{k}(void) {{}}" for k in range(20)))
    assert "and 12 more" in refused(many, "step")


def test_a_library_that_crashes_is_told_its_prototype(tmp_path: Path) -> None:
    """As one does that takes pointers, which is Fortran's way."""
    for name, source in (("step.c", BY_POINTER), ("fortran.f90", IN_FORTRAN)):
        symbol = "step" if name == "step.c" else "step_"
        with library_step(f"{library(tmp_path, name, source)}:{symbol}", 1) as function:
            text = said(function.several([HERE])[0])
            assert "crashes with SIGSEGV, asked “0 0.125 0.5 0.25”" in text
            assert f"wanted: void {symbol}{TAKES}" in text


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (LONG_DOUBLE,
         "void s(int n, long double t, long double h, long double *p, long double *q)"),
        (FLOAT128,
         "void s(int n, const __float128 *t, const __float128 *h, __float128 *p, __float128 *q)"),
        (DOUBLE_DOUBLE, "void s(int n, const double *t, const double *h, double *p, double *q)"),
    ],
)  # fmt: skip
def test_the_prototype_is_that_of_the_type_and_of_the_manual(kind: NumberType, text: str) -> None:
    from tests.paths import ROOT

    assert prototype("s", kind) == text
    page = (ROOT / "docs/how-to/c-fortran-julia.md").read_text(encoding="utf-8")
    assert f"`{text.replace(' s(', ' step(')}`" in page
