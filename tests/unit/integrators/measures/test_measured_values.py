"""Values with noise: what an error makes of a defect is what is said, the same in any units."""

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import gmpy2
import pytest
import sympy

from tests.unit.integrators.measures.test_reading import ERROR, ONE, Rows, drawn
from verify.algebra.formula import parse, symbol
from verify.integrators.measures.measured_values import (
    Measured,
    MeasuredValues,
    components_of,
    evaluate,
)
from verify.integrators.measures.reading import READING_BITS, reading_of
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.user_code.step import StepError
from verify.structures import SYMPLECTIC
from verify.structures.first_integral import FirstIntegral
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric
from verify.structures.symplectic import SymplecticForm
from verify.structures.volume import Volume

VOLUME = Volume("volume", "volume", sympy.S.One)
NAMES = ("x", "y")


class Linear:
    """A probe of z' = J z with errors of J and of z' as it is told."""

    how, epsilon, comparisons = "floats", 0.0, ()

    def __init__(self, jacobian: Rows, errors: Rows, noise: float = 0.0) -> None:
        self.rows, self.errors, self.noise = jacobian, errors, noise
        names = tuple(f"z{k}" for k in range(len(jacobian)))
        if len(names) == 2:
            names = NAMES
        numbers = SimpleNamespace(round_number=lambda x: x)
        self.step = SimpleNamespace(names=names, time_dependent=False, numbers=numbers)

    def end(self, place: TrialPlace, h: Fraction) -> list[Fraction]:
        return [sum((a * x for a, x in zip(row, place.z, strict=True)), Fraction(0))
                for row in self.rows]  # fmt: skip

    def follow(self, place: TrialPlace, h: Fraction, noise: Any = None) -> Any:
        carried = noise or [0.0] * len(self.rows)
        total = [self.noise + sum(abs(float(a)) * e for a, e in zip(row, carried, strict=True))
                 for row in self.rows]  # fmt: skip
        return self.end(place, h), total

    def jacobian(self, *_: Any) -> Any:
        with gmpy2.context(precision=READING_BITS):
            rows = [[gmpy2.mpfr(gmpy2.mpq(x)) for x in row] for row in self.rows]
        return rows, [[float(x) for x in row] for row in self.errors]


def at(probe: Any, *z: Fraction, units: tuple[Fraction, ...] = ()) -> MeasuredValues:
    point = z or (ONE,) * len(probe.step.names)
    sizes = units or (ONE,) * len(point)
    return MeasuredValues(probe, TrialPlace(point, Fraction(0), sizes, sizes), ONE)


@pytest.mark.parametrize("size", [2, 4, 6, 10])
def test_s_and_det_j_are_those_of_a_reading_with_the_same_noise(size: int) -> None:
    jacobian = drawn(size, 3)
    errors = [[ERROR * (1 + (2 * i + 3 * j) % 5) for j in range(size)] for i in range(size)]
    values = at(Linear(jacobian, errors))
    rows, blurs = values.probe.jacobian()
    other = reading_of(values.place, ONE, rows, blurs, 0.0)
    found = components_of(SYMPLECTIC, values)
    for (a, b), y in other.components.items():
        x = found[f"dz{a}∧dz{b}"] if size > 2 else found["dx∧dy"]
        assert x.value == pytest.approx(y.value)
        assert y.noise * (1 - 1e-9) <= x.noise <= y.noise * (1 + 1e-3)
    (volume,) = components_of(VOLUME, values).values()
    assert volume.value == pytest.approx(other.volume)
    assert other.volume_noise * (1 - 1e-9) <= volume.noise <= other.volume_noise * (1 + 1e-3)
    assert volume.scale == 1.0


def test_a_product_has_the_errors_of_both_factors() -> None:
    x, y = Measured(gmpy2.mpfr(3), 0.5, 3.0), Measured(gmpy2.mpfr(-2), 0.25, 2.0)
    assert ((x * y).noise, (x * y).size) == (3 * 0.25 + 2 * 0.5 + 0.5 * 0.25, 6.0)
    assert ((x - y).noise, (x - y).size, float((x + y).value)) == (0.75, 5.0, 1.0)


