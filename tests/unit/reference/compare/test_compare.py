"""Tables of other people's programs: each mistake is named, and no other."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from tests.helpers.programs.submitted_programs import (
    Areas,
    HeilesProgram,
    Program,
    drift_first,
    drift_kick_drift,
    kick_drift_kick,
    lie1,
    lie3,
)
from verify.reference.compare.comparison import TableComparison, compare
from verify.reference.compare.published_data import Published
from verify.reference.compare.run_mistakes import state_mistakes
from verify.reference.compare.setting import OrbitPoints, Setting, readings
from verify.reference.compare.submitted_table import read
from verify.reference.compare.table_agreement import ColumnVerdict

AnyProgram = Program | HeilesProgram
HEILES = HeilesProgram()
ORIGIN = Program()
CORNER = Program(p=1.5)


def of(
    ours: Published, folder: Path, program: AnyProgram, table: str = "", **given: str
) -> TableComparison:
    path = folder / "theirs.csv"
    path.write_text(table or program.table())
    said = {"scene": "heiles", "scheme": "lie2"}
    if isinstance(program, Program):
        said |= {"scene": "duffing", "step_size": "0.01", "q0": "1.5", "p0": str(program.p)}
    return compare(ours, read(path, ours, said | given, {}))


def named(found: TableComparison) -> list[set[str]]:
    return [{name for name, _ in x.mistakes} for x in found.diagnoses]


# -- mistakes --------------------------------------------------------------------------------------

CONTEXT = mpmath.MPContext()
CONTEXT.dps = 40


def precise(h: str | float) -> Program:
    exact = CONTEXT.mpf(Fraction(h).numerator) / Fraction(h).denominator
    one = CONTEXT.mpf(1)
    return Program(
        h=exact, q=one * 3 / 2, p=one * 0, d=one, number=lambda x: CONTEXT.nstr(x, 28)
    )  # fmt: skip


def single() -> Program:
    one = np.float32
    return Program(h=one(0.01), q=one(1.5), p=one(1.5), d=one(1), number="{:.9g}".format)


MISTAKES = {
    "double-h": precise(0.01),
    "single": single(),
    "swapped-columns": ORIGIN.changed(shown=lambda z: z[::-1]),
    "swapped-start": Program(q=0.0, p=1.5),
    "swapped-throughout": Program(q=0.0, p=1.5, shown=lambda z: z[::-1]),
    "negated-p": CORNER.changed(shown=lambda z: (-z[0], z[1])),
    "negated-start": CORNER.changed(p=-1.5),
    "backwards": CORNER.changed(h=-0.01),
    "late+1": CORNER.changed(late=1),
    "late-1": CORNER.changed(late=-1),
    "half-step": CORNER.changed(h=0.005),
    "double-step": CORNER.changed(h=0.02),
    "single-h": CORNER.changed(h=float(np.float32(0.01))),
    "minus-delta": CORNER.changed(d=-1.0),
    "no-delta": CORNER.changed(d=0.0),
    "scheme lie1": CORNER.changed(step=lie1),
    "scheme lie3": CORNER.changed(step=lie3),
    "scheme stormer-verlet": CORNER.changed(step=kick_drift_kick),
}


def test_an_initial_value_that_is_a_double_is_named(ours: Published, tmp_path: Path) -> None:
    program = precise("1/100")
    found = of(ours, tmp_path, program.changed(q=CONTEXT.mpf(0.1)), q0="0.1")
    assert named(found) == [{"double-q0"}]
    both = precise(0.01).changed(q=CONTEXT.mpf(0.1))
    assert named(of(ours, tmp_path, both, q0="0.1")) == [{"double-h-q0"}]


STARTS = {"swapped-start": "0", "swapped-throughout": "0", "negated-start": "1.5"}


MISTAKES_IN_DEGREES = {
    "degrees-1-2": HEILES.changed(columns="p2,p1,q2,q1"),
    "swapped": HEILES.changed(columns="q1,q2,p1,p2"),
    "sign-of-p": HEILES.changed(sign=-1),
    "late+1": HEILES.changed(late=1),
    "scheme-lie1": HEILES.changed(eta=1),
    "product": HEILES.changed(less=0.0),
}


@pytest.mark.parametrize(
    ("name", "program"), [*MISTAKES.items(), *MISTAKES_IN_DEGREES.items()],
    ids=[*MISTAKES, *(f"{name} in degrees" for name in MISTAKES_IN_DEGREES)],
)  # fmt: skip
def test_a_mistake_is_named(
    each_ours: dict[type, Published], tmp_path: Path, name: str, program: AnyProgram
) -> None:
    table, options = program.table(), {}
    if isinstance(program, Program):
        table = program.table((1, 10, 100) if name == "late-1" else (0, 1, 10, 100))
        options = {"p0": STARTS.get(name, str(float(program.p)))}
    found = of(each_ours[type(program)], tmp_path, program, table, **options)
    assert named(found) == [{name}]
    assert not found.agrees
    assert not found.unexplained


@pytest.mark.parametrize(
    ("scheme", "step", "mistake"),
    [("symplectic-euler", drift_first, "scheme drift 1; kick 1"),
     ("stormer-verlet", drift_kick_drift, "scheme position-verlet")],
)  # fmt: skip
def test_the_other_kind_of_a_splitting_is_named(
    ours: Published, tmp_path: Path, scheme: str, step: Any, mistake: str
) -> None:
    found = of(ours, tmp_path, CORNER.changed(step=step), scheme=scheme)
    assert named(found) == [{mistake}]


OTHER_AREAS: dict[str, tuple[str, Callable[[Areas], Any]]] = {
    "product": ("lam", lambda x: x.product),
    "sum": ("lam", lambda x: x.total),
    "negated-lambda": ("lam", lambda x: 1 - x.product),
    "inverse": ("lam", lambda x: 1 / x.product - 1),
    "second-first": ("lam", lambda x: x.product * x.now / x.first - 1),
    "lambda+1": ("lam", lambda x: x.product * x.now - 1),
    "lambda-1": ("lam", lambda x: x.product / x.before - 1 if x.n else None),
    "root": ("mse", lambda x: (x.squares / x.n) ** 0.5 if x.n else None),
    "whole-sum": ("mse", lambda x: x.squares),
    "one-more": ("mse", lambda x: x.squares / (x.n + 1) if x.n else None),
    "one-less": ("mse", lambda x: x.squares / (x.n - 1) if x.n > 1 else None),
    "mse second-first": (
        "mse", lambda x: (x.squares + (x.now - 1) ** 2 - (x.first - 1) ** 2) / x.n if x.n else None
    ),
    "mse+1": ("mse", lambda x: (x.squares + (x.now - 1) ** 2) / (x.n + 1) if x.n else None),
    "mse-1": (
        "mse", lambda x: (x.squares - (x.before - 1) ** 2) / (x.n - 1) if x.n > 1 else None
    ),
    "determinant": ("delta_j", lambda x: x.now),
    "delta_j inverse": ("delta_j", lambda x: 1 / x.now - 1),
    "delta_j+1": ("delta_j", lambda x: x.after - 1),
    "negated": ("delta_j", lambda x: 1 - x.now),
    "delta_j-1": ("delta_j", lambda x: x.before - 1 if x.n else None),
}  # fmt: skip


@pytest.mark.parametrize("name", OTHER_AREAS)
def test_another_reading_of_an_area_error_is_named(
    ours: Published, tmp_path: Path, name: str
) -> None:
    column, reading = OTHER_AREAS[name]
    found = of(ours, tmp_path, CORNER.changed(**{column: reading}))
    assert named(found) == [{name.removeprefix("mse ").removeprefix("delta_j ")}]
    assert [x.verdict for x in found.columns] == [
        ColumnVerdict.ROUNDING,
        ColumnVerdict.ROUNDING,
        ColumnVerdict.MORE,
    ]


def test_every_mistake_has_its_table(ours: Published) -> None:
    run = next(x for x in ours.scene("duffing") if x.run.scheme == "lie2" and x.run.p == "1.5")
    names = {x.name for x in state_mistakes(Setting(run.orbit, OrbitPoints({})))}
    assert {n for n in names if not n.startswith("scheme ")} == {
        n for n in MISTAKES if not n.startswith("scheme ") and n not in ("double-h", "single")
    }
    for column, field in (("lambda", "lam"), ("mse", "mse"), ("delta_j", "delta_j")):
        tried = {n.split(" ")[-1] for n, (own, _) in OTHER_AREAS.items() if own == field}
        assert {name for name, _, _ in readings(column)} == tried


# -- what cannot be told ---------------------------------------------------------------------------


def test_two_mistakes_that_give_the_same_numbers_are_both_named(
    ours: Published, tmp_path: Path
) -> None:
    """From p = 0, with H even in p, time that runs backwards is p with the other sign."""
    found = of(ours, tmp_path, ORIGIN.changed(h=-0.01))
    assert named(found) == [{"negated-p", "backwards"}]


def test_a_table_of_the_start_alone_says_nothing(ours: Published, tmp_path: Path) -> None:
    for step in (lie1, lie3, drift_first):
        program = CORNER.changed(step=step)
        assert of(ours, tmp_path, program, program.table((0,))).agrees


def test_one_step_may_not_tell_two_schemes_apart(ours: Published, tmp_path: Path) -> None:
    """From p = 0 with q alone: after one step of lie1 q stands where it was."""
    table = "step,q\n1,1.5\n"
    found = of(ours, tmp_path, ORIGIN, table, scheme="lie2")
    assert not found.agrees
    assert all(len(x.mistakes) > 1 for x in found.diagnoses)


@pytest.mark.parametrize(
    "program",
    [CORNER.changed(d=1.001), CORNER.changed(h=0.0101), CORNER.changed(q=1.4),
     HEILES.changed(off=1e-11)],
    ids=["d", "h", "q", "the state in degrees"],
)  # fmt: skip
def test_an_unknown_mistake_is_not_given_a_name(
    each_ours: dict[type, Published], tmp_path: Path, program: AnyProgram
) -> None:
    found = of(each_ours[type(program)], tmp_path, program)
    assert not found.agrees
    assert not found.diagnoses
    assert len(found.unexplained) == 1


def test_one_wrong_number_among_right_ones_is_no_mistake_of_the_whole(
    ours: Published, tmp_path: Path
) -> None:
    lines = CORNER.table().splitlines()
    lines[2] = lines[2].replace("1.", "1.0", 1)
    found = of(ours, tmp_path, CORNER, "\n".join(lines))
    assert not found.agrees
    assert not found.diagnoses
    parts = [x.parts_at for x in found.columns if x.verdict is ColumnVerdict.MORE]
    assert parts == [1]


def test_what_is_not_finite_differs(ours: Published, tmp_path: Path) -> None:
    table = CORNER.table().replace(CORNER.table().splitlines()[3].split(",")[1], "nan")
    found = of(ours, tmp_path, CORNER, table)
    assert not found.agrees
    assert not found.diagnoses
