"""A printed table as a scheme, and Butcher's tableau as its text."""

from pathlib import Path

import pytest

from verify import schemes
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tables.table_scheme import scheme_from_file
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.conditions.tree_conditions import TreeConditions

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
RK4 = "0 |; 1/2 | 1/2; 1/2 | 0 0.5; 1 | 0 0 1; | 1/6 1/3 1/3 1/6; order 4"
GAUSS = (
    "1/2 - sqrt(3)/6 | 1/4 1/4-sqrt(3)/6; 1/2+sqrt(3)/6 | 1/4+sqrt(3)/6 1/4; | 1/2 1/2; order 4"
).replace(" - ", "-")


def test_an_explicit_tableau_is_the_scheme_that_it_is_of() -> None:
    ours, rk4 = schemes.get(RK4), schemes.get("rk4")
    assert (ours.every_h, ours.order, ours.explicit) == (rk4.every_h, 4, True)
    assert isinstance(ours.every_h, RungeKutta)
    assert schemes.get(RK4.replace("0.5", "1/2")).every_h == ours.every_h
    assert schemes.get(schemes.get(f"mine: {RK4}").name).every_h == ours.every_h


def test_an_implicit_one_too() -> None:
    ours, gauss = schemes.get(GAUSS), schemes.get("gauss4")
    assert isinstance(ours.every_h, TreeConditions)
    assert (ours.order, ours.explicit) == (4, False)
    assert all(condition.holds for condition in ours.every_h.order_conditions(4))
    assert all(condition.holds for condition in ours.every_h.area_conditions())
    planted = schemes.get(GAUSS.replace("1/4-", "1/5-").replace("1/2-", "9/20-"))
    assert not all(condition.holds for condition in planted.every_h.area_conditions())  # type: ignore[union-attr]
    assert gauss.every_h is not None


WRONG = {
    "0 |; 1/2 | 1; | 1/2 1/2": "1 \\+ 0 is 1, not 1/2; a row adds up to its time",
    "0 |; 1 | 1; | 1/2 1/3": "1/2 \\+ 1/3 is 5/6, not 1; a row adds up",
    "0 |; 1 | 1 2 3; | 1/2 1/2": "stage 2 has 3 entries; allowed: 1, 2 or 2",
    "0 |; 1 | 1; 1/2 1/2": "order 1/2 1/2: is not a whole number",
    "| 1": "the weights last",
    "0 |; 1 | 1; 1 | 1 0": "the weights last",
    "0 |; 1 | x; | 1/2 1/2": "unknown name 'x'",
    "0 |; 1 | 1 | 2; | 1/2 1/2": "the weights last",
    "; ".join(["0 |"] * 21) + "; |" + " 1" * 21: "the weights last",
}


@pytest.mark.parametrize("text", WRONG)
def test_what_is_no_tableau_is_said_in_a_line(text: str) -> None:
    with pytest.raises(InputError, match=WRONG[text]):
        schemes.get(text)


TABLES = {
    "kind = 'runge-kutta'\norder = 2\ntableau = '''\n0 |\n1/2 | 1/2\n---+---\n  | 0 1\n'''":
        "Heun-s-2: 0 | 0 0; 1/2 | 1/2 0; | 0 1; order 2",
    "kind = 'runge-kutta'\nnumbers = { g = '1 - sqrt(2)/2' }\na = [['g'], ['1 - g', 'g']]\n"
    "b = ['1 - g', 'g']":
        "Heun-s-2: 1-sqrt(2)/2 | 1-sqrt(2)/2 0; 1 | sqrt(2)/2 1-sqrt(2)/2; "
        "| sqrt(2)/2 1-sqrt(2)/2",
    "kind = 'splitting'\norder = 2\nfirst = 'drift'\nhalf = ['0.5', 1]\ntimes = ['-', '1/2', '-']":
        "Heun-s-2: drift 1/2; kick 1 at 1/2; drift 1/2; order 2",
}  # fmt: skip


@pytest.mark.parametrize("table", TABLES)
def test_a_file_is_read_as_check_table_reads_it(tmp_path: Path, table: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(f'[[table]]\nname = "Heun\'s 2"\n{table}\n', "utf-8")
    text = scheme_from_file(path)
    assert text == TABLES[table]
    assert schemes.get(text).step_map(PENDULUM) is not None


def test_a_file_of_several_or_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    one = '[[table]]\nname = "{}"\nkind = "composition"\nsizes = ["1"]\n'
    path.write_text(one.format("a") + one.format("b"), "utf-8")
    with pytest.raises(InputError, match="holds 2 tables; a scheme is one"):
        scheme_from_file(path)
    path.write_text(one.format("a"), "utf-8")
    with pytest.raises(InputError, match="is a table of kind composition; allowed: runge-kutta"):
        scheme_from_file(path)