def test_an_integral_has_the_noise_of_z_times_its_slopes() -> None:
    turn = [[Fraction(3, 5), Fraction(-4, 5)], [Fraction(4, 5), Fraction(3, 5)]]
    probe = Linear(turn, turn, noise=1e-9)
    circle = FirstIntegral("circle", "circle", parse("x**2 + y**2", NAMES))
    (kept,) = components_of(circle, at(probe, Fraction(5), Fraction(0))).values()
    # The end is (3, 4), where the slopes are 6 and 8.
    assert kept.value == 0
    assert kept.noise == pytest.approx(14e-9)
    line = FirstIntegral("line", "line", parse("x + y", NAMES))
    (lost,) = components_of(line, at(probe, Fraction(5), Fraction(0))).values()
    assert lost.value == pytest.approx(2)


def test_the_way_back_has_the_noise_of_both_steps() -> None:
    mirrored = [[ONE * 0, ONE], [ONE, ONE * 0]]
    probe = Linear(mirrored, mirrored, noise=1e-9)
    back = components_of(Symmetric("symmetric", "symmetric"), at(probe, ONE, 2 * ONE))
    assert [x.value for x in back.values()] == [0.0, 0.0]
    assert [x.noise for x in back.values()] == pytest.approx([2e-9, 2e-9])
    turned = Reversible("reversible", "reversible", (-symbol("x"), symbol("y")))
    away = components_of(turned, at(probe, ONE, 2 * ONE))
    assert [x.value for x in away.values()] == [-2.0, -4.0]


def test_a_form_of_its_own_is_measured_where_it_depends_on_z() -> None:
    stretched = [[2 * ONE, ONE * 0], [ONE * 0, 3 * ONE]]
    form = SymplecticForm("symplectic", "", {(0, 1): parse("1/(x*y)", NAMES)})
    (kept,) = components_of(form, at(Linear(stretched, stretched), ONE, ONE)).values()
    assert kept.value == pytest.approx(0, abs=1e-60)
    plain = SymplecticForm("symplectic", "", {(0, 1): sympy.S.One})
    (lost,) = components_of(plain, at(Linear(stretched, stretched), ONE, ONE)).values()
    assert (lost.value, lost.scale) == (5.0, 1.0)


@pytest.mark.parametrize("unit", [Fraction(10) ** 6, Fraction(1, 10**6)])
def test_in_units_of_its_scale_a_defect_is_the_same(unit: Fraction) -> None:
    """Each coordinate has a unit of its own, by which J, z and the form are converted."""
    jacobian, units = drawn(4, 5), (unit, ONE, ONE / unit, ONE)
    scaled = [[x * u / v for x, v in zip(row, units, strict=True)]
              for row, u in zip(jacobian, units, strict=True)]  # fmt: skip
    zeros = [[Fraction(0)] * 4 for _ in range(4)]
    plain = components_of(VOLUME, at(Linear(jacobian, zeros)))
    other = components_of(VOLUME, at(Linear(scaled, zeros), units=units))
    assert plain[""].defect == pytest.approx(other[""].defect)
    plain = components_of(Symmetric("", ""), at(Linear(jacobian, zeros)))
    other = components_of(Symmetric("", ""), at(Linear(scaled, zeros), *units, units=units))
    assert [x.defect for x in plain.values()] == pytest.approx([x.defect for x in other.values()])


def test_a_formula_that_is_not_defined_is_an_error_of_the_step() -> None:
    formula, zero = parse("log(x)", NAMES), Fraction(0)
    value, change = evaluate(formula, NAMES, (2 * ONE, zero), zero, zero, [0.5, 1.0])
    assert (float(value), change) == (pytest.approx(0.6931471805599453), 0.25)
    with pytest.raises(StepError, match="is not defined there"):
        evaluate(formula, NAMES, (-ONE, zero), zero, zero, [0.0, 0.0])
