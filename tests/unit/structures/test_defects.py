"""Each structure's defect of a linear step in Fractions, against matrix products written out."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any

import pytest
import sympy

from verify.algebra.formula import parse
from verify.structures import SYMPLECTIC
from verify.structures.conformal import Conformal
from verify.structures.first_integral import FirstIntegral
from verify.structures.poisson import Poisson
from verify.structures.reversible import Reversible
from verify.structures.structure import Structure
from verify.structures.symmetric import Symmetric
from verify.structures.symplectic import SymplecticForm
from verify.structures.volume import Volume, determinant

NAMES = ("p1", "p2", "q1", "q2")
Z = [Fraction(1, 2), Fraction(-2, 3), Fraction(3), Fraction(5, 7)]
MATRIX = [[Fraction(a, 6) for a in row] for row in
          ([7, 1, 0, -2], [3, 6, 1, 1], [0, 2, 5, -1], [1, 0, 4, 6])]  # fmt: skip


@dataclass
class Linear:
    """The step z' = M z, which does not depend on h."""

    names: Sequence[str] = NAMES

    @property
    def jacobian(self) -> list[list[Fraction]]:
        return MATRIX

    @property
    def end(self) -> list[Fraction]:
        return [sum((a * x for a, x in zip(row, Z, strict=True)), Fraction(0)) for row in MATRIX]

    def number(self, x: Fraction) -> Fraction:
        return x

    def before(self, formula: sympy.Expr) -> Fraction:
        return value(formula, Z)

    def after(self, formula: sympy.Expr) -> Fraction:
        return value(formula, self.end)

    def factor(self, formula: sympy.Expr) -> Fraction:
        return value(formula, Z)

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> list[str]:
        return [f"{x}, {reflection}" for x in self.names]


def value(formula: sympy.Expr, z: Sequence[Fraction]) -> Fraction:
    numbers = [sympy.Rational(x.numerator, x.denominator) for x in z]
    exact = formula.subs({parse(n): x for n, x in zip(NAMES, numbers, strict=True)})
    return Fraction(int(exact.p), int(exact.q))


def product(*matrices: Sequence[Sequence[Fraction]]) -> list[list[Fraction]]:
    first, *others = matrices
    result = [list(row) for row in first]
    for m in others:
        result = [[sum((row[k] * m[k][j] for k in range(4)), Fraction(0)) for j in range(4)]
                  for row in result]  # fmt: skip
    return result


def transposed(m: Sequence[Sequence[Fraction]]) -> list[list[Fraction]]:
    return [list(row) for row in zip(*m, strict=True)]


def antisymmetric(entries: Any, z: Sequence[Fraction]) -> list[list[Fraction]]:
    result = [[Fraction(0)] * 4 for _ in range(4)]
    for (a, b), x in entries.items():
        result[a][b], result[b][a] = value(x, z), -value(x, z)
    return result


ENTRIES = {(0, 1): parse("p1*q2"), (0, 2): parse("1 + q1"), (1, 3): parse("2"),
           (2, 3): parse("p2")}  # fmt: skip
J, JT = MATRIX, transposed(MATRIX)


def upper(m: Sequence[Sequence[Fraction]]) -> list[Fraction]:
    return [m[a][b] for a, b in combinations(range(4), 2)]


def gap(x: Sequence[Sequence[Fraction]], y: Sequence[Sequence[Fraction]]) -> list[Fraction]:
    return [a - b for a, b in zip(upper(x), upper(y), strict=True)]


def defect(structure: Structure) -> list[Any]:
    return list(structure.defect(Linear()).values())


def test_a_form_is_pulled_back_by_the_jacobian() -> None:
    new, old = antisymmetric(ENTRIES, Linear().end), antisymmetric(ENTRIES, Z)
    expected = gap(product(JT, new, J), old)
    assert defect(SymplecticForm("symplectic", "", ENTRIES)) == expected
    assert any(expected)
    third = [[x / 3 for x in row] for row in old]
    conformal = Conformal("conformal", "", parse("1/3"), ENTRIES)
    assert defect(conformal) == gap(product(JT, new, J), third)


def test_the_canonical_form_is_dp_wedge_dq() -> None:
    one = parse("1")
    omega = antisymmetric({(0, 2): one, (1, 3): one}, Z)
    assert defect(SYMPLECTIC) == gap(product(JT, omega, J), omega)
    assert list(SYMPLECTIC.defect(Linear()))[:2] == ["dp1∧dp2", "dp1∧dq1"]


def test_a_bracket_is_pushed_forward_by_the_jacobian() -> None:
    new, old = antisymmetric(ENTRIES, Linear().end), antisymmetric(ENTRIES, Z)
    expected = gap(product(J, old, JT), new)
    assert defect(Poisson("poisson", "", ENTRIES)) == expected
    assert any(expected)


def test_volume_has_its_density_at_both_ends() -> None:
    det = Fraction(str(sympy.Matrix([[sympy.Rational(str(x)) for x in row] for row in J]).det()))
    density = parse("1 + p1**2")
    (x,) = defect(Volume("volume", "", density))
    assert x == value(density, Linear().end) * det - value(density, Z)


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_the_determinant_is_sympy_s(size: int) -> None:
    rows = [[sympy.Symbol(f"a{i}{j}") for j in range(size)] for i in range(size)]
    assert sympy.expand(determinant(rows) - sympy.Matrix(rows).det()) == 0


def test_an_integral_is_compared_at_both_ends() -> None:
    integral = parse("p1*q2 - q1**2")
    (x,) = defect(FirstIntegral("I", "", integral))
    assert x == value(integral, Linear().end) - value(integral, Z)


def test_symmetry_and_reversibility_ask_for_the_way_back() -> None:
    assert defect(Symmetric("symmetric", ""))[0] == "p1, None"
    turned = (parse("-p1"), parse("p2"), parse("q1"), parse("q2"))
    assert defect(Reversible("reversible", "", turned))[3] == f"q2, {turned}"


@pytest.mark.parametrize(
    "structure",
    [SymplecticForm("a", "b", {(0, 1): parse("a*p1")}), Poisson("a", "b", {(0, 1): parse("a")}),
     Volume("a", "b", parse("a + p1")), FirstIntegral("a", "b", parse("a*p1")),
     Reversible("a", "b", (parse("a"), parse("p2"))),
     Conformal("a", "b", parse("exp(a*h)", ("a", "h")), {(0, 1): parse("a")})],
    ids=lambda x: type(x).__name__,
)  # fmt: skip
def test_values_stand_in_all_formulas(structure: Structure) -> None:
    a = parse("a")
    inside = structure.with_values({a: sympy.Integer(3)})
    assert type(inside) is type(structure)
    assert (inside.name, inside.label) == ("a", "b")
    assert [x.subs(a, 3) for x in structure.formulas] == list(inside.formulas)
    assert not any(a in x.free_symbols for x in inside.formulas)
    assert inside != structure
    assert hash(inside) is not None


def test_every_structure_has_a_formula_of_its_defect() -> None:
    assert FirstIntegral("energy", "", parse("p1")).defect_formula == "H(z') − H(z)"
    assert FirstIntegral("p1", "", parse("p1")).defect_formula == "I(z') − I(z)"
    assert Volume("volume", "", parse("1")).defect_formula == "ΔJ = det J − 1"
    assert Volume("volume", "", parse("p1")).defect_formula == "ρ(z') det J − ρ(z)"
