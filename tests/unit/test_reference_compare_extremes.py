"""Right programs in doubles where these overflow, underflow or lose digits: none is wrong."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from reference.agreement import is_single
from reference.compare import Compared, compare
from reference.findings import Verdict
from reference.make import COMMITTED
from reference.ours import OurRun, load
from reference.overflow import may_overflow
from reference.scatter import Scatter
from reference.theirs import read

BEYOND = float("nan")
Step = Callable[[Any, Any, Any], tuple[Any, Any]]


def cube(p: Any, q: Any, h: Any) -> tuple[Any, Any]:
    p = p - h * q * q * q
    return p, q + h * p


def stiff(p: Any, q: Any, h: Any) -> tuple[Any, Any]:
    p = p - h * 1e16 * q
    return p, q + h * p


def run_of(scene: str, scheme: str, h: float, q: float) -> OurRun:
    inputs = (scheme, h, q)
    return next(x for x in load(COMMITTED, scene).runs() if x.inputs[:3] == inputs)


def of(folder: Path, run: OurRun, step: Step, change: Callable[[int, Any], Any]) -> Compared:
    """A table of p and q by the step in doubles, p of each row changed."""
    _, h, q, p = run.inputs
    lines = ["step,p,q"]
    for n in range(max(run.rows) + 1):
        if n in run.rows:
            lines.append(f"{n},{change(n, p)!r},{q!r}")
        p, q = step(p, q, h)
    path = folder / "theirs.csv"
    path.write_text("\n".join(lines) + "\n")
    own = run.run
    given = {"scheme": own.scheme, "step_size": own.step_size, "q0": own.q, "p0": own.p}
    ours = load(COMMITTED, run.scene)
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
    assert any(x.verdict is Verdict.ROUNDING for x in found.columns)
    assert bool(found.overflows) == ("overflow" in what)


def test_what_is_not_finite_early_or_wrong_and_finite_differs(tmp_path: Path) -> None:
    run = run_of(*RIGHT["p and q overflow"][0])
    assert not of(tmp_path, run, stiff, lambda n, p: BEYOND if n == 10 else p).agrees
    assert not of(tmp_path, run, stiff, lambda n, p: 1e90 if n == 100 else p).agrees


def test_a_determinant_may_overflow_where_the_state_does_not() -> None:
    run = run_of("stiff-duffing", "symplectic-euler", 1e-5, 1.0)
    known = {n: (Fraction(getattr(run.rows[5], n).value), Fraction(0)) for n in ("p", "q")}
    assert may_overflow(run.case, 5, known)
    small = {n: (Fraction(getattr(run.rows[1], n).value), Fraction(0)) for n in ("p", "q")}
    assert not may_overflow(run.case, 1, small)


def test_a_large_angle_scatters_p_as_much_as_doubles_do() -> None:
    """q = 10⁸ is known to 10⁻⁸ in doubles, and so is the force after one step; h = 0.01."""
    run = run_of("extreme-pendulum-top", "lie2", 0.01, 1e8)
    spreads = Scatter([run.case]).at(0, 100)
    assert spreads is not None
    assert spreads["p"].worst > 1e7


def test_numbers_beyond_single_precision_are_none() -> None:
    assert not is_single(Fraction(10) ** 60, Fraction(0))
    assert not is_single(Fraction(10) ** 400, Fraction(0))
    assert is_single(Fraction(1, 2), Fraction(0))
