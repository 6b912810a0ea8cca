"""A step with a term of one's own in it, whatever the step is made of and however it is read."""

from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from typing import Any

from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.canonical_field import VectorField
from verify.schemes.maps.step_map import StepMap

Term = Callable[[Ring], Poly]  # of the coordinates, and of t


class _Alone(VectorField):
    """A field whose one component that is not 0 is the term."""

    def __init__(self, true: VectorField, place: int, term: Poly) -> None:
        self.names, self._true, self._place, self._term = true.names, true, place, term

    @property
    def ring(self) -> Any:
        return self._true.ring

    @property
    def slopes(self) -> tuple[Poly, ...]:
        zero = self.ring.zero
        return tuple(self._term if k == self._place else zero for k in range(len(self.names)))


@contextmanager
def _of_field(algebra: Any, field: VectorField) -> Iterator[None]:
    """The algebra's slopes are those of another field, and nothing is remembered of them."""
    changes: dict[tuple[int, str], tuple[Any, Any]] = {}
    for holder in (algebra, getattr(algebra, "plain", None)):
        for name, other in (("field", field), ("flow", field), ("_recent", deque(maxlen=1))):
            if name in getattr(holder, "__dict__", {}):
                changes[id(holder), name] = holder, getattr(holder, name)
                setattr(holder, name, other)
    try:
        yield
    finally:
        for (_, name), (holder, true) in changes.items():
            setattr(holder, name, true)


def with_term(true: StepMap, place: int, power: int, term: Term) -> StepMap:
    """h^power term(z) added to the coordinate of that place."""
    if true.formulas is not None:
        wrong = list(true.formulas)
        wrong[place] += true.ring.variable("h") ** power * term(true.ring)
        return StepMap(true.hamiltonian, true.field, formulas=tuple(wrong))
    step, alone = true.step, _Alone(true.field, place, term(true.ring))
    assert step is not None

    def changes(algebra: Any) -> list[Any]:
        result, start = step(algebra), [algebra.nothing] * algebra.size
        with _of_field(algebra, alone):
            added = algebra.slopes(start, Fraction(0), [place])
        for _ in range(power):  # each is h times what was added before
            added = [algebra.move(algebra.nothing, [Fraction(1)], added)]
        result[place] = algebra.add_share(result[place], added[0], Fraction(1))
        return result

    return replace(true, step=changes, conditions=(), known_order=lambda: None)
