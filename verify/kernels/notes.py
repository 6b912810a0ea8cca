"""The notes of a run, numbers by name, and the point of a run that a checkpoint keeps."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from typing import Annotated, Any, NamedTuple, TypeVar

from pydantic import PlainSerializer, PlainValidator, TypeAdapter

from verify.arithmetic.number_system import State
from verify.execution.keeper import fraction_of, fraction_text
from verify.scenes.results.run import SeriesPoint

T = TypeVar("T")
ExactNumber = Annotated[Fraction, PlainValidator(fraction_of), PlainSerializer(fraction_text)]
Note = Mapping[str, Fraction]


class LazyNote(Mapping[str, Fraction]):
    """The numbers of a state at one stop; a number is computed when it is first read, since most
    are never read."""

    __slots__ = ("_cache", "_make", "_names", "_state", "_steps_done")

    def __init__(
        self,
        names: tuple[str, ...],
        make: Callable[[str, Sequence[Any], int], Fraction],
        state: Sequence[Any],
        done: int,
    ) -> None:
        """`make` computes the number of a name from the state and the number of steps done."""
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
        """The state from which the numbers are computed, in the arithmetic's numbers."""
        return self._state


class Notes(Sequence[T]):
    """An immutable sequence of notes; `and_then` returns another one, which shares these notes."""

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
        """Return these notes and one more."""
        # The list is shared and only `_count` differs, so that this takes constant time; but
        # another sequence, or an interrupted call, may have added notes to the list: then it is
        # copied.
        shared = self._items if len(self._items) == self._count else self._items[: self._count]
        shared.append(item)
        longer: Notes[T] = Notes()
        longer._items, longer._count = shared, self._count + 1
        return longer


@dataclass(frozen=True)
class ReachedPoint:
    """The point that a run has reached after some chunks, with its notes: the content of a
    checkpoint.

    `trail`: the coordinates and the observables at the noted steps and at the last step done, as
    exact rationals. `tangents`: the numbers of `verify.kernels.step.tangent_map` at the same steps,
    with the entries of W (`w_a_b`, a < b) if they are requested. `state`: the carried numbers;
    `seen`: the extremes since the last note.
    """

    done: int = 0
    seconds: float = 0.0
    state: Sequence[ExactNumber] = ()
    seen: dict[str, ExactNumber] = field(default_factory=dict)
    trail: tuple[Mapping[str, ExactNumber], ...] = ()
    tangents: tuple[Mapping[str, ExactNumber], ...] = ()
    series: tuple[SeriesPoint, ...] = ()


class RunningPoint(NamedTuple):
    """`ReachedPoint` while the loop is running."""

    done: int
    seconds: float
    state: State
    seen: dict[str, Fraction]
    trail: Notes[Mapping[str, Fraction]]
    tangents: Notes[Mapping[str, Fraction]]
    series: Notes[SeriesPoint]


@cache
def checkpoint_adapter() -> TypeAdapter[ReachedPoint]:
    """Return the reader and writer of checkpoints' points."""
    return TypeAdapter(ReachedPoint)
