"""Tables of programs with a driven force: a wrong clock is named, and a right one never is.

The programs are written out by hand, in doubles, for two scenes of the reference data.
"""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.unit.reference.compare.test_compare import named
from verify.errors import InputError
from verify.reference.compare.comparison import TableComparison, compare
from verify.reference.compare.published_data import Published, load
from verify.reference.compare.submitted_table import read
from verify.reference.compare.table_agreement import ColumnVerdict
from verify.reference.make.data_folder import PUBLISHED

H, STEPS = 0.01, 100
Force = Callable[[float, float], float]
Step = Callable[[float, float, float], tuple[float, float]]
FROZEN, AT_THE_END = "clock frozen", "clock at the end"


def well(q: float, t: float) -> float:
    return q - q**3 + 0.3 * math.cos(1.2 * t)


def mathieu(q: float, t: float) -> float:
    return -(1.2 - 0.6 * math.cos(2 * t)) * q


def verlet(force: Force, first: float = 0, last: float = 1) -> Step:
    def step(p: float, q: float, t: float) -> tuple[float, float]:
        p += H / 2 * force(q, t + first * H)
        q += H * p
        return p + H / 2 * force(q, t + last * H), q

    return step


def rk4(force: Force, clock: tuple[float, ...] = (0, 0.5, 0.5, 1)) -> Step:
    def step(p: float, q: float, t: float) -> tuple[float, float]:
        slopes, z = [], (p, q)
        for share, c in zip((0.5, 0.5, 1, 0), clock, strict=True):
            slopes.append((force(z[1], t + c * H), z[0]))
            z = p + share * H * slopes[-1][0], q + share * H * slopes[-1][1]
        (a, b, c, d) = slopes
        return tuple(x + H / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) for i, x in enumerate((p, q)))  # type: ignore[return-value]

    return step


def lie2(by_t: bool) -> Step:
    """For `well`: with ∂f/∂t in D f, or with X f alone."""

    def step(p: float, q: float, t: float) -> tuple[float, float]:
        f = well(q, t)
        change = (1 - 3 * q * q) * p - by_t * 0.36 * math.sin(1.2 * t)
        return p + H * f + H * H / 2 * change, q + H * p + H * H / 2 * f

    return step


def table(step: Step, start: tuple[float, float], t0: float, adds: bool = False) -> str:
    """`adds`: the program's clock is t ← t + h, and not t0 + n h."""
    (p, q), t, rows = start, t0, ["step,p,q"]
    for n in range(STEPS + 1):
        rows.append(f"{n},{p!r},{q!r}")
        p, q = step(p, q, t)
        t = t + H if adds else t0 + (n + 1) * H
    return "\n".join(rows) + "\n"


@pytest.fixture(scope="module")
def ours() -> Published:
    return load(PUBLISHED, None)


WELL = {"scene": "driven-duffing", "step_size": "0.01", "q0": "0.5", "p0": "-0.5"}
MATHIEU = {"scene": "driven-mathieu", "step_size": "0.01", "q0": "1", "p0": "0"}


def of(ours: Published, folder: Path, text: str, **given: str) -> TableComparison:
    path = folder / "theirs.csv"
    path.write_text(text)
    return compare(ours, read(path, ours, given, {}))


@pytest.mark.parametrize("adds", [False, True])
@pytest.mark.parametrize(
    ("scheme", "step"), [("stormer-verlet", verlet(well)), ("rk4", rk4(well)), ("lie2", lie2(True))]
)
def test_a_right_clock_is_never_accused(
    ours: Published, tmp_path: Path, scheme: str, step: Step, adds: bool
) -> None:
    found = of(ours, tmp_path, table(step, (-0.5, 0.5), 0, adds), scheme=scheme, **WELL)
    assert found.agrees
    assert all(x.verdict is not ColumnVerdict.MORE and x.digits > 12 for x in found.columns)


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("scheme", "step", "mistake"),
    [
        ("stormer-verlet", verlet(well, 0, 0), f"scheme stormer-verlet, {FROZEN}"),
        ("stormer-verlet", verlet(well, 1, 1), f"scheme stormer-verlet, {AT_THE_END}"),
        ("stormer-verlet", verlet(well, 0, 0.5), "scheme stormer-verlet, clock exchanged"),
        ("rk4", rk4(well, (0, 0, 0, 0)), f"scheme rk4, {FROZEN}"),
        ("rk4", rk4(well, (1, 1, 1, 1)), f"scheme rk4, {AT_THE_END}"),
        ("lie2", lie2(False), f"scheme lie2, {FROZEN}"),
        ("stormer-verlet", verlet(well, 1, 2), "clock+1"),
        ("rk4", rk4(well, (-1, -0.5, -0.5, 0)), "clock-1"),
    ],
)
def test_a_wrong_clock_is_named(
    ours: Published, tmp_path: Path, scheme: str, step: Step, mistake: str
) -> None:
    found = of(ours, tmp_path, table(step, (-0.5, 0.5), 0), scheme=scheme, **WELL)
    assert named(found) == [{mistake}]


@pytest.mark.left_to_ci
def test_a_clock_that_is_wrong_in_no_known_way_has_no_name(ours: Published, tmp_path: Path) -> None:
    text = table(rk4(well, (0, 1, 1, 1)), (-0.5, 0.5), 0)
    found = of(ours, tmp_path, text, scheme="rk4", **WELL)
    assert not found.agrees
    assert found.unexplained


@pytest.mark.left_to_ci
def test_a_time_that_begins_at_0_is_named(ours: Published, tmp_path: Path) -> None:
    right, wrong = (table(verlet(mathieu), (0, 1), t0) for t0 in (0.7, 0))
    assert of(ours, tmp_path, right, scheme="stormer-verlet", **MATHIEU).agrees
    found = of(ours, tmp_path, wrong, scheme="stormer-verlet", **MATHIEU)
    assert named(found) == [{"zero-t0"}]


def test_a_time_is_that_of_the_clock_and_t0_tells_a_run(ours: Published, tmp_path: Path) -> None:
    rows = table(verlet(mathieu), (0, 1), 0.7).splitlines()[1:]
    timed = ["t,p,q"]
    for row in rows:
        n, rest = row.split(",", 1)
        timed.append(f"{0.7 + int(n) * H!r},{rest}")
    text = "\n".join(timed)
    found = of(ours, tmp_path, text, scheme="stormer-verlet", **MATHIEU)
    assert (found.agrees, found.rows) == (True, 4)
    assert of(ours, tmp_path, text, scheme="stormer-verlet", t0="0.7", **MATHIEU).agrees
    with pytest.raises(InputError, match="has no row of these data"):
        of(ours, tmp_path, text, scheme="stormer-verlet", t0="0.8", **MATHIEU)
