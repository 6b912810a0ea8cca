"""Claims of the error of the solution, which the exact one tells."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
from pydantic import ValidationError

from tests.helpers.constructed.runs import CLAIM, FLAT, STARTS, Given, check
from verify.claims.claims_file import load_claims
from verify.claims.kinds.comparisons.solution_error import SolutionErrorClaim
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.flows.solution import exact_solution
from verify.hamiltonians import systems
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED

SCENE = """
name = "mine"
system = "pendulum"
schemes = ["lie2"]
[grid]
time = 1
step_sizes = [0.1]
initial_values = [{ q = 1.5, p = 0 }]
[[series]]
step_size = 0.01
time = 1
initial_value = { q = 1.5, p = 0 }
source = "A"
[[series]]
step_size = 0.01
time = 20
initial_value = { q = 1.5, p = 0 }
source = "A"
"""
CLAIMS = """
[[claim]]
id = "c"
kind = "solution_error"
scene = "mine"
scheme = "lie2"
series = "{series}"
within = {within}
"""
START = ("1.5", "0")  # its reach in q is 1.5, nearly
ONE = {"step_sizes": ["0.01"], "starts": [START]}


def at_end(off: str, *starts: tuple[str, str]) -> Callable[[Fraction, int], dict[str, Given]]:
    """p and q of the exact pendulum at the end, q off by so much."""
    exact = systems.get("pendulum").hamiltonian()

    def values(h: Fraction, k: int) -> dict[str, Given]:
        q, p = (Fraction(x) for x in (starts or (START,))[k])
        time = (20000 // h) * h
        found = exact_solution(exact, p=p, q=q, time=time, digits=15)
        return {**FLAT, "p": found.p, "q": found.q + Fraction(off)}

    return values


def solution_error(**keys: Any) -> SolutionErrorClaim:
    return SolutionErrorClaim(**CLAIM, kind="solution_error", **keys)


@pytest.mark.parametrize(
    ("off", "keys", "expected"),
    [
        ("0.1", {"within": "0.15"}, MEASURED),
        ("0.1", {"within": "0.13"}, REFUTED),
        ("0.1", {"beyond": "0.13"}, MEASURED),
        ("0.1", {"beyond": "0.15"}, REFUTED),
        ("0", {"within": "1e-9"}, MEASURED),
    ],
)
def test_an_error_is_measured_by_the_orbits_reach(
    off: str, keys: dict[str, str], expected: Verdict
) -> None:
    assert check(solution_error(**keys), at_end(off), **ONE).verdict is expected


def rk4(z: tuple[float, float], h: float) -> tuple[float, float]:
    """A step of the pendulum, (q, p)."""

    def rate(q: float, p: float) -> tuple[float, float]:
        return p, -math.sin(q)

    a = rate(*z)
    b = rate(z[0] + h / 2 * a[0], z[1] + h / 2 * a[1])
    c = rate(z[0] + h / 2 * b[0], z[1] + h / 2 * b[1])
    d = rate(z[0] + h * c[0], z[1] + h * c[1])
    q, p = (z[k] + h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]) for k in (0, 1))
    return q, p


@pytest.mark.parametrize("off", ["0.1", "-0.3", "0.001"])
def test_the_largest_error_over_a_period_is_that_of_both_states_followed_back(off: str) -> None:
    found = check(solution_error(within="1"), at_end(off), **ONE)
    said = float(found.details[1][-1])
    end = at_end("0")(Fraction(1, 100), 0)
    exact = (float(Fraction(str(end["q"]))), float(Fraction(str(end["p"]))))
    near, period = (exact[0] + float(off), exact[1]), 7.3006  # 4 K(sin 0.75)
    orbit, gaps = [], []
    for _ in range(2000):
        orbit.append(exact)
        gaps.append([abs(x - y) for x, y in zip(near, exact, strict=True)])
        near, exact = rk4(near, -period / 2000), rk4(exact, -period / 2000)
    reach = [max(abs(z[k]) for z in orbit) for k in (0, 1)]
    most = max(gap[k] / reach[k] for gap in gaps for k in (0, 1))
    assert said == pytest.approx(most, rel=0.05)
    assert said > abs(float(off)) / reach[0], "it is no less than at the end"


def test_of_a_series_its_own_runs_are_spoken_of(tmp_path: Any) -> None:
    (tmp_path / "mine.toml").write_text(SCENE)
    text = CLAIMS.format(series="A", within="1e-3")
    (tmp_path / "claims.toml").write_text(text)
    (found,) = prepare(load_claims(tmp_path / "claims.toml")).run(Store(None), where=THIS_PROCESS)
    assert found.verdict is MEASURED
    assert [row[1:3] for row in found.details[1:]] == [("0.01", "20")], "the longest alone"
    assert [len(row) for row in found.details] == [4, 4]
    assert found.details[0][0] == "initial value"
    (tmp_path / "claims.toml").write_text(CLAIMS.format(series="B", within="1e-3"))
    with pytest.raises(InputError, match=r"series=B: the scene has no such .*it has A"):
        load_claims(tmp_path / "claims.toml")


def test_some_error_and_every_error_are_told_apart() -> None:
    """Off by 0.1, which is the whole reach of the orbit from (0.1, 0)."""
    two = {"step_sizes": ["0.01"], "starts": STARTS[:2]}
    for quantifier, expected in (("every", REFUTED), ("some", MEASURED)):
        claim = solution_error(within="0.15", quantifier=quantifier)
        assert check(claim, at_end("0.1", *STARTS), **two).verdict is expected


def test_an_error_within_its_bounds_is_undecided() -> None:
    def wide(h: Fraction, k: int) -> dict[str, Given]:
        exact = at_end("0")(h, k)
        return {**exact, "q": (exact["q"], "1")}

    assert check(solution_error(within="0.1"), wide, **ONE).verdict is UNDECIDED


def test_a_run_without_a_state_at_its_end_tells_no_error() -> None:
    found = check(solution_error(within="1"), lambda h, k: FLAT, **ONE)
    assert found.verdict is UNDECIDED
    assert "no state at the end" in found.evidence
    assert found.details[1][-1] == "unknown"


def test_an_error_is_within_or_beyond_one_number() -> None:
    with pytest.raises(ValidationError, match="give one of the two"):
        solution_error()
    with pytest.raises(ValidationError, match="give one of the two"):
        solution_error(within="1", beyond="1")
