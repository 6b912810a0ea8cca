"""What is noted on the way of a run: numbers by their names, and one note after another."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, TypeVar

T = TypeVar("T")


class LazyNote(Mapping[str, Fraction]):
    """The numbers of a state after so many steps, each made where it is first looked at: of most
    notes few are."""

    __slots__ = ("_done", "_made", "_make", "_names", "_state")

    def __init__(
        self,
        names: tuple[str, ...],
        make: Callable[[str, Sequence[Any], int], Fraction],
        state: Sequence[Any],
        done: int,
    ) -> None:
        """`make`: a name's number, of the state and the steps done."""
        self._names, self._make, self._state, self._done = names, make, state, done
        self._made: dict[str, Fraction] | None = None

    def __getitem__(self, name: str) -> Fraction:
        if self._made is None:
            self._made = {}
        if name not in self._made:
            if name not in self._names:
                raise KeyError(name)
            self._made[name] = self._make(name, self._state, self._done)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    @property
    def state(self) -> Sequence[Any]:
        """What they are made of, as the arithmetic has it."""
        return self._state


class Notes(Sequence[T]):
    """Some notes, which stay as they are: one more makes others, that share what lies before it."""

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
        """These and one more."""
        # Somebody else's, or what was left by an interruption, may lie behind these.
        shared = self._items if len(self._items) == self._count else self._items[: self._count]
        shared.append(item)
        after: Notes[T] = Notes()
        after._items, after._count = shared, self._count + 1
        return after
