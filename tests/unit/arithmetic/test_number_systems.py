"""What number systems say of themselves, before any of their libraries is imported."""

import subprocess
import sys
from fractions import Fraction

import flint
import pytest

from tests.paths import ROOT
from verify import arithmetic
from verify.arithmetic.number_system import relative
from verify.errors import InputError

SAID = """
import sys
from verify import arithmetic
assert all(arithmetic.step_cost(name) > 0 for name in (arithmetic.AUTO, *arithmetic.names()))
assert all(arithmetic.about(name).about for name in arithmetic.names())
print(sorted({"gmpy2", "flint", "mpmath", "numpy", "llvmlite"} & set(sys.modules)))
"""


@pytest.mark.parametrize(("more", "loaded"), [("", []), ("arithmetic.get('mpfr', 20)", ["gmpy2"])])
def test_asking_what_there_is_imports_no_library(more: str, loaded: list[str]) -> None:
    first, last = SAID.rsplit("print", 1)
    command = [sys.executable, "-c", f"{first}{more}\nprint{last}"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert done.stdout.strip() == str(loaded)


def test_each_is_called_as_its_file_and_has_what_it_says() -> None:
    for name in arithmetic.names():
        system = arithmetic.about(name)
        made = system.make(20)
        assert system.name == made.name == name
        assert system.digits is None or made == system.make(200)
        assert system.digits is not None or made != system.make(200)
    with pytest.raises(InputError, match="none of these"):
        arithmetic.about("none of these")


def test_auto_tries_the_faster_first_and_at_last_one_without_limits() -> None:
    *faster, last = arithmetic.automatic()
    assert [x.cost for x in faster] == sorted(x.cost for x in faster)
    assert all(x.cost < last.cost for x in faster)
    assert not last.compiles
    assert last.most_digits == float("inf")
    assert not last.make(20).absolute
    assert arithmetic.step_cost(arithmetic.AUTO) == arithmetic.automatic()[0].cost
    for system in arithmetic.automatic():  # bounds are rigorous only where rounding is known
        assert system.make(20).rounding is not None
    assert arithmetic.get("float64", 17).rounding is None


def test_relative_rounding_is_of_the_size_and_functions_may_have_more() -> None:
    own, size = relative(10, functions=8), flint.arb(3)
    assert own("mul", 0, size) == flint.arb(flint.fmpq(3, 2**10))
    assert own("sin", 0, size) == 8 * own("mul", 0, size)
    assert relative(10)("sin", 0, size) == own("add", 0, size) != Fraction(0)
