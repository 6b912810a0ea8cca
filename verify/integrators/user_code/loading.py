"""A user's own step or map: loaded, and its arguments understood, as far as their names tell.

`verify check-integrator` and `verify.testing` run the user's code; nothing else in `verify` does.

A module is imported so that no file beside it is taken for a library that we import. Much of what a
command imports it imports late, numpy among it, and so do libraries. A user's folder is therefore
searched behind all libraries; the module that was named alone is taken from it first.
"""

import inspect
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import module_from_spec, spec_from_file_location
from itertools import permutations
from pathlib import Path
from types import ModuleType

from verify.errors import InputError, find_nearest, format_suggestion
from verify.integrators.user_code.layout import (
    POSITIONAL,
    CallLayout,
    layouts_of,
    role_of,
    signature_of,
)
from verify.integrators.user_code.step import TIME_LIMIT, Theirs, contain_effects, last_line
from verify.integrators.user_code.user_map import UserMap

_MAX_TIME_LIMIT = 86_400  # seconds
_MAX_LISTED = 8  # functions in an error message
# The roles of the arguments, a letter each: of a step (True), and of a map (False).
_ROLES_OF_CALL = {True: ("pqth", "pqh", "zth", "zh"), False: ("pq", "z")}
_EXPECTED_SIGNATURE = {
    True: "wanted: step(p, q, h) or step(p, q, t, h), which returns p', q', or step(z, h), z'",
    False: "wanted: map(p, q), which returns p', q', or map(z), which returns z'",
}


def load(target: str, called: str = "integrator") -> Callable[..., Theirs]:
    """Run the module of MODULE:FUNCTION or path/to/file.py:FUNCTION, and return the function.

    The module is looked for in the current folder first. `called`: the name of the option in an
    error. Raises InputError if the module does not import, or has no function of that name.
    """
    place, _, name = target.rpartition(":")
    if not place or not name:
        raise InputError(called, target, "write it as MODULE:FUNCTION or file.py:FUNCTION")
    if place.endswith(":"):
        raise InputError(called, target, f"write one : in it, as {place[:-1]}:{name}")
    with contain_effects():
        module = _module(place, target, called)
        target_object: Theirs = module
        for part in name.split("."):
            if not hasattr(target_object, part):
                names = sorted(x for x, f in vars(module).items() if inspect.isfunction(f))
                has = list_functions(names, name) if names else "it has no function"
                raise InputError(called, target, f"{place} has no {name}; {has}")
            target_object = getattr(target_object, part)
    if not callable(target_object):
        raise InputError(
            called, target, f"{name} is no function but {type(target_object).__name__}"
        )
    function: Callable[..., Theirs] = target_object
    return function


def list_functions(functions: Sequence[str], wanted: str) -> str:
    """List the functions, the nearest to the wanted name first."""
    nearest = find_nearest(wanted, functions)
    first = sorted(functions, key=lambda name: name != nearest)[:_MAX_LISTED]
    ellipsis = f", and {len(functions) - _MAX_LISTED} more" if len(functions) > _MAX_LISTED else ""
    return f"{format_suggestion(nearest)}it has: {', '.join(first)}{ellipsis}"


def _module(place: str, target: str, called: str) -> ModuleType:
    path = Path(place)
    try:
        if path.suffix == ".py":
            if not path.is_file():
                raise InputError(called, target, f"there is no file {place}")
            return from_file(path)
        if path.is_file() or "/" in place:
            problem = f"{place} is no Python file; write file.py:FUNCTION"
            raise InputError(called, target, problem)
        return from_folder(place)
    except (InputError, KeyboardInterrupt):
        raise
    except BaseException as error:  # the user's code may raise anything, SystemExit too
        unknown = isinstance(error, ModuleNotFoundError) and error.name == place.split(".")[0]
        hint = "; write the path of its file, as file.py:FUNCTION" if unknown else ""
        problem = f"does not import: {last_line(error)}{hint}"
        raise InputError(called, target, problem) from None


# -- its module -----------------------------------------------------------------------------------


def from_file(path: Path) -> ModuleType:
    """Run a .py file anew and return its module."""
    name = _free_name(path.stem, path.parent.resolve())
    return _execute(spec_from_file_location(name, path))


