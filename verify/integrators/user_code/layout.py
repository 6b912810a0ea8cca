"""Layouts: the forms in which a user's step or map takes and returns a state.

A state z is always p1 … pn, q1 … qn here. The user's function may take it as two numbers, two
arrays of any shape, two lists, or one object that holds both halves, in either order.
"""

import inspect
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import prod
from typing import Any

from verify.errors import InputError
from verify.integrators.user_code.step import StepError, Theirs

POSITIONAL = inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD
# The names that people use for the arguments of a step, with the role of each.
ROLES = {
    **dict.fromkeys(
        ("p", "v", "p0", "v0", "pq_p", "momentum", "momenta", "mom", "moms", "velocity",
         "velocities", "vel", "vels", "speed", "qdot", "xdot", "x_dot", "q_dot", "px", "vx"), "p"),
    **dict.fromkeys(
        ("q", "x", "q0", "x0", "r", "position", "positions", "pos", "coordinates", "coords",
         "displacement", "angle", "theta", "phi"), "q"),
    **dict.fromkeys(("t", "time", "t0", "t_n", "tn"), "t"),
    **dict.fromkeys(
        ("h", "dt", "tau", "step", "step_size", "stepsize", "time_step", "timestep", "delta_t",
         "deltat", "eps", "epsilon", "delta", "hh", "ds"), "h"),
    **dict.fromkeys(("z", "y", "state", "s", "u", "w", "y0", "z0", "phase", "qp", "pq"), "z"),
}  # fmt: skip


def role_of(name: str) -> str:
    """Return the role of an argument by its name: p, q, t, h or z; "" if the name does not tell."""
    return ROLES.get(name.lower().strip("_"), "")


def signature_of(
    function: Callable[..., Theirs], needed: Iterable[str]
) -> tuple[list[inspect.Parameter], str]:
    """Return the arguments of a function, and its signature as text.

    Raises InputError if one of the `needed` parameters is none of them.
    """
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):  # some functions written in C have none
        parameters = []
    text = f"{getattr(function, '__name__', 'step')}({', '.join(map(str, parameters))})"
    names = {x.name for x in parameters}
    for name in needed:
        if name not in names:
            raise InputError("parameter", name, f"is no argument of {text}")
    return parameters, text


class StatePair(tuple[Theirs, ...]):
    """p and q as one tuple with attributes by their usual names: y.q, y.pos, y.velocity."""

    order: tuple[str, ...]

    @property
    def _fields(self) -> tuple[str, ...]:
        return self.order

    def __getattr__(self, name: str) -> Theirs:
        role = role_of(name)
        if role not in self.order:
            raise AttributeError(name)
        return self[self.order.index(role)]

    def _replace(self, **changed: Theirs) -> "StatePair":
        parts = {role_of(name): x for name, x in changed.items()}
        return pair([parts.get(name, x) for name, x in zip(self.order, self, strict=True)],
                    self.order)  # fmt: skip


def pair(parts: Sequence[Theirs], order: tuple[str, ...]) -> StatePair:
    """Return the two halves of a state as one tuple; `order` tells which is p and which q."""
    state = StatePair(parts)
    state.order = order
    return state


