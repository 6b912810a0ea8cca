"""Splittings with wrong clocks, by name: their times, their orders, and what is no such name."""

from fractions import Fraction

import pytest
import sympy

from verify import schemes
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import convergence_of
from verify.schemes.conditions.splitting_conditions import Splitting

HALF = sympy.Rational(1, 2)
DRIVEN = Hamiltonian.parse("p**2/2 + q**4/4 - q*cos(t)")


def every_h(name: str) -> Splitting:
    found = schemes.get(name).every_h
    assert isinstance(found, Splitting)
    return found


@pytest.mark.parametrize(
    ("clock", "wanted"),
    [("frozen", (0, 0, 0)), ("at the end", (1, 1, 1)), ("exchanged", (0, 0, HALF))],
)
def test_the_times_of_verlet(clock: str, wanted: tuple[object, ...]) -> None:
    assert every_h(f"leapfrog, clock {clock}").times == wanted
    assert every_h("stormer-verlet").all_times == (0, HALF, 1)


@pytest.mark.parametrize("clock", ["frozen", "at the end", "exchanged"])
@pytest.mark.parametrize("base", ["stormer-verlet", "forest-ruth", "blanes-moan4"])
def test_they_keep_their_order_without_time_and_have_order_1_with_it(base: str, clock: str) -> None:
    name, claimed = f"{base}, clock {clock}", schemes.get(base).order
    still, timed = prove_for_every_h(name), prove_for_every_h(name, timed=True)
    assert (still.verdict, still.convergence_order) == ("PROVED", claimed)
    assert (timed.verdict, timed.convergence_order) == ("REFUTED", 1)
    assert "as if" in str(timed.reason)
    assert convergence_of(schemes.get(name).step_map(DRIVEN)).order == 1
    assert convergence_of(schemes.get(base).step_map(DRIVEN)).order == claimed


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("gauss4, clock frozen", "has no such clocks"),
        ("lie2, clock exchanged", "clock exchanged: unknown; allowed: frozen, at the end"),
        ("verlet, clock broken", "clock broken: unknown"),
        ("nonsense, clock frozen", "nonsense: unknown"),
        ("verlet, clock", "unknown"),
    ],
)
def test_another_name_is_refused_in_one_line(name: str, problem: str) -> None:
    with pytest.raises(InputError) as error:
        schemes.get(name)
    assert problem in str(error.value)
    assert "\n" not in str(error.value)


def test_the_name_is_read_back() -> None:
    name = schemes.get("Verlet,  clock  at the   end").name
    assert name == "stormer-verlet, clock at the end"
    assert schemes.get(name).name == name
    assert schemes.get(name).order == Fraction(2)
