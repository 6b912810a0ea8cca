"""Gauss–Legendre panels: the rule's numbers, and areas that it sweeps exactly."""

from fractions import Fraction
from math import factorial

import numpy as np
import pytest

from verify.studies.regions import panels
from verify.studies.regions.panels import NODES, interpolation, rule


def moment(bits: int, degree: int) -> Fraction:
    made = rule(bits)
    return sum((w * s**degree for s, w in zip(made.nodes, made.weights, strict=True)), Fraction(0))


@pytest.mark.parametrize("bits", [53, 120, 1000])
def test_powers_are_integrated_exactly_up_to_the_rules_degree(bits: int) -> None:
    for degree in range(2 * NODES):
        assert abs(moment(bits, degree) - Fraction(1, degree + 1)) < Fraction(1, 2**bits)


def test_the_next_power_is_not() -> None:
    """By as much as the formula of the rule's error says."""
    n = NODES
    error = Fraction(factorial(n) ** 4, (2 * n + 1) * factorial(2 * n) ** 2)
    off = Fraction(1, 2 * n + 1) - moment(300, 2 * n)
    assert abs(off / error - 1) < Fraction(1, 10**30)


def test_polynomials_are_differentiated_exactly() -> None:
    made = rule(120)
    for degree in range(1, NODES):
        for s, row in zip(made.nodes, made.derivative, strict=True):
            found = sum(d * t**degree for d, t in zip(row, made.nodes, strict=True))
            assert abs(found - degree * s ** (degree - 1)) < Fraction(1, 2**110)


def whole(values: list[Fraction], grid: int) -> np.ndarray:
    return np.array([[round(v * 2**grid) for v in values]], dtype=object)


@pytest.mark.parametrize(("a", "b"), [(0, 1), (1, 2), (3, 7), (15, 14), (15, 15)])
def test_the_area_that_powers_sweep(a: int, b: int) -> None:
    """½ ∫ (x dy − y dx) = (b − a)/(2(a + b)) for x = s^a, y = s^b."""
    grid, made = 200, rule(160)
    x, y = (whole([s**k for s in made.nodes], grid) for k in (a, b))
    (swept,) = made.areas(x, y)
    found = Fraction(swept, 2 ** (2 * grid + made.bits))
    assert abs(found - Fraction(b - a, 2 * (a + b))) < Fraction(1, 2**140)


def test_the_swept_matrix_is_antisymmetric_so_that_no_curve_sweeps_itself() -> None:
    swept = rule(80).area_matrix
    assert (swept == -swept.T).all()


def test_a_wrong_weight_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = panels._root

    def planted(k: int) -> tuple[panels.Ball, panels.Ball]:
        x, weight = right(k)
        return x, weight / (1 + panels.Ball(2) ** -40) if k == 3 else weight

    monkeypatch.setattr(panels, "_root", planted)
    rule.cache_clear()
    try:
        assert abs(moment(77, 0) - 1) > Fraction(1, 2**50)
    finally:
        rule.cache_clear()


@pytest.mark.parametrize("count", [1, 16, 77])
def test_values_between_nodes_are_those_of_the_polynomial(count: int) -> None:
    nodes = np.array([float(s) for s in rule(53).nodes])
    targets = np.arange(count) / count
    for degree in (0, 1, 7, NODES - 1):
        assert np.abs(interpolation(count) @ nodes**degree - targets**degree).max() < 1e-13
    missed = np.abs(interpolation(count) @ nodes**30 - targets**30).max()
    assert missed > 1e-9, "a power beyond the panel's degree is not reproduced"
