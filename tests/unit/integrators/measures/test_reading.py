"""The noise of S and of det J is what the error of each entry of J makes of them, and no less."""

from fractions import Fraction
from itertools import product
from random import Random

import gmpy2
import pytest

from verify.integrators.measures.reading import READING_BITS, DefectReading, reading_of
from verify.integrators.places.trial_places import TrialPlace

ONE = Fraction(1)
ERROR = Fraction(1, 2**20)
Rows = list[list[Fraction]]


def drawn(size: int, seed: int) -> Rows:
    draw = Random(seed)  # noqa: S311 - any numbers do
    return [[Fraction(draw.randrange(-64, 64), 16) for _ in range(size)] for _ in range(size)]


def read(jacobian: Rows, errors: Rows) -> DefectReading:
    """In units of 1, without any rounding of the code's own numbers."""
    size = len(jacobian)
    place = TrialPlace((ONE,) * size, Fraction(0), (ONE,) * size, (ONE,) * size)
    with gmpy2.context(precision=READING_BITS):
        rows = [[gmpy2.mpfr(gmpy2.mpq(x)) for x in row] for row in jacobian]
    return reading_of(place, ONE, rows, [[float(x) for x in row] for row in errors], 0.0)


@pytest.mark.parametrize("size", [2, 4, 6])
@pytest.mark.parametrize("seed", range(3))
def test_one_entry_that_is_off_moves_s_and_det_j_by_what_is_said(size: int, seed: int) -> None:
    """Both are linear in each entry of J, so that they move by no more and by no less."""
    jacobian = drawn(size, seed)
    for i, j in product(range(size), repeat=2):
        errors = [[ERROR * ((a, b) == (i, j)) for b in range(size)] for a in range(size)]
        moved = [[x + e for x, e in zip(*rows, strict=True)]
                 for rows in zip(jacobian, errors, strict=True)]  # fmt: skip
        found, other = read(jacobian, errors), read(moved, errors)
        for at, x in found.components.items():
            assert x.noise == pytest.approx(abs(other.components[at].value - x.value), abs=1e-12)
        change = abs(other.volume - found.volume)
        assert found.volume_noise == pytest.approx(change, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("size", [2, 4])
def test_errors_of_all_entries_add_up_whatever_their_signs_are(size: int) -> None:
    jacobian = drawn(size, 7)
    errors = [[ERROR * (1 + (2 * i + 3 * j) % 5) for j in range(size)] for i in range(size)]
    found, draw = read(jacobian, errors), Random(1)  # noqa: S311 - any signs do
    for _ in range(50):
        moved = [[x + e * draw.choice((1, -1)) for x, e in zip(*rows, strict=True)]
                 for rows in zip(jacobian, errors, strict=True)]  # fmt: skip
        other = read(moved, errors)
        for at, x in found.components.items():
            assert abs(other.components[at].value - x.value) <= x.noise * (1 + 2**-10), at
