"""The closed form of an implicit step whose stages are linear equations, block by block.

So they are for linear fields, and where some coordinates move on their own, with the others
linear beside them. No power of h shows what such a step keeps for all h.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians.canonical_field import field_of
from verify.lazy_sympy import sympy
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.closed_form_algebras import FormulaAlgebra, TooLongError, Written
from verify.schemes.maps.step_map import StepMap

_MOST_AT_ONCE = 6  # equations
_MOST_WRITTEN = 5000  # occurrences of coordinates


@lru_cache(maxsize=16)
def write_out(step_map: StepMap) -> ClosedForm | None:
    """Return z' in closed form; None if it is too long, or if the stages are not linear in turn."""
    if step_map.closed is not None or step_map.step is None or not step_map.implicit:
        return step_map.closed
    try:
        changes = step_map.step(_SolvingAlgebra(step_map.field, _MOST_WRITTEN))
        starts = zip(map(symbol, step_map.field.names), changes, strict=True)
        field, elements = field_of(step_map.hamiltonian, *(z + x.expression for z, x in starts))
    except (TooLongError, InputError):
        return None
    return ClosedForm(field, tuple(elements))


class _SolvingAlgebra(FormulaAlgebra):
    """Changes of z as expressions, with equations solved where they are linear, block by block."""

    def solve(  # type: ignore[override]
        self, count: int, right: Callable[[FormulaAlgebra, Sequence[Written]], list[Written]]
    ) -> list[Written]:
        unknowns = [sympy.Dummy() for _ in range(count)]
        sides = [x.expression for x in right(self, [Written(x, 1) for x in unknowns])]
        solution = _solve_blocks(dict(zip(unknowns, sides, strict=True)))
        return [Written(solution[x], 1) for x in unknowns]


def _solve_blocks(sides: Mapping[sympy.Dummy, sympy.Expr]) -> dict[sympy.Dummy, sympy.Expr]:
    """Return the solution of x = sides[x]; TooLongError if a block is not linear in itself.

    A block is the fewest unknowns whose sides have no others, but those that are solved.
    """
    solution = dict[sympy.Dummy, sympy.Expr]()
    while len(solution) < len(sides):
        left = {x: y.xreplace(solution) for x, y in sides.items() if x not in solution}
        needs = {x: y.free_symbols & left.keys() for x, y in left.items()}
        blocks = [_reach(x, needs) for x in left]
        block = min(blocks, key=len)
        names = [x for x in left if x in block]
        slopes = sympy.Matrix([[left[x].diff(y) for y in names] for x in names])
        if slopes.free_symbols & block or len(names) > _MOST_AT_ONCE:
            raise TooLongError
        rest = dict.fromkeys(names, sympy.S.Zero)
        constants = sympy.Matrix([left[x].xreplace(rest) for x in names])
        adjugate, determinant = _invert(sympy.eye(len(names)) - slopes)
        moves = adjugate * constants / determinant
        solution |= dict(zip(names, moves, strict=True))
    return solution


def _invert(matrix: sympy.Matrix) -> tuple[sympy.Matrix, sympy.Expr]:
    """Return the adjugate and the determinant, not simplified, of a matrix that is 1 at h = 0."""
    from sympy.polys.matrices import DomainMatrix

    # Letters in place of entries, as sympy would simplify these at each multiplication.
    letters = dict[sympy.Expr, sympy.Dummy]()
    lettered = matrix.applyfunc(
        lambda x: x if x.is_Rational else letters.setdefault(x, sympy.Dummy())
    )
    adjugate, determinant = DomainMatrix.from_Matrix(lettered).adj_det()
    entries = {letter: x for x, letter in letters.items()}
    number = adjugate.domain.to_sympy(determinant)
    return adjugate.to_Matrix().xreplace(entries), number.xreplace(entries)


def _reach(x: sympy.Dummy, needs: Mapping[sympy.Dummy, set[sympy.Dummy]]) -> set[sympy.Dummy]:
    reach, new = {x}, {x}
    while new:
        new = set().union(*(needs[y] for y in new)) - reach
        reach |= new
    return reach
