"""Tables of right programs: rounding alone is between them and the data, and no mistake."""

from collections.abc import Callable, Mapping
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.programs.submitted_programs import (
    Areas,
    HeilesProgram,
    Program,
    kick_drift_kick,
    kick_first,
    lie1,
    lie2,
    lie3,
)
from tests.unit.reference.compare.test_compare import (
    CORNER,
    ORIGIN,
    AnyProgram,
    of,
    precise,
)
from verify.reference.compare.published_data import Published
from verify.reference.compare.table_agreement import ColumnVerdict

ALL_AREAS: Mapping[str, Callable[[Areas], Any]] = {
    "delta_j": lambda x: x.now - 1,
    "mse": lambda x: x.squares / x.n if x.n else None,
    "lam": lambda x: x.product - 1,
}


RIGHT = [
    (scheme, Program(step=step, p=p, h=float(h)), h)
    for h, p, (scheme, step) in product(
        ("0.001", "0.01"),
        (0.0, 1.5),
        [("lie1", lie1), ("lie2", lie2), ("lie3", lie3), ("symplectic-euler", kick_first),
         ("stormer-verlet", kick_drift_kick)],
    )
]  # fmt: skip


@pytest.mark.parametrize(
    ("scheme", "program", "h"), [*RIGHT, ("lie2", HeilesProgram(), "0.05")],
    ids=[*(f"{h}-{program.p}-{scheme}" for scheme, program, h in RIGHT), "degrees"],
)  # fmt: skip
def test_a_right_program_differs_by_rounding(
    each_ours: dict[type, Published], tmp_path: Path, scheme: str, program: AnyProgram,
    h: str,
) -> None:  # fmt: skip
    ours, planar = each_ours[type(program)], isinstance(program, Program)
    steps = (0, 1, 10, 100, 1000) if planar else range(22)
    found = of(ours, tmp_path, program, program.table(steps), scheme=scheme, step_size=h)
    assert found.agrees
    assert not found.diagnoses
    assert found.rows == (5 if planar else 3)
    assert len(found.columns) == (2 if planar else 8)
    assert {x.verdict for x in found.columns} == {ColumnVerdict.ROUNDING}
    assert all(x.digits > (11 if planar else 14) for x in found.columns if x.name[0] in "pq")


def test_a_plain_area_differs_by_rounding_and_its_separation_is_told(
    ours: Published, tmp_path: Path
) -> None:
    found = of(ours, tmp_path, ORIGIN.changed(**ALL_AREAS))
    assert found.agrees
    assert len(found.columns) == 5
    assert all(x.verdict is ColumnVerdict.ROUNDING for x in found.columns)
    assert found.separated is not None
    parts = found.separated.result.plain
    assert parts is not None
    total = abs(float(parts.parts.total.value))
    assert 0 < found.separated.apart < 100 * total < 1e-12


@pytest.mark.parametrize("digits", [3, 6, 9])
def test_a_program_that_prints_few_digits_agrees_in_all_of_them(
    ours: Published, tmp_path: Path, digits: int
) -> None:
    for form in (f"{{:.{digits}f}}", f"{{:.{digits}e}}"):
        found = of(ours, tmp_path, CORNER.changed(number=form.format))
        assert [x.verdict for x in found.columns] == [ColumnVerdict.AGREES] * 2


def test_the_last_printed_digit_is_looked_at(ours: Published, tmp_path: Path) -> None:
    table = CORNER.changed(number="{:.6f}".format).table()
    last = table.splitlines()[-1]
    wrong = last[:-3] + str((int(last[-3]) + 5) % 10) + last[-2:]
    found = of(ours, tmp_path, CORNER, table.replace(last, wrong))
    assert not found.agrees
    assert not found.diagnoses
    assert len(found.unexplained) == 1


def test_forty_digits_agree_where_h_is_exact(ours: Published, tmp_path: Path) -> None:
    found = of(ours, tmp_path, precise("1/100"))
    assert found.agrees
    assert {x.verdict for x in found.columns} == {ColumnVerdict.AGREES}


def test_thirty_digits_of_a_double_are_a_double(ours: Published, tmp_path: Path) -> None:
    found = of(ours, tmp_path, CORNER.changed(number="{:.29e}".format))
    assert found.agrees
    assert not found.diagnoses
    assert {x.verdict for x in found.columns} == {ColumnVerdict.ROUNDING}


def test_exponents_may_be_fortrans(ours: Published, tmp_path: Path) -> None:
    found = of(ours, tmp_path, CORNER.changed(number=lambda x: f"{x:.16e}".replace("e", "D")))
    assert {x.verdict for x in found.columns} == {ColumnVerdict.ROUNDING}
