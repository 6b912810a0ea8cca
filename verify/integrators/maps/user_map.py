"""A user's own map as it is called: map(p, q) with sequences, map(p, q) of the plane, or map(z)."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Protocol

from verify.arithmetic.exact import rational
from verify.errors import InputError
from verify.hamiltonians.coordinates import PLANE, check_degrees, numbered
from verify.integrators.number_type import DOUBLE, NumberType
from verify.integrators.step import TIME_LIMIT, StepError, Theirs, limited, single

_POSITIONAL = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD
_WANTED = "wanted: map(p, q), which returns p', q', or map(z), which returns z'"


class CallableMap(Protocol):
    """What a probe calls: a map, or a step with its h."""

    @property
    def function(self) -> Callable[..., Theirs]: ...

    @property
    def names(self) -> tuple[str, ...]: ...

    @property
    def numbers(self) -> NumberType:
        """What it computes in."""
        ...

    def called(
        self,
        function: Callable[..., Theirs],
        z: Sequence[Theirs],
        of_number: Callable[[Fraction], Theirs],
    ) -> list[Theirs]: ...


@dataclass
class UserMap:
    """`names`: p and q, or p1 … qn, in our order; `places`: where each stands in the one z that the
    function takes, or None where it takes p and q. `given`: further arguments by their names.
    `left`: seconds left for its calls.
    """

    function: Callable[..., Theirs]
    names: tuple[str, ...]
    places: tuple[int, ...] | None
    given: Mapping[str, Fraction] = field(default_factory=dict)
    left: float = TIME_LIMIT

    @property
    def degrees(self) -> int:
        """Of freedom."""
        return len(self.names) // 2

    @property
    def numbers(self) -> NumberType:
        """What it computes in: in Python that is floats."""
        return DOUBLE

    def called(
        self,
        function: Callable[..., Theirs],
        z: Sequence[Theirs],
        of_number: Callable[[Fraction], Theirs],
    ) -> list[Theirs]:
        """z' in our order, of the function or a copy of it. Raises StepError, and its errors."""
        given = {name: of_number(x) for name, x in self.given.items()}
        with limited(self):
            if self.places is not None:
                one = array([z[self.places.index(k)] for k in range(len(z))])
                found = self._flat(function(one, **given))
                return [found[place] for place in self.places]
            if self.names == PLANE:
                return self._flat(function(*z, **given))
            return self._flat(function(*arrays(z), **given))

    def _flat(self, result: Theirs) -> list[Theirs]:
        return flat(result, len(self.names))


def array(numbers: Sequence[Theirs]) -> Theirs:
    """Of floats; or of numbers of ours, as objects."""
    import numpy as np

    made = np.empty(len(numbers), dtype=float if isinstance(numbers[0], float) else object)
    for k, x in enumerate(numbers):
        made[k] = x
    return made


def arrays(z: Sequence[Theirs]) -> tuple[Theirs, Theirs]:
    """p and q of z, as arrays."""
    half = len(z) // 2
    return array(z[:half]), array(z[half:])


def flat(result: Theirs, count: int, wanted: str = _WANTED) -> list[Theirs]:
    """So many numbers that were returned, in sequences or not. Raises StepError, with what is
    wanted."""
    found = list(_numbers(result, wanted, depth=3))
    if len(found) != count:
        raise StepError(f"it returns {len(found)} numbers; wanted: {count}")
    return found


def _numbers(result: Theirs, wanted: str, depth: int) -> list[Theirs]:
    if result is None or isinstance(result, str | bytes | dict | set):
        kind = "None" if result is None else type(result).__name__
        raise StepError(f"it returns {kind}; {wanted}")
    if getattr(result, "shape", ()):
        result = list(result.ravel())
    if not isinstance(result, list | tuple):
        return [single(result)]
    if depth == 0:
        raise StepError(f"it returns lists of lists of lists; {wanted}")
    return [x for part in result for x in _numbers(part, wanted, depth - 1)]


def map_from(
    function: Callable[..., Theirs],
    degrees: int,
    arguments: str | None = None,
    parameters: Mapping[str, Fraction] | None = None,
    time_limit: float = TIME_LIMIT,
) -> UserMap:
    """The function as a map in so many degrees of freedom.

    `arguments`: the order of the coordinates in the one z that it takes, such as "q1,p1,q2,p2".
    `parameters`: further arguments that it takes by name. InputError for a wrong signature.
    """
    check_degrees(degrees)
    names = PLANE if degrees == 1 else numbered(degrees)
    places = None if arguments is None else _places(arguments, names)
    given = parameters or {}
    try:
        named = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):  # some functions written in C have none
        return UserMap(function, names, places, given, time_limit)
    shown = f"{getattr(function, '__name__', 'map')}({', '.join(map(str, named))})"
    known = {x.name for x in named}
    for name in given:
        if name not in known:
            raise InputError("parameter", name, f"is no argument of {shown}")
    own = [x for x in named if x.kind in _POSITIONAL and x.name not in given]
    needed = [x for x in own if x.default is x.empty]
    kept = [x for x in named if x.kind is x.KEYWORD_ONLY and x.default is x.empty]
    if places is None and len(needed) == 1:
        places = tuple(range(len(names)))
    count = 2 if places is None else 1
    if len(needed) > count or len(own) < count or any(x.name not in given for x in kept):
        raise InputError("map", shown, _WANTED)
    return UserMap(function, names, places, given, time_limit)


def _places(arguments: str, names: tuple[str, ...]) -> tuple[int, ...]:
    order = [name.strip() for name in arguments.split(",")]
    if sorted(order) != sorted(names):
        problem = f"is no order of {', '.join(names)}"
        raise InputError("--arguments", arguments, problem)
    return tuple(map(order.index, names))


def start_of(own: UserMap, p: str | None, q: str | None) -> list[Fraction] | None:
    """A point that is written as two lists, p1,p2 and q1,q2; None where neither is given."""
    if p is None and q is None:
        return None
    if p is None or q is None:
        raise InputError("--p, --q", p or q or "", "give both or none")
    point = list[Fraction]()
    for name, written in (("p", p), ("q", q)):
        numbers = [rational(part.strip(), f"--{name}") for part in written.split(",")]
        if len(numbers) != own.degrees:
            problem = f"has {len(numbers)} numbers; allowed: {own.degrees}, as --degrees says"
            raise InputError(f"--{name}", written, problem)
        point += numbers
    return point
