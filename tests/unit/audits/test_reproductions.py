"""What a report prints to reproduce a finding runs by itself and shows it."""

import io
from contextlib import redirect_stdout
from fractions import Fraction

import pytest

from verify.audits import reproductions
from verify.audits.libraries import literature
from verify.audits.library_claims import claims_of
from verify.schemes.printed.splitting_table import PrintedTable, judge_order
from verify.verdict import Verdict

TABLES = {integrator.name: integrator for integrator in literature.integrators()}
VERLET = """\
from math import sin


def step(p, q, h):
    p -= h / 2 * sin(q)
    q += h * p
    return p - h / 2 * sin(q), q
"""
HEUN = """\
import math


def step(p, q, h):
    a, b = -math.sin(q), p
    c, d = -math.sin(q + h * b), p + h * a
    return p + h / 2 * (a + c), q + h / 2 * (b + d)
"""


def ran(code: str) -> str:
    """What the code prints, with no name but its own."""
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(code, {})  # noqa: S102 - it is what is tested
    return printed.getvalue()


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "name", ["Blanes–Moan S10", "Blanes–Moan SRKN14a", "Yoshida 8, solution E"]
)
def test_wrong_digits_are_shown_beside_the_nearest_exact_ones(name: str) -> None:
    _, digits = claims_of(TABLES[name], "tables", "tables")
    assert digits.verdict is Verdict.REFUTED
    printed, nearest = (float(line.split()[-1]) for line in ran(digits.reproduction).splitlines())
    assert 1e-17 < printed < 1e-8
    assert nearest < 1e-35


def test_quotients_in_a_table_stay_exact() -> None:
    """With floats in it, no residue would be below 10⁻¹⁶."""
    own = TABLES["McLachlan SS5"].method
    assert isinstance(own, PrintedTable)
    off = own.read(own.printed.with_number("w2", "0.6254664284676700459"))
    found = judge_order(off, 4)
    assert found.digits is False
    assert found.nearest is not None
    code = reproductions.write_digits_program(off, found.nearest, 4)
    printed, nearest = (float(line.split()[-1]) for line in ran(code).splitlines())
    assert nearest < 1e-35 < 1e-20 < printed
    assert float(ran(code.replace("F(7)/F(25)", "7/25")).split()[-1]) > 1e-20, "so would floats"


@pytest.mark.parametrize("code", [VERLET, HEUN])
def test_a_steps_order_is_shown(code: str) -> None:
    shown = eval(ran(reproductions.write_order_program(code, (Fraction(1), Fraction(1, 2)), 4)))  # noqa: S307
    assert all(abs(slope - 3) < 0.6 for _, slope in shown)


def test_an_area_that_is_kept_and_one_that_is_not_are_shown() -> None:
    point = Fraction(1), Fraction(1, 2)
    kept, lost = (
        [abs(found - 1) for _, found in eval(ran(reproductions.write_area_program(code, point)))]  # noqa: S307
        for code in (VERLET, HEUN)
    )
    assert max(kept) < 1e-5
    assert lost[0] > 0.01


def test_where_no_step_is_given_nothing_is_shown() -> None:
    assert reproductions.write_order_program("", (Fraction(1), Fraction(1)), 4) == ""
