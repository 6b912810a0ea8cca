"""Claims of the error of the solution, which the exact one tells."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
from pydantic import ValidationError

from tests.helpers.constructed.runs import CLAIM, FLAT, STARTS, Given, check
from verify.claims.kinds.comparisons.solution_error import SolutionErrorClaim
from verify.flows.solution import exact_solution
from verify.hamiltonians import systems
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED

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
        ("0.1", {"within": "0.1"}, MEASURED),
        ("0.1", {"within": "0.05"}, REFUTED),
        ("0.1", {"beyond": "0.05"}, MEASURED),
        ("0.1", {"beyond": "0.1"}, REFUTED),
        ("0", {"within": "1e-9"}, MEASURED),
    ],
)
def test_an_error_is_measured_by_the_orbits_reach(
    off: str, keys: dict[str, str], expected: Verdict
) -> None:
    assert check(solution_error(**keys), at_end(off), **ONE).verdict is expected


def test_some_error_and_every_error_are_told_apart() -> None:
    """Off by 0.1, which is more than the whole reach of the orbit from (0.1, 0)."""
    two = {"step_sizes": ["0.01"], "starts": STARTS[:2]}
    for quantifier, expected in (("every", REFUTED), ("some", MEASURED)):
        claim = solution_error(within="0.1", quantifier=quantifier)
        assert check(claim, at_end("0.1", *STARTS), **two).verdict is expected


def test_an_error_within_its_bounds_is_undecided() -> None:
    def wide(h: Fraction, k: int) -> dict[str, Given]:
        exact = at_end("0")(h, k)
        return {**exact, "q": (exact["q"], "1")}

    assert check(solution_error(within="0.1"), wide, **ONE).verdict is UNDECIDED


def test_an_error_is_within_or_beyond_one_number() -> None:
    with pytest.raises(ValidationError, match="give one of the two"):
        solution_error()
    with pytest.raises(ValidationError, match="give one of the two"):
        solution_error(within="1", beyond="1")
