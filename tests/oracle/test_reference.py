"""Reference data by heyoka: its Taylor step of fixed order is the scheme lieη, and small steps of
high order are the exact flow.

How far heyoka may be off is told in `by_heyoka` and `test_heyoka_many_steps`.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import pytest

from tests.helpers.constructed.reference import made
from tests.oracle.by_heyoka import PRECISIONS, SYSTEMS, State, defect, oracle
from verify.reference.make.models import Data

SLACK = 400  # roundings of so many steps, each of which may grow on the way
STEPS = (1, 10, 100)
AT = (Fraction(1, 4), Fraction(5, 4))
SHARPEST = next(x for x in (PRECISIONS.get("quad"), PRECISIONS["double"]) if x is not None)
NAMES = ("duffing", "pendulum", "polynomial, not separable")
FLOW_ETA = 10
every_system = pytest.mark.parametrize("name", NAMES)


@dataclass(frozen=True)
class Theirs:
    values: dict[str, Fraction]
    bound: Fraction


def data(name: str, eta: int) -> Data:
    toml = f"""
hamiltonian = "{SYSTEMS[name].formula}"
schemes = ["lie{eta}"]
[[reference]]
step_sizes = ["1/128"]
initial_values = [{{ p = "{AT[0]}", q = "{AT[1]}" }}]
steps = [{", ".join(map(str, STEPS))}]
"""
    return made({"mine": toml})[0]


def theirs(name: str, eta: int) -> dict[int, Theirs]:
    """p, q, ΔJ, MSE and Λ at the steps."""
    chosen = oracle(name, SHARPEST, eta)
    chosen.start(AT)
    states: list[State] = [[*AT, *map(Fraction, (1, 0, 0, 1))]]
    states += [chosen.step() for _ in range(STEPS[-1] + 1)]
    areas = [1 + defect(state)[0, 1] for state in states]
    defects = [after / before - 1 for before, after in pairwise(areas)]
    unit = Fraction(SLACK, 2**SHARPEST.bits) * max(abs(x) for state in states for x in state) ** 2
    return {
        n: Theirs(
            {
                "p": states[n][0],
                "q": states[n][1],
                "delta_j": defects[n],
                "mse": sum(x * x for x in defects[:n]) / n,
                "lam": areas[n] - 1,
            },
            unit,
        )
        for n in STEPS
    }


@every_system
@pytest.mark.parametrize("eta", [2, 3])
def test_a_scheme_s_rows_are_heyoka_s(name: str, eta: int) -> None:
    rows, known = data(name, eta).runs[0].rows, theirs(name, eta)
    other = theirs(name, eta + 1)
    for row in rows:
        for column, value in known[row.step].values.items():
            cell = getattr(row, column)
            allowed = known[row.step].bound + Fraction(cell.radius)
            assert abs(Fraction(cell.value) - value) <= allowed, (row.step, column)
            apart = abs(Fraction(cell.value) - other[row.step].values[column])
            assert column == "mse" or apart > 10 * allowed, "any number would pass"


@pytest.mark.skipif("quad" not in PRECISIONS, reason="this heyoka has no real128")
@every_system
def test_the_exact_flow_is_that_of_a_high_order(name: str) -> None:
    """h = 1/128 and order 10: what is cut off is about h¹¹ = 10⁻²³ a step."""
    known = theirs(name, FLOW_ETA)
    for row in data(name, 2).flow[0].rows:
        for column in ("p", "q"):
            cell = getattr(row, column)
            off = abs(Fraction(cell.value) - known[row.step].values[column])
            assert off <= row.step * Fraction(1, 10**19), (row.step, column)
