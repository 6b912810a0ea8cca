"""What a hunt makes as large as can be is measured right: against closed forms, and other code."""

import math
from fractions import Fraction

import pytest

from verify.exploration.measures import MEASURES, _greatest, digits_lost, growth, rounding_share
from verify.exploration.sample import Sample
from verify.scenes.scene import scene_from
from verify.studies.separation.chain import Trail
from verify.studies.separation.truncation_and_rounding import separate


def sample(formula: str, q: str, p: str, h: str, steps: int, scheme: str = "lie2") -> Sample:
    grid = {"steps": steps, "step_sizes": [h], "initial_values": [{"q": q, "p": p}]}
    return Sample.from_scene(
        scene_from({"hamiltonian": formula, "schemes": [scheme], "grid": grid}, "x")
    )


def test_growth_of_the_oscillator_is_its_closed_form() -> None:
    """lie2 on (p² + ω²q²)/2: det J = 1 + (ωh)⁴/4."""
    found = growth(sample("p**2/2 + 9*q**2/2", "1", "0", "0.1", 50))
    expected = math.log10(math.expm1(50 * math.log1p(0.3**4 / 4)))
    assert found == pytest.approx(expected, abs=1e-12)
    assert growth(sample("p**2/2 + q**2/2", "1", "0", "0.1", 50, "symplectic-euler")) is None


def test_rounding_share_is_that_of_a_separation() -> None:
    asked = sample("p**2/2 - cos(q)", "1", "0.5", "0.001", 200)
    largest = separate(
        asked.hamiltonian, "lie2", q="1", p="0.5", step_size="0.001", steps=200
    ).plain.largest  # type: ignore[union-attr]
    expected = math.log10(float(largest["total"]) / float(largest["truncation"]))
    assert rounding_share(asked) == pytest.approx(expected, abs=1e-4)
    same = sample("p**2/2 - cos(q)", "1", "0.5", "0.001", 200, "symplectic-euler")
    assert rounding_share(same) is None, "no truncation to be a share of"


def test_what_is_below_its_own_error_bound_is_not_hunted() -> None:
    trail = (Fraction(1, 10**30), Fraction(0))
    assert _greatest(Trail.from_values(trail), Fraction(1, 10**29)) == 0
    assert _greatest(Trail.from_values(trail), Fraction(1, 10**32)) == Fraction(1, 10**30)


def test_digits_lost_is_the_error_of_a_float64_loop() -> None:
    """Euler's step on the oscillator, whose floating-point operations have one order only."""
    h, exact, floats = Fraction(1, 20), (Fraction(1), Fraction(1, 2)), (1.0, 0.5)
    size = Fraction(1)
    for k in range(400):
        (q, p), (fq, fp) = exact, floats
        exact, floats = (q + h * p, p - h * q), (fq + 0.05 * fp, fp - 0.05 * fq)
        size = max(size, *map(abs, exact)) if (k + 1) % 25 == 0 else size  # 16 checkpoints
    error = max(abs(Fraction(f) - e) for f, e in zip(floats, exact, strict=True))
    found = digits_lost(sample("p**2/2 + q**2/2", "1", "0.5", "0.05", 400, "euler"))
    assert found == pytest.approx(math.log10(error / size * 2**53), abs=1e-9)


def test_passing_the_origin_loses_no_digits() -> None:
    """q' = 1 from −1.1: q comes to 0 after 11 steps, where a relative error would be infinite."""
    found = digits_lost(sample("p", "-1.1", "0", "0.1", 11))
    assert found is not None
    assert found < 1


def test_an_orbit_that_goes_far_has_no_measure() -> None:
    far = sample("p*q", "2", "1", "0.1", 100)
    assert [each.value(far, 40) for each in MEASURES.values()] == [None] * len(MEASURES)
