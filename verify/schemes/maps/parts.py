"""A step as maps applied in turn, each in closed form: the kicks and drifts of a splitting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NoReturn

from verify.algebra.formula import symbol
from verify.algebra.ring import Poly
from verify.effort import limit_effort
from verify.hamiltonians.canonical_field import PlainField, field_of
from verify.lazy_sympy import sympy
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.closed_form_algebras import TooLongError
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import Number, StepAlgebra


@dataclass(frozen=True)
class _Shear:
    """A shear: the coordinates `places` move by h `size` f, with f at the time t + `clock` h."""

    size: Poly
    clock: Poly
    places: tuple[int, ...]


class _ShearRecorder(StepAlgebra[None]):
    """A step algebra that records the shears of a step, and nothing else."""

    def __init__(self, field: PlainField) -> None:
        self.field, self.shears = field, list[_Shear]()

    @property
    def nothing(self) -> None:
        return None

    @property
    def size(self) -> int:
        return len(self.field.names)

    def shear(
        self, changes: Sequence[None], size: Number, clock: Number, places: Sequence[int]
    ) -> list[None]:
        ring = self.field.ring
        share, clock_share = (
            ring.constant(x) if isinstance(x, Fraction) else x for x in (size, clock)
        )
        self.shears.append(_Shear(share, clock_share, tuple(places)))
        return list(changes)

    def _no_shear(self, *_: Any) -> NoReturn:
        raise TooLongError

    along_flow = slopes = move = add_share = solve = _no_shear  # type: ignore[assignment]


def parts_of(step_map: StepMap) -> tuple[ClosedForm, ...] | None:
    """Return the maps that a step is composed of, in their order, over one field.

    They are its shears, or the map itself if it is defined in closed form; None for other maps.
    """
    if step_map.formulas is not None:
        return (step_map.flat,)
    if step_map.step is None or step_map.implicit:
        return None
    recorder = _ShearRecorder(step_map.field)
    try:
        step_map.step(recorder)
    except TooLongError:
        return None
    field, moves = _moves(step_map, recorder.shears)
    # The moves come in the order of the shears and, within one, of its places.
    remaining_moves, parts = iter(moves), []
    for shear in recorder.shears:
        elements = list(field.start)
        for k in shear.places:
            elements[k] += next(remaining_moves)
        parts.append(ClosedForm(field, tuple(elements)))
    return tuple(parts)


def _moves(step_map: StepMap, shears: Sequence[_Shear]) -> tuple[PlainField, Sequence[Poly]]:
    """Return the increments of all shears, one after the other, with a field in their ring.

    If H depends on time, each shear takes f at its own time.
    """
    field, exact = step_map.field, step_map.hamiltonian
    if not field.timed:
        return field, [x for shear in shears for x in field.shears(shear.size, shear.places)]
    expression_of, t, h = field.ring.expression, symbol("t"), symbol("h")
    moves: list[sympy.Expr] = []
    slopes = [expression_of(x) for x in field.slopes]
    with limit_effort("hamiltonian", str(exact.expression), "to put the parts' times into it"):
        for shear in shears:
            later = t + h * expression_of(shear.clock)
            share = h * expression_of(shear.size)
            moves += [share * slopes[k].subs(t, later) for k in shear.places]
    return field_of(exact, *moves)