def from_folder(name: str) -> ModuleType:
    """Import the module of that name from the current folder, or else an installed one."""
    top, dot, submodule = name.partition(".")
    folder = Path.cwd()
    spec = PathFinder.find_spec(top, [str(folder)])
    free = _free_name(top, folder)
    # A folder without __init__.py comes after installed modules, as in Python itself.
    if spec is None or spec.origin is None:
        return import_module(name)
    if free != top and free not in sys.modules:
        paths = spec.submodule_search_locations
        _execute(spec_from_file_location(free, spec.origin, submodule_search_locations=paths))
    return import_module(f"{free}{dot}{submodule}")


def _free_name(name: str, folder: Path) -> str:
    """Return the name, or another one if a library has it; append the folder to the path, so that
    its other modules can be imported."""
    other_folders = [x for x in sys.path if Path(x).resolve() != folder]
    is_taken = (
        name in sys.stdlib_module_names or PathFinder.find_spec(name, other_folders) is not None
    )
    # The folder comes last: a user's `random.py` must not replace Python's for the libraries that
    # are imported later.
    if str(folder) not in sys.path:
        sys.path.append(str(folder))
    return f"{name}_{hash(folder) & 0xFFFFFFFF:x}" if is_taken else name


def _execute(spec: ModuleSpec | None) -> ModuleType:
    assert spec is not None and spec.loader is not None  # noqa: PT018, S101 - a file has one
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # pickles and dataclasses in the module expect it there
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[spec.name]
        raise
    return module


# -- its signature --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Callee:
    """A user's function, and the layouts in which it may take its state, the likeliest first.

    `named`: True if the names of its arguments tell their roles. `arguments`: these names.
    """

    step: UserMap
    layouts: tuple[CallLayout, ...]
    named: bool = True
    arguments: tuple[str, ...] = ()