@dataclass(frozen=True)
class CallLayout:
    """A form of the function's arguments and of its result.

    `roles`: those of the arguments in their order, each p, q, t, h or z. `halves`: the order of p
    and q in z and in the result. `shape`: that of p and of q, () for plain numbers. `kind`: "array"
    or "list"; for one z "flat", an array of all numbers, "rows", an array of two rows, or "pair", a
    tuple of two. `places`: the indices of p1 … qn in a flat z of another order, or (). `record`:
    the class of named tuples that an annotation of z names.
    """

    roles: tuple[str, ...]
    halves: tuple[str, str] = ("p", "q")
    shape: tuple[int, ...] = ()
    kind: str = "array"
    places: tuple[int, ...] = ()
    record: Callable[..., Theirs] | None = None

    @property
    def takes_time(self) -> bool:
        """True if t is an argument."""
        return "t" in self.roles

    @property
    def takes_step_size(self) -> bool:
        """True if h is an argument."""
        return "h" in self.roles

    def arguments(self, z: Sequence[Theirs], h: Theirs, t: Theirs) -> list[Theirs]:
        """Return the function's arguments for z, in its order."""
        n = len(z) // 2
        halves = {"p": z[:n], "q": z[n:]}
        parts: dict[str, Theirs] = {"h": h, "t": t}
        if "z" in self.roles:
            parts["z"] = self._whole(z, halves)
        else:
            parts |= {name: self._shape_half(x) for name, x in halves.items()}
        return [parts[name] for name in self.roles]

    def _whole(self, z: Sequence[Theirs], halves: dict[str, Sequence[Theirs]]) -> Theirs:
        if self.places:
            return array([z[self.places.index(k)] for k in range(len(z))], (len(z),))
        first, second = (halves[name] for name in self.halves)
        if self.kind == "flat":
            return array([*first, *second], (len(z),))
        if self.kind == "rows":
            return array([*first, *second], (2, *self.shape))
        parts = [self._shape_half(first), self._shape_half(second)]
        if self.record is not None:
            return self.record(*parts)
        return pair(parts, self.halves)

    def _shape_half(self, x: Sequence[Theirs]) -> Theirs:
        if self.kind == "list":
            return list(x)
        return array(x, self.shape) if self.shape else x[0]

    def state(self, result: Theirs, size: int) -> list[Theirs]:
        """Return z' from the function's result. Raises StepError if it is no state."""
        # Any nesting of lists, tuples and arrays is accepted if it has as many numbers as z.
        numbers = list(_numbers(result, self.expected_result, depth=4))
        if len(numbers) != size:
            raise StepError(f"it returns {_shape_of(result, len(numbers))}; {self.expected_result}")
        if self.places:
            return [numbers[place] for place in self.places]
        halves = self.halves
        fields = tuple(map(role_of, getattr(result, "_fields", ())))
        if sorted(fields) == ["p", "q"]:
            halves = (fields[0], fields[1])
        n = size // 2
        # In z p stands before q, whatever order the user's function has.
        return numbers if halves == ("p", "q") else [*numbers[n:], *numbers[:n]]

    @property
    def expected_result(self) -> str:
        """The clause of a message that tells what the function has to return."""
        if "z" in self.roles:
            return "wanted: z', of the shape of z"
        first, second = self.halves
        shape = f", arrays of shape {self.shape}" if self.shape and self.kind == "array" else ""
        return f"wanted: {first}', {second}'{shape}"

    def __str__(self) -> str:
        if "z" not in self.roles:
            return ", ".join(self.roles)
        halves_text = ", ".join(self.halves)
        return ", ".join(f"({halves_text})" if name == "z" else name for name in self.roles)


def layouts_of(
    roles: tuple[str, ...], degrees: int, halves: list[tuple[str, str]] | None
) -> Iterator[CallLayout]:
    """Yield the layouts in which a function with these roles may take its state, the usual first.

    `halves`: the possible orders of p and q in z; None for both.
    """
    if "z" not in roles:
        first = "p" if roles.index("p") < roles.index("q") else "q"
        order = ("p", "q") if first == "p" else ("q", "p")
        for shape, kind in shapes(degrees):
            yield CallLayout(roles, order, shape, kind)
        return
    for order in halves or [("p", "q"), ("q", "p")]:
        yield CallLayout(roles, order, (degrees,), "flat")
        for shape, kind in shapes(degrees):
            if kind == "array" and shape:
                yield CallLayout(roles, order, shape, "rows")
        for shape, kind in shapes(degrees):
            yield CallLayout(roles, order, shape, "pair" if kind == "array" else "list")


def shapes(degrees: int) -> Iterator[tuple[tuple[int, ...], str]]:
    """Yield the shapes and kinds of p and q for n degrees of freedom, the usual first."""
    if degrees == 1:
        yield from (((), "array"), ((1,), "array"), ((1, 1), "array"))
        return
    yield (degrees,), "array"
    yield from (((degrees // k, k), "array") for k in (3, 2, 1) if degrees % k == 0)
    yield (degrees,), "list"


def array(numbers: Sequence[Theirs], shape: tuple[int, ...]) -> Theirs:
    """Build an array of floats, or of Python objects if the numbers are of our classes."""
    import numpy as np

    objects = np.empty(prod(shape), dtype=float if isinstance(numbers[0], float) else object)
    for k, x in enumerate(numbers):
        objects[k] = x
    return objects.reshape(shape)


def _shape_of(result: Theirs, count: int) -> str:
    parts = result if isinstance(result, tuple | list) else [result]
    arrays = [x.shape for x in parts if getattr(x, "shape", ())]
    shaped = f", in arrays of shape {', '.join(map(str, arrays))}" if arrays else ""
    return f"{count} number{'s' if count != 1 else ''}{shaped}"


def _numbers(result: Theirs, wanted: str, depth: int) -> list[Theirs]:
    if result is None or isinstance(result, str | bytes | dict | set):
        kind = "None" if result is None else "text" if isinstance(result, str) else None
        raise StepError(f"it returns {kind or type(result).__name__}; {wanted}")
    if getattr(result, "shape", ()):
        result = list(result.ravel())
    if not isinstance(result, list | tuple):
        of_numpy = hasattr(result, "dtype") and hasattr(result, "reshape")
        return [result[()] if of_numpy else result]
    if depth == 0:
        raise StepError(f"it returns lists in lists in lists; {wanted}")
    return [x for part in result for x in _numbers(part, wanted, depth - 1)]


OfNumber = Callable[[Fraction], Any]
