"""What rounding may do is what its formulas say, each part by itself; sums of ΔJ by their own."""

import random
from fractions import Fraction
from math import isqrt
from types import SimpleNamespace
from typing import Any

import pytest

from verify.reference.compare.allowance import USUAL, WORST, Allowance
from verify.reference.compare.scatter import Spread
from verify.reference.compare.setting import _predict_sum, readings
from verify.reference.compare.table_agreement import DOUBLE
from verify.structures import AREA, SYMPLECTIC

KNOWN = {"p": (Fraction(1, 3), Fraction(0)), "q": (Fraction(-7, 2), Fraction(0)),
         "p1": (Fraction(1, 3), Fraction(0)), "q1": (Fraction(-7, 2), Fraction(0)),
         "lambda": (Fraction(1, 50), Fraction(0)),
         "mse": (Fraction(1, 10**6), Fraction(0))}  # fmt: skip


def allowance(spreads: dict[str, Spread] | None, *, planar: bool, unit: Fraction = DOUBLE) -> Any:
    coordinates = ("p", "q") if planar else ("p1", "q1")
    structure = AREA if planar else SYMPLECTIC
    hamiltonian = SimpleNamespace(structure=structure, planar=planar, coordinates=coordinates)
    scatters: Any = SimpleNamespace(spreads_at=lambda *_: spreads)
    return Allowance(SimpleNamespace(hamiltonian=hamiltonian), unit, scatters)  # type: ignore[arg-type]


@pytest.mark.parametrize("planar", [True, False])
@pytest.mark.parametrize("step", [1, 50, 10**4])
def test_what_is_carried_is_added_to_what_there_is_in_any_case(step: int, planar: bool) -> None:
    name = "q" if planar else "q1"
    moved = Spread(Fraction(3, 7), Fraction(11, 5))
    made, still = (allowance({name: x}, planar=planar) for x in (moved, Spread(0, 0)))
    least = made.unavoidable_rounding(name, step, KNOWN)
    many, few = 1 + isqrt(step), 4 if planar else 8
    smallest = Fraction(1, 2**1022)
    assert least == (few * DOUBLE * Fraction(7, 2) + smallest) * many
    found, nothing = (
        made.accumulated_rounding(name, step, KNOWN),
        still.accumulated_rounding(name, step, KNOWN),
    )
    long = least if planar else least * many
    assert (nothing.usual, nothing.worst) == (least, long)
    assert found.usual == least + USUAL * moved.usual * DOUBLE
    assert found.worst == long + WORST * moved.worst * DOUBLE
    assert allowance(None, planar=planar).accumulated_rounding(name, step, KNOWN) is None
    assert allowance({}, planar=planar).accumulated_rounding(name, step, KNOWN) == nothing


def test_of_a_coarser_unit_all_is_more_but_what_underflows() -> None:
    one, other = (allowance({}, planar=True, unit=x) for x in (DOUBLE, 2**10 * DOUBLE))
    a, b = (x.unavoidable_rounding("q", 1, KNOWN) for x in (one, other))
    assert abs(b / a / 2**10 - 1) < Fraction(1, 2**100)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("late", [0, 1])
def test_a_sum_of_all_delta_j_is_foretold_within_its_radius(seed: int, late: int) -> None:
    """From Λ and MSE alone; what is left out is of third order."""
    draw = random.Random(seed)  # noqa: S311 - no secret
    changes = [Fraction(draw.randint(-99, 99), 10 ** draw.choice([3, 4])) for _ in range(12)]
    product = Fraction(1)
    for x in changes:
        product *= 1 + x
    known = {"lambda": (product - 1, Fraction(0)),
             "mse": (sum(x * x for x in changes) / len(changes), Fraction(0))}  # fmt: skip
    setting: Any = SimpleNamespace(numbers=lambda *_: known, delay=late)
    found = _predict_sum(setting, 30, len(changes) - late)
    assert found is not None
    off, cubes = abs(found.value - sum(changes)), sum(abs(x) ** 3 for x in changes)
    assert off <= found.radius
    assert found.radius <= (sum(float(x) ** 2 for x in changes)) ** 1.5 * (1 + 1e-9)
    assert off <= cubes / 3 * (1 + Fraction(1, 2))
    for missing in ("lambda", "mse"):
        less = {n: x for n, x in known.items() if n != missing}
        lacking: Any = SimpleNamespace(numbers=lambda *_, less=less: less, delay=late)
        assert _predict_sum(lacking, 30, len(changes) - late) is None
    at_start: Any = SimpleNamespace(
        numbers=lambda *_: {"lambda": (Fraction(0), Fraction(0))}, delay=0
    )
    begun = _predict_sum(at_start, 30, 0)
    assert begun is not None
    assert begun.value == 0


@pytest.mark.parametrize("name", ["lambda", "mse"])
def test_another_reading_is_as_near_as_what_it_is_made_of(name: str) -> None:
    """A radius is magnified by the slope: of x ↦ n x by n, of √x by 1/(2√x)."""
    value, radius, step = Fraction(1, 100), Fraction(1, 10**20), 9
    setting: Any = SimpleNamespace(
        delay=0, numbers=lambda *_: {"lambda": (value, radius), "mse": (value, radius)},
        known=lambda *_: {}, orbit=None,
    )  # fmt: skip
    slopes = {"whole-sum": step, "root": 5, "one-more": Fraction(9, 10), "one-less": Fraction(9, 8),
              "product": 1, "negated-lambda": 1, "inverse": Fraction(100, 101) ** 2}  # fmt: skip
    seen = 0
    for other, _, read in readings(name):
        if other in slopes:
            found = read(setting, 30, step)
            assert found is not None
            assert abs(found.radius / (3 * radius * slopes[other]) - 1) < Fraction(1, 10**6)
            seen += 1
    assert seen >= 3
