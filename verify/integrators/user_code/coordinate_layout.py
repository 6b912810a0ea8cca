"""Layouts of functions of any coordinates: one sequence of all, or several arguments, flattened.

The names of the coordinates may be the user's, their number may be odd, and no half of them is p or
q. A step takes h besides, and perhaps t.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby

from verify.errors import InputError
from verify.integrators.user_code.layout import (
    POSITIONAL,
    CallLayout,
    array,
    role_of,
    shapes,
    signature_of,
)
from verify.integrators.user_code.loading import Callee, check_time_limit
from verify.integrators.user_code.step import Theirs
from verify.integrators.user_code.user_map import UserMap

Groups = tuple[tuple[int, ...], ...]  # the indices of the coordinates in each argument


@dataclass(frozen=True)
class CoordinateLayout(CallLayout):
    """A form of the arguments whose roles are z, for those with coordinates, t and h.

    `groups`: the coordinates of each z, by their indices; `names`: of all. `kind`: "number", where
    an argument with one coordinate is one, and others are arrays; "array" of the shape `shape`, or
    of one axis if that is (); or "list".
    """

    groups: Groups = ()
    names: tuple[str, ...] = ()

    def arguments(self, z: Sequence[Theirs], h: Theirs, t: Theirs) -> list[Theirs]:
        """Return the function's arguments for z, in its order."""
        groups, rest = iter(self.groups), {"h": h, "t": t}
        return [rest[x] if x in rest else self._group([z[k] for k in next(groups)])
                for x in self.roles]  # fmt: skip

    def _group(self, numbers: Sequence[Theirs]) -> Theirs:
        if self.kind == "number" and len(numbers) == 1:
            return numbers[0]
        if self.kind == "list":
            return list(numbers)
        return array(numbers, self.shape or (len(numbers),))

    def state(self, result: Theirs, size: int) -> list[Theirs]:
        """Return z' from the function's result. Raises StepError if it is no state."""
        # The names of the fields of a tuple tell nothing here.
        parts = list(result) if isinstance(result, tuple) else result
        flat = CallLayout.state(self, parts, size)
        places = [k for group in self.groups for k in group]
        return [flat[places.index(k)] for k in range(size)]

    @property
    def expected_result(self) -> str:
        """The clause of a message that tells what the function has to return."""
        return f"wanted: the new {', '.join(self._order)}"

    @property
    def _order(self) -> list[str]:
        return [self.names[k] for group in self.groups for k in group]

    def __str__(self) -> str:
        groups = iter(self.groups)
        texts = []
        for role in self.roles:
            names = [self.names[k] for k in next(groups)] if role == "z" else [role]
            text = ", ".join(names)
            texts.append(text if len(names) == 1 else f"({text})")
        return ", ".join(texts)


def callee_of_coordinates(
    function: Callable[..., Theirs],
    names: tuple[str, ...],
    *,
    stepped: bool,
    parameters: Mapping[str, Fraction] | None = None,
    time_limit: float,
) -> Callee:
    """Return a function of the coordinates `names` as a callee; `stepped`: True if it has an h.

    A step's arguments are taken by the names of the coordinates where they have them, else, as a
    map's, in their order. Raises InputError for a wrong signature.
    """
    check_time_limit(time_limit)
    values = dict(parameters or {})
    signature, text = signature_of(function, () if stepped else values)
    free = [x for x in signature if x.kind in POSITIONAL and x.name not in values]
    needed = [x.name for x in free if x.default is x.empty]
    if stepped and not any(_is("h", x, names) for x in needed):
        # An h with a default is h all the same; without a name of its own it is the last one.
        needed = [x.name for x in free if x.name in needed or _is("h", x.name, names)]
    roles = _roles_of(needed, names, stepped)
    arguments = [x for x, role in zip(needed, roles, strict=True) if role == "z"]
    layouts = [
        CoordinateLayout(roles, shape=shape, kind=kind, groups=groups, names=names)
        for groups in _groupings(arguments, names, stepped)
        for shape, kind in _forms(groups)
    ]
    if not layouts:
        listed = ", ".join(names)
        problem = f"its arguments do not hold the {len(names)} coordinates {listed}"
        raise InputError("integrator" if stepped else "map", text, problem)
    values = {x.name: values[x.name] for x in signature if x.name in values}
    step = UserMap(function, layouts[0], names, values, limit=time_limit)
    return Callee(step, tuple(layouts), True, tuple(needed))


def _is(role: str, name: str, names: Sequence[str]) -> bool:
    return role_of(name) == role and name not in names


def _roles_of(arguments: Sequence[str], names: Sequence[str], stepped: bool) -> tuple[str, ...]:
    """Return the role of each argument; without a name that tells h, it is the last one."""
    if not stepped:
        return ("z",) * len(arguments)
    roles = [next((r for r in "ht" if _is(r, x, names)), "z") for x in arguments]
    if "h" not in roles and roles:
        roles[-1] = "h"
    return tuple(roles)


def _groupings(arguments: Sequence[str], names: tuple[str, ...], stepped: bool) -> Iterator[Groups]:
    """Yield the ways in which the arguments may hold the coordinates, the likeliest first."""
    count, size = len(arguments), len(names)
    if not count:
        return
    stems = [tuple(group) for _, group in groupby(range(size), lambda k: _stem(names[k]))]
    by_stem = {_stem(names[group[0]]): group for group in stems}
    if stepped and sorted(arguments) == sorted(names):
        yield tuple((names.index(x),) for x in arguments)
    elif stepped and len(by_stem) == len(stems) and sorted(arguments) == sorted(by_stem):
        yield tuple(by_stem[x] for x in arguments)
    elif count == size:
        yield tuple((k,) for k in range(size))
    elif count == len(stems):
        yield tuple(stems)
    elif size % count == 0:
        width = size // count
        yield tuple(tuple(range(k, k + width)) for k in range(0, size, width))


def _stem(name: str) -> str:
    """Return the name without the number at its end: x of x1."""
    return re.sub(r"_?\d+$", "", name)


def _forms(groups: Groups) -> Iterator[tuple[tuple[int, ...], str]]:
    """Yield the shapes and kinds of the arguments, the usual first."""
    sizes = {len(group) for group in groups}
    if 1 in sizes:
        yield (), "number"
    yield (), "array"
    if len(sizes) == 1:
        yield from ((x, kind) for x, kind in shapes(min(sizes)) if kind == "array" and len(x) > 1)
    yield (), "list"