def callee_from(
    function: Callable[..., Theirs],
    names: tuple[str, ...],
    *,
    stepped: bool = True,
    arguments: str | None = None,
    parameters: Mapping[str, Fraction] | None = None,
    time_limit: float = TIME_LIMIT,
    strict: bool = False,
) -> Callee:
    """Return the function as a callee with the coordinates `names`, p and q or p1 … qn.

    `stepped`: True if it has an h. `arguments`: the roles in their order, as "q,p,h", or the order
    of the coordinates in the one z of a map, as "q1,p1,q2,p2"; None to read the roles off the
    arguments' names. `parameters`: further arguments by name, which the function may take, and must
    if `strict`. Raises InputError for a wrong signature, or a time limit out of range.
    """
    check_time_limit(time_limit)
    values = dict(parameters or {})
    signature = _Signature(function, stepped, values, strict)
    places: tuple[int, ...] = ()
    if arguments is None:
        orders, names_tell = signature.orders()
    else:
        order, places = _parse_arguments(arguments, names, stepped, signature)
        orders, names_tell = [order], True
    halves = [("p", "q")] if places else None
    layouts = [x for roles in orders for x in layouts_of(roles, len(names) // 2, halves)]
    layouts = [replace(x, places=places, record=signature.record) for x in layouts]
    values_taken = {name: x for name, x in values.items() if name in signature.takes}
    step = UserMap(function, layouts[0], names, values_taken, limit=time_limit)
    several = len({(x.roles, x.halves) for x in layouts}) > 1
    argument_names = tuple(x.name for x in signature.places[: len(orders[0])])
    return Callee(step, tuple(layouts), names_tell and not several, argument_names)


def check_time_limit(seconds: float) -> None:
    """Raise InputError if the number of seconds is out of range."""
    if not 0.01 <= seconds <= _MAX_TIME_LIMIT:
        problem = f"is no number of seconds from 0.01 to {_MAX_TIME_LIMIT}"
        raise InputError("time limit", seconds, problem)


def foreign_callee(step: UserMap) -> Callee:
    """Return a step of a library or a program as a callee; its interface fixes the layout."""
    return Callee(step, (step.layout,))


class _Signature:
    """The arguments of a function; raises InputError if a step or a map cannot have them."""

    def __init__(
        self, function: Callable[..., Theirs], stepped: bool, values: dict[str, Fraction],
        strict: bool,
    ) -> None:  # fmt: skip
        self.stepped, self.record = stepped, None
        parameters, self.text = signature_of(function, values if strict else ())
        places = [x for x in parameters if x.kind in POSITIONAL]
        self.variadic = not parameters or any(x.kind is x.VAR_POSITIONAL for x in parameters)
        # An argument of a step that has the name of a coordinate, or of h, is that, even if H has a
        # parameter of this name.
        roles = ("p", "q", "h") if stepped else ()
        self.places = [x for x in places if x.name not in values or role_of(x.name) in roles]
        self.needed = [x for x in self.places if x.default is x.empty]
        self.takes = {x.name for x in parameters if x.name in values and x not in self.places[:4]}
        keywords = [x for x in parameters if x.kind is x.KEYWORD_ONLY and x.default is x.empty]
        if any(x.name not in values for x in keywords):
            raise self.wrong()
        if self.places and _is_record(self.places[0].annotation):
            self.record = self.places[0].annotation

    def wrong(self) -> InputError:
        """Return the error of a signature that no step, or no map, can have."""
        return InputError(
            "integrator" if self.stepped else "map", self.text, _EXPECTED_SIGNATURE[self.stepped]
        )

    def orders(self) -> tuple[list[tuple[str, ...]], bool]:
        """Return possible roles of its arguments, the likeliest first, and True if names tell."""
        if self.variadic and not self.needed:
            return [tuple("pqh" if self.stepped else "pq")], True
        roles = [role_of(x.name) for x in self.places]
        for expected in _ROLES_OF_CALL[self.stepped]:
            named_roles = roles[: len(expected)]
            if sorted(named_roles) == sorted(expected) and len(self.needed) <= len(expected):
                return [tuple(named_roles)], True
        # For one number of arguments there may be two calls: that with p and q wins, which is the
        # later one in the reversed order.
        counts = {len(x): x for x in reversed(_ROLES_OF_CALL[self.stepped])}
        count = len(self.needed)
        if count not in counts:
            count = max((n for n in counts if count <= n <= len(self.places)), default=0)
        roles_from_names = set(roles[:count]) - {""}
        pq, pqh = {"p", "q"} <= roles_from_names, {"p", "q", "h"} <= roles_from_names
        if not count or (self.stepped and ((count == 2 and pq) or (count == 4 and pqh))):
            raise self.wrong()
        # For a map the order does not matter: if (p, q) is symplectic, (q, p) is too.
        return list(_matching_orders(roles[:count], counts[count])), not self.stepped or count == 1


def _matching_orders(roles: Sequence[str], wanted: str) -> Iterator[tuple[str, ...]]:
    """Yield the orders that agree with the roles that the names tell, the usual order first."""
    fixed = [role if role in wanted and roles.count(role) == 1 else "" for role in roles]
    orders = sorted(set(permutations(wanted)), key=lambda x: (x != tuple(wanted), x))
    for order in orders:
        if all(role in ("", r) for role, r in zip(fixed, order, strict=True)):
            yield order


def _is_record(annotation: object) -> bool:
    return isinstance(annotation, type) and sorted(
        map(role_of, getattr(annotation, "_fields", ()))
    ) == ["p", "q"]


def _parse_arguments(
    arguments: str, names: tuple[str, ...], stepped: bool, signature: _Signature
) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Parse `arguments` to the roles, and the positions of the coordinates in one z."""
    words = [name.strip() for name in arguments.split(",")]
    if not stepped and sorted(words) == sorted(names):
        if len(names) == 2 and len(signature.needed) == 2:
            return tuple(words), ()
        return ("z",), tuple(map(words.index, names))
    roles = [role_of(word) for word in words]
    if sorted(roles) not in map(sorted, _ROLES_OF_CALL[stepped]):
        names_text = ", ".join(names)
        problem = "is no order of p, q and h, such as q,p,h, nor of p, q, t and h"
        raise InputError(
            "--arguments", arguments, problem if stepped else f"is no order of {names_text}"
        )
    return tuple(roles), ()
