"""The elementary functions' objects: derivatives, values, and that each is in one file."""

import re
from fractions import Fraction
from typing import Any

import gmpy2
import mpmath
import numpy as np
import pytest
from mpmath.ctx_mp import MPContext

from tests.helpers.function_values import off
from tests.paths import ROOT
from verify import arithmetic, functions
from verify.algebra.formula import FUNCTIONS, function, parse
from verify.flows.extrapolation_of_many import arrays
from verify.functions.function import Function
from verify.integrators.tracing.dual import slope_of

BY_NAME = functions.by_name()
MP = MPContext()
MP.dps = 60
PLACES = [Fraction(n, 7) for n in (-9, -2, 1, 5, 12)]
SYSTEMS = [("float64", 17), ("mpmath", 50), ("mpfr", 50), ("ball", 50), ("fixed", 30)]


def value_of(name: str, x: Any) -> Any:
    """A function of a number of mpmath's."""
    return 1 / x if name == "inverse" else getattr(MP, name)(x)


def inside(f: Function, x: Fraction) -> bool:
    return f.domain is None or f.domain.relation == "!=" or f.domain.inside(x) > 0


def number(x: Fraction) -> Any:
    return MP.mpf(x.numerator) / x.denominator


# -- what the objects say -------------------------------------------------------------------------


def test_formulas_have_these_functions_and_no_others() -> None:
    assert [*functions.names()] == [*FUNCTIONS] == sorted(BY_NAME)
    for name, f in BY_NAME.items():
        assert f.name == name
        assert parse(f"{name}(q)").has(function(name)) or name == "sqrt"


@pytest.mark.parametrize("name", BY_NAME)
def test_the_derivative_is_that_of_mpmath(name: str) -> None:
    f = BY_NAME[name]
    for place in filter(lambda x: inside(f, x), PLACES):
        x = number(place)
        slope = f.derivative(x, value_of(name, x), value_of)
        assert abs(slope - MP.diff(lambda y: value_of(name, y), x)) < MP.mpf(10) ** -25
        assert f.lipschitz is None or abs(slope) <= f.lipschitz
        assert not f.bounded or abs(value_of(name, x)) <= 1
        if f.positive is not False:
            where = True if f.positive is True else f.positive(place) > 0
            assert (value_of(name, x) > 0) == where


@pytest.mark.parametrize("name", BY_NAME)
def test_the_slope_of_dual_numbers_is_the_derivative(name: str) -> None:
    f = BY_NAME[name]
    with gmpy2.context(precision=150):
        for place in filter(lambda x: inside(f, x), PLACES):
            x = gmpy2.mpfr(gmpy2.mpq(place))
            slope = slope_of(name, x, getattr(gmpy2, name)(x))
            gap = MP.mpf(str(slope)) - MP.diff(lambda y: value_of(name, y), number(place))
            assert abs(gap) < MP.mpf(10) ** -25


@pytest.mark.parametrize("name", [n for n, f in BY_NAME.items() if f.pair and f.parts])
def test_a_function_of_a_pair_is_made_of_its_parts(name: str) -> None:
    f, x = BY_NAME[name], MP.mpf("0.7")
    assert f.pair
    assert f.parts
    whole = f.parts(value_of(f.pair.odd, x), value_of(f.pair.even, x), lambda y, z: y / z)
    assert abs(whole - value_of(name, x)) < MP.mpf(10) ** -50


@pytest.mark.parametrize(("system", "digits"), SYSTEMS)
@pytest.mark.parametrize("name", functions.in_rings())
def test_every_number_system_has_it_as_mpmath_does(name: str, system: str, digits: int) -> None:
    numbers = arithmetic.get(system, digits)
    if name not in numbers.functions:
        assert numbers.absolute
        assert BY_NAME[name].fixed is None
        return
    for place in filter(lambda x: inside(BY_NAME[name], x), PLACES):
        assert off(numbers, name, place) < Fraction(1, 2 ** (min(numbers.bits, 180) - 5))


@pytest.mark.parametrize("name", functions.in_rings())
def test_arrays_of_long_doubles_have_it(name: str) -> None:
    places = np.array([float(x) for x in PLACES if inside(BY_NAME[name], x)], dtype=np.longdouble)
    for value, x in zip(arrays().functions[name](places), places, strict=True):
        exact = float(value_of(name, MP.mpf(float(x))))
        assert abs(float(value) - exact) < 1e-15 * max(1, abs(exact))


# -- one file -------------------------------------------------------------------------------------

CHECKER = "verify/reference/check/tape.py"  # which shares nothing with the rest


def files_that_name(pattern: str) -> set[str]:
    word = re.compile(rf"(?<![\w.]){pattern}(?!\w)")
    return {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "verify").rglob("*.py")
        if word.search(path.read_text(encoding="utf-8"))
    }


def test_a_function_is_named_in_its_own_file_and_where_it_is_checked() -> None:
    """So adding one touches two files."""
    assert files_that_name("(?:arc|a|ar)sinh") == {
        "verify/functions/elementary/asinh.py",
        CHECKER,
    }


def test_others_that_name_a_function_are_made_of_it_alone() -> None:
    assert files_that_name("(?:a|arc)tan") == {
        "verify/functions/elementary/atan.py",
        CHECKER,
        "verify/reference/check/taylor.py",  # the checker's own recurrence
        "verify/algebra/identities/angles.py",  # what is true of arctangents alone
        "verify/algebra/hidden_zero.py",
        "verify/algebra/node_mistakes.py",  # asin and acos, as a formula writes them
        "verify/algebra/ring.py",  # its text
        "verify/integrators/tracing/named_functions.py",  # arcsin, arctan2
        "verify/integrators/tracing/traced_number.py",  # its text
    }


def test_no_library_is_imported_for_the_objects() -> None:
    heavy = {"gmpy2", "flint", "mpmath", "sympy", "numpy", "llvmlite"}
    for path in (ROOT / "verify" / "functions").rglob("*.py"):
        assert not heavy & set(re.findall(r"(?:import|from) (\w+)", path.read_text()))
    assert mpmath.mp.dps == 15, "and mpmath's own context is left alone"
