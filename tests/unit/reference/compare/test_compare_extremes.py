"""Right programs in doubles where these overflow, underflow or lose digits: none is wrong."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from verify.errors import InputError
from verify.reference.compare.comparison import TableComparison, compare
from verify.reference.compare.judge import may_overflow
from verify.reference.compare.published_data import PublishedRun, load
from verify.reference.compare.scatter import Scatter
from verify.reference.compare.submitted_table import read
from verify.reference.compare.table_agreement import ColumnVerdict, is_single, number
from verify.reference.make.data_folder import PUBLISHED

BEYOND = float("nan")
Step = Callable[[Any, Any, Any], tuple[Any, Any]]


def cube(p: Any, q: Any, h: Any) -> tuple[Any, Any]:
    p = p - h * q * q * q
    return p, q + h * p


def stiff(p: Any, q: Any, h: Any) -> tuple[Any, Any]:
    p = p - h * 1e16 * q
    return p, q + h * p


def run_of(scene: str, scheme: str, h: float, q: float) -> PublishedRun:
    inputs = (scheme, h, q)
    return next(x for x in load(PUBLISHED, scene).runs() if tuple(x.inputs.values())[:3] == inputs)


def of(
    folder: Path, run: PublishedRun, step: Step, change: Callable[[int, Any], Any]
) -> TableComparison:
    """A table of p and q by the step in doubles, p of each row changed."""
    _, h, q, p = run.inputs.values()
    lines = ["step,p,q"]
    for n in range(max(run.rows) + 1):
        if n in run.rows:
            lines.append(f"{n},{change(n, p)!r},{q!r}")
        p, q = step(p, q, h)
    path = folder / "theirs.csv"
    path.write_text("\n".join(lines) + "\n")
    own = run.run
    given = {"scheme": own.scheme, "step_size": own.step_size, "q0": own.q, "p0": own.p}
    ours = load(PUBLISHED, run.scene)
    return compare(ours, read(path, ours, {"scene": run.scene, **given}, {}))


RIGHT: dict[str, tuple[tuple[str, str, float, float], Step]] = {
    "p and q overflow": (("stiff-oscillator", "symplectic-euler", 3e-8, 1.0), stiff),
    "q³ overflows": (("extreme-quartic", "symplectic-euler", 1e-157, 1e155), cube),
    "q³ underflows": (("extreme-quartic", "symplectic-euler", 0.01, 1e-150), cube),
}


@pytest.mark.parametrize("what", RIGHT)
def test_a_right_program_is_not_called_wrong(tmp_path: Path, what: str) -> None:
    given, step = RIGHT[what]
    run = run_of(*given)
    found = of(tmp_path, run, step, lambda _, p: p)
    assert found.agrees
    assert not found.diagnoses
    assert any(x.verdict is ColumnVerdict.ROUNDING for x in found.columns)
    assert bool(found.overflows) == ("overflow" in what)


def test_what_is_not_finite_early_or_wrong_and_finite_differs(tmp_path: Path) -> None:
    run = run_of(*RIGHT["p and q overflow"][0])
    assert not of(tmp_path, run, stiff, lambda n, p: BEYOND if n == 10 else p).agrees
    assert not of(tmp_path, run, stiff, lambda n, p: 1e90 if n == 100 else p).agrees


def test_a_determinant_may_overflow_where_the_state_does_not() -> None:
    run = run_of("stiff-duffing", "symplectic-euler", 1e-5, 1.0)
    known = {n: (Fraction(getattr(run.rows[5], n).value), Fraction(0)) for n in ("p", "q")}
    assert may_overflow(run.orbit, 5, known)
    small = {n: (Fraction(getattr(run.rows[1], n).value), Fraction(0)) for n in ("p", "q")}
    assert not may_overflow(run.orbit, 1, small)


def test_a_number_on_the_way_may_overflow_where_none_of_the_run_does() -> None:
    """q³ = 10⁴⁶⁵ where q = 10¹⁵⁵, in the next step; a step that solves equations is not done."""
    orbit = run_of("extreme-quartic", "symplectic-euler", 1e-157, 1e155).orbit
    known = {"p": (Fraction(0), Fraction(0)), "q": (Fraction(10) ** 155, Fraction(0))}
    assert may_overflow(orbit, 0, known)
    assert may_overflow(orbit, 0, {})
    assert not may_overflow(replace(orbit, scheme="implicit-midpoint"), 0, known)
    small = run_of("extreme-quartic", "symplectic-euler", 0.01, 1e-150).orbit
    assert not may_overflow(small, 0, {})


def test_a_large_angle_scatters_p_as_much_as_doubles_do() -> None:
    """q = 10⁸ is known to 10⁻⁸ in doubles, and so is the force after one step; h = 0.01."""
    run = run_of("extreme-pendulum-top", "lie2", 0.01, 1e8)
    spreads = Scatter([run.orbit]).spreads_at(0, 100)
    assert spreads is not None
    assert spreads["p"].worst > 1e7


def test_numbers_beyond_single_precision_are_none() -> None:
    assert not is_single(Fraction(10) ** 60, Fraction(0))
    assert not is_single(Fraction(10) ** 400, Fraction(0))
    assert is_single(Fraction(1, 2), Fraction(0))


@pytest.mark.parametrize("scene", ["extreme-quartic", "stiff-oscillator"])
def test_the_datas_own_numbers_agree_beyond_all_sizes_of_doubles(scene: str) -> None:
    ours = load(PUBLISHED, scene)
    found = compare(ours, read(PUBLISHED / f"{scene}-runs.csv", ours, {"scene": scene}, {}))
    assert {x.verdict for x in found.columns} == {ColumnVerdict.AGREES}


@pytest.mark.parametrize(("text", "value"), [("1e4000", 4000), ("1.0E-4000", -4000)])
def test_an_exponent_may_be_large(text: str, value: int) -> None:
    assert number(text, "p") == Fraction(10) ** value


def test_an_exponent_may_not_be_huge() -> None:
    with pytest.raises(InputError, match="exponent"):
        number("1e100000", "p")


RIM = "9999999999999999999999/10000000000000000000000"  # q = 1 is an unstable equilibrium


def soft(folder: Path, rows: str) -> TableComparison:
    ours = load(PUBLISHED, "extreme-soft-duffing")
    path = folder / "theirs.csv"
    path.write_text(f"step,p,q\n{rows}\n")
    given = {"scene": "extreme-soft-duffing", "scheme": "lie4", "q0": RIM}
    return compare(ours, read(path, ours, given, {}))


@pytest.mark.left_to_ci
def test_where_a_run_is_lost_nothing_is_said(tmp_path: Path) -> None:
    """Neither of a number that is not finite nor of its digits."""
    found = soft(tmp_path, "0,0,1\n4000,nan,7")
    assert found.agrees
    assert list(found.lost.values()) == [4000]
    assert all(x.rows == 1 and x.digits > 15 for x in found.columns)
    found = soft(tmp_path, "4000,nan,7")
    assert {x.verdict for x in found.columns} == {ColumnVerdict.LOST}


def test_an_equilibrium_in_doubles_is_not_single_precision(tmp_path: Path) -> None:
    rows = "\n".join(f"{n},0,{q}" for n, q in ((0, 1), (1, "1.000000000000000000"), (100, 1)))
    found = soft(tmp_path, rows)
    assert found.agrees


def test_swapped_columns_scatter_as_what_stands_in_them(tmp_path: Path) -> None:
    """A free particle: rounding moves its q far, and its p not at all."""
    ours = load(PUBLISHED, "extreme-free")
    p, q, rows = 1.0, 0.0, ["step,p,q"]
    for n in range(5001):
        if n in (0, 1, 100, 5000):
            rows.append(f"{n},{q!r},{p!r}")
        q += 0.1 * (p + p * p * p)
    path = tmp_path / "theirs.csv"
    path.write_text("\n".join(rows) + "\n")
    found = compare(ours, read(path, ours, {"scene": "extreme-free", "scheme": "lie2"}, {}))
    assert [[n for n, _ in x.mistakes] for x in found.diagnoses] == [["swapped-columns"]]


def test_one_point_of_an_orbit_that_is_lost_then_names_no_mistake(tmp_path: Path) -> None:
    """(0, 1) is a fixed point for δ = −1, so unstable at h = 100 that all later rows are lost."""
    ours = load(PUBLISHED, "extreme-duffing")
    path = tmp_path / "theirs.csv"
    path.write_text("step,p,q\n1,0.0,1.0\n2,-200.0,1.0\n4,1e30,1e60\n")
    for scheme in ("lie4", "stormer-verlet"):
        given = {"scene": "extreme-duffing", "scheme": scheme, "step_size": "100", "q0": "1"}
        found = compare(ours, read(path, ours, given, {}))
        assert not found.agrees
        assert not found.diagnoses
