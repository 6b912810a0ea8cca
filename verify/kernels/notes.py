"""Notes on the way of a run, numbers by their names, and the point with them that is kept."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from typing import Annotated, Any, TypeVar

from pydantic import PlainSerializer, PlainValidator, TypeAdapter

from verify.execution.keeper import fraction_of, fraction_text
from verify.scenes.results.run import SeriesPoint

T = TypeVar("T")
ExactNumber = Annotated[Fraction, PlainValidator(fraction_of), PlainSerializer(fraction_text)]
Note = Mapping[str, Fraction]


class LazyNote(Mapping[str, Fraction]):
    """The numbers of a state after so many steps, each computed when it is first read: most notes
    are hardly read."""

    __slots__ = ("_cache", "_make", "_names", "_state", "_steps_done")

    def __init__(
        self,
        names: tuple[str, ...],
        make: Callable[[str, Sequence[Any], int], Fraction],
        state: Sequence[Any],
        done: int,
    ) -> None:
        """`make`: computes the number of that name from the state and the steps done."""
        self._names, self._make, self._state, self._steps_done = names, make, state, done
        self._cache: dict[str, Fraction] | None = None

    def __getitem__(self, name: str) -> Fraction:
        if self._cache is None:
            self._cache = {}
        if name not in self._cache:
            if name not in self._names:
                raise KeyError(name)
            self._cache[name] = self._make(name, self._state, self._steps_done)
        return self._cache[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    @property
    def state(self) -> Sequence[Any]:
        """The state that the numbers are computed from, as the arithmetic has it."""
        return self._state


class Notes(Sequence[T]):
    """An immutable sequence of notes; adding one makes another sequence, which shares the older
    notes."""

    __slots__ = ("_count", "_items")

    def __init__(self, items: Iterable[T] = ()) -> None:
        self._items = list(items)
        self._count = len(self._items)

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: Any) -> Any:
        return self._items[: self._count][index]

    def __iter__(self) -> Iterator[T]:
        return iter(self._items[: self._count])

    def and_then(self, item: T) -> "Notes[T]":
        """Return these and one more."""
        # Notes of another branch, or of an interrupted call, may lie behind these.
        shared = self._items if len(self._items) == self._count else self._items[: self._count]
        shared.append(item)
        # The list is shared and only `_count` differs, so that adding a note takes constant time.
        after: Notes[T] = Notes()
        after._items, after._count = shared, self._count + 1
        return after


@dataclass(frozen=True)
class ReachedPoint:
    """The point that a run has reached after some chunks, with its notes: all that a checkpoint
    keeps.

    `trail` has p, q and the observables at points on the way and at the last step done, as the
    exact rationals that they are; `tangents` what `verify.kernels.step.tangent_map` notes, at the
    same points, with the entries of W (`w_a_b`, a < b) if they are requested. `state`: all that is
    carried; `seen`: extremes since the last note.
    """

    done: int = 0
    seconds: float = 0.0
    state: Sequence[ExactNumber] = ()
    seen: dict[str, ExactNumber] = field(default_factory=dict)
    trail: tuple[Mapping[str, ExactNumber], ...] = ()
    tangents: tuple[Mapping[str, ExactNumber], ...] = ()
    series: tuple[SeriesPoint, ...] = ()


@cache
def checkpoint_adapter() -> TypeAdapter[ReachedPoint]:
    """Return the reader and writer of kept points, made once."""
    return TypeAdapter(ReachedPoint)
