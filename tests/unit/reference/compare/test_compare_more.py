"""A leapfrog's half steps, single precision, and tables of several runs."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.programs.submitted_programs import (
    Program,
    drift_first,
    kick_drift_kick,
    kick_first,
    lie1,
    lie2,
    lie3,
)
from tests.unit.reference.compare.test_compare import CORNER, ORIGIN, named, of, single
from verify.reference.compare.comparison import compare
from verify.reference.compare.published_data import Published
from verify.reference.compare.run_mistakes import state_mistakes
from verify.reference.compare.setting import OrbitPoints, Setting
from verify.reference.compare.submitted_table import read


def leapfrog(q: Any, p: Any, order: Any, sign: int) -> Program:
    """p at half steps: half a kick first, from the right start or back from it."""
    return CORNER.changed(q=q, p=p - sign * 0.005 * (q + q**3), step=order)


@pytest.mark.parametrize(
    ("mistake", "order", "sign"),
    [("half-p-ahead", drift_first, 1), ("half-p-behind", kick_first, -1)],
)
def test_a_leapfrogs_half_step_is_named(
    ours: Published, tmp_path: Path, mistake: str, order: Any, sign: int
) -> None:
    found = of(ours, tmp_path, leapfrog(1.5, 1.5, order, sign), scheme="stormer-verlet", p0="1.5")
    assert named(found) == [{mistake}]
    # the same numbers as symplectic Euler's, or with half a kick too much, have no name
    for given in ({"scheme": "symplectic-euler"}, {"scheme": "stormer-verlet"}):
        wrong = leapfrog(1.5, 1.5, order, sign if "euler" in given["scheme"] else 2 * sign)
        assert not of(ours, tmp_path, wrong, p0="1.5", **given).diagnoses


def test_a_half_step_of_position_verlet_is_of_q(ours: Published) -> None:
    case = next(x for x in ours.scene("duffing") if x.run.scheme == "stormer-verlet").orbit
    found = state_mistakes(Setting(replace(case, scheme="position-verlet"), OrbitPoints({})))
    assert {x.name for x in found if x.name.startswith("half-q")} == {
        "half-q-ahead",
        "half-q-behind",
    }


@pytest.mark.parametrize("number", ["{:.9g}".format, "{:.17g}".format])
def test_single_precision_is_named_however_it_is_printed(
    ours: Published, tmp_path: Path, number: Any
) -> None:
    assert named(of(ours, tmp_path, single().changed(number=number), p0="1.5")) == [{"single"}]


def test_doubles_that_are_a_little_off_are_not_of_single_precision(
    ours: Published, tmp_path: Path
) -> None:
    """What is printed with 7 digits is of single precision whatever it is."""
    for number in ("{:.6e}".format, "{:.8e}".format, repr):
        found = of(ours, tmp_path, CORNER.changed(d=1 + 3e-7, number=number), p0="1.5")
        assert not found.diagnoses


def test_single_precision_is_seen_after_searches_in_vain(ours: Published, tmp_path: Path) -> None:
    lines = ["scheme,step,p,q"]
    for name, step in (("lie1", lie1), ("lie2", lie2), ("lie3", lie3), ("lie4", lie3)):
        rows = list(CORNER.changed(d=1.01, step=step).rows())[1:]
        lines += [f"{name},{row}" for row in rows]
    exactly = single().changed(step=kick_drift_kick, number="{:.17g}".format)
    rows = list(exactly.rows())[1:]
    lines += [f"stormer-verlet,{row}" for row in rows]
    path = tmp_path / "theirs.csv"
    path.write_text("\n".join(lines) + "\n")
    given = {"scene": "duffing", "step_size": "0.01", "q0": "1.5", "p0": "1.5"}
    found = compare(ours, read(path, ours, given, {}))
    assert named(found) == [{"single"}]
    assert len(found.unexplained) == 4


def test_a_run_that_tells_less_is_explained_by_one_that_tells_more(
    ours: Published, tmp_path: Path
) -> None:
    """From p = 0, −p and time backwards are the same; from p = 1.5 they are not."""
    lines = ["p0,step,p,q"]
    for start, program in (("0", ORIGIN), ("1.5", CORNER)):
        rows = list(program.changed(shown=lambda z: (-z[0], z[1])).rows())[1:]
        lines += [f"{start},{row}" for row in rows]
    path = tmp_path / "theirs.csv"
    path.write_text("\n".join(lines) + "\n")
    given = {"scene": "duffing", "step_size": "0.01", "q0": "1.5", "scheme": "lie2"}
    found = compare(ours, read(path, ours, given, {}))
    assert [([n for n, _ in x.mistakes], x.runs) for x in found.diagnoses] == [(["negated-p"], 2)]
