"""The purity of the objects that a function reaches, and the changes that a call makes to them.

A trace records one call. It proves something of all calls only if the function is the same each
time: if each object that it reaches is pure, by the lists here, or is a copy of ours that the call
leaves unchanged. Symbols take a single path through the code, so that a change by any call would be
a change by the traced one.
"""

import contextlib
import functools
import sys
import types
from collections import namedtuple
from collections.abc import Mapping
from decimal import Decimal
from enum import Enum, EnumType
from fractions import Fraction
from pathlib import Path
from typing import Any

_EXACT_TYPES = (int, float, complex, bool, str, bytes)
_PLAIN_TYPES = (
    *_EXACT_TYPES, type(None), types.EllipsisType, types.NotImplementedType, range, slice, Fraction,
    Decimal, object, types.GenericAlias, types.UnionType, type(vars(namedtuple("One", "x"))["x"]),
)  # fmt: skip
_PLAIN_MODULES = ("typing", "dataclasses")  # their objects declare types and fields
# The pure names of each module; "" for all functions and classes that it defines.
_PURE_NAMES = {
    "builtins": """abs all any bin bool bytearray bytes callable chr classmethod complex dict divmod
        enumerate filter float format frozenset getattr hasattr int isinstance issubclass iter len
        list map max memoryview min next object oct ord pow print property range repr reversed round
        set slice sorted staticmethod str sum super tuple type zip""",
    "numpy": """arange array asanyarray asarray asarray_chkfinite ascontiguousarray asfortranarray
        broadcast c_ dtype e empty errstate eye finfo fromfunction fromiter full identity iinfo
        index_exp indices isscalar matrix mgrid ndarray ndenumerate ndindex ogrid ones pi poly1d r_
        require s_ tri tril_indices triu_indices vectorize zeros""",
    "collections": "namedtuple deque OrderedDict defaultdict Counter ChainMap",
    "contextlib": "nullcontext suppress",
    "copy": "copy deepcopy",
    "dataclasses": "asdict astuple dataclass field fields replace",
    "types": "MappingProxyType SimpleNamespace",
    **dict.fromkeys(("math", "cmath", "operator", "itertools", "functools", "fractions", "numbers",
                     "typing", "abc", "enum", "numpy.linalg", "numpy.fft", "scipy.special"), ""),
}  # fmt: skip
Contents = Mapping[Any, Any]  # the parts of an object, by the names of attributes or by indices


def pure_objects() -> dict[int, tuple[str, Any]]:
    """Return the pure objects of the loaded modules with their names, by their ids."""
    return _pure_in(tuple(name for name in _PURE_NAMES if name in sys.modules))


@functools.lru_cache(1)
def _pure_in(homes: tuple[str, ...]) -> dict[int, tuple[str, Any]]:
    # If two modules have the same function, the first one names it: scipy.special has numpy's sinc.
    return {
        id(x): (f"{home}.{name}", x)
        for home in reversed(homes)
        for name, x in vars(sys.modules[home]).items()
        if name in _PURE_NAMES[home].split() or _is_pure(home, x)
    }


def _is_pure(home: str, x: Any) -> bool:
    if home == "numpy" and isinstance(x, type):
        return issubclass(x, types_of_numpy("generic"))
    if home == "math" and isinstance(x, float):
        return True
    if home.startswith(("numpy", "scipy")):  # these are what numpy's other arrays may stand for
        return type(x).__name__ in ("ufunc", "_ArrayFunctionDispatcher")
    defined = (getattr(x, "__module__", None) or "").lstrip("_")
    return _PURE_NAMES[home] == "" and callable(x) and defined == home


def is_plain(x: Any) -> bool:
    """Return True for a number, a text, None, a type, …: an object that never changes, and has no
    parts that do."""
    kind = type(x)
    if isinstance(x, type) and issubclass(x, BaseException):
        return not is_of_user(x)
    if isinstance(x, Enum):
        return is_plain(type(x)) and is_plain(x.value)
    if isinstance(x, EnumType):
        methods = [part for part in vars(x).values() if isinstance(part, types.FunctionType)]
        return not any(map(is_of_user, methods))
    scalar = types_of_numpy("number", "bool", "dtype")
    return kind in _PLAIN_TYPES or kind.__module__ in _PLAIN_MODULES or isinstance(x, scalar)


def types_of_numpy(*names: str) -> tuple[type[Any], ...]:
    """Return the types of numpy with these names; () if numpy is not loaded."""
    return tuple(getattr(sys.modules["numpy"], x) for x in names) if "numpy" in sys.modules else ()


def is_users_module(x: types.ModuleType) -> bool:
    """Return True if the module is the user's: neither of Python's library nor installed."""
    # Modules without a file are built in.
    folders = Path(getattr(x, "__file__", None) or "site-packages").parts
    standard = x.__name__.partition(".")[0] in sys.stdlib_module_names
    return not standard and not {"site-packages", "dist-packages"} & set(folders)


def is_of_user(x: Any) -> bool:
    """Return True if a function or class is the user's: of no library, nor of this package."""
    home = x.__module__ or ""
    # Without a module, or in `__main__`, it was written by the user.
    module = sys.modules.get(home)
    if module is None or home == "__main__":
        return True
    return home.partition(".")[0] != __name__.partition(".")[0] and is_users_module(module)


def describe_reached(x: Any, name: str) -> str:
    """Describe it by what a user can look for: `time.time`, or its name with its type."""
    if not isinstance(x, type | types.FunctionType | types.BuiltinFunctionType | types.MethodType):
        return f"{name} ({_qualified_name(type(x))})"
    return name if "." in name or not getattr(x, "__module__", None) else _qualified_name(x)


def _qualified_name(x: Any) -> str:
    home = "" if x.__module__ in ("builtins", "__main__") else f"{x.__module__}."
    return ".".join(part.lstrip("_") or part for part in f"{home}{x.__qualname__}".split("."))


class Surroundings:
    """The impure things that a traced function reached, and the mutable ones that it was handed."""

    def __init__(self) -> None:
        self.reached: dict[str, None] = {}  # in their order
        self._watched: list[tuple[str, Any, Contents]] = []

    def reach(self, text: str) -> None:
        """Record that the function reached this."""
        self.reached[text] = None

    def watch(self, name: str, x: Any, before: Contents | None = None) -> None:
        """Record that it was handed x. `before`: what x then holds, where that is not what it holds
        now."""
        self._watched.append((name, x, contents(x) if before is None else before))

    @property
    def texts(self) -> list[str]:
        """All that keeps the trace from being a proof for every call."""
        changed = {
            f"{_join_name(name, part)} is changed": None
            for name, x, before in self._watched
            for part in _changed_parts(before, contents(x))
        }
        return [*self.reached, *changed]


def _join_name(name: str, part: str | int) -> str:
    return name if isinstance(part, int) else f"{name}.{part}".lstrip(".")


def _changed_parts(before: Contents, after: Contents) -> list[str | int]:
    return [
        part
        for part in {**before, **after}
        if part not in before or part not in after or not _are_same(before[part], after[part])
    ]


def _are_same(x: Any, y: Any) -> bool:
    return x is y or (type(x) is type(y) and type(x) in _EXACT_TYPES and x == y)


def contents(x: Any) -> dict[Any, Any]:
    """Return what x holds, by the names of its attributes, or by places."""
    if isinstance(x, types.CellType):
        with contextlib.suppress(ValueError):  # it has no value yet
            return {0: x.cell_contents}
        return {}
    if type(x) in (list, set):
        return dict(enumerate(x))
    if type(x) is dict:
        return dict(enumerate([*x, *x.values()]))
    if isinstance(x, types_of_numpy("ndarray")):
        return dict(enumerate(x.ravel().tolist() if x.dtype == object else [x.tobytes()]))
    return dict(x) if isinstance(x, dict) else attributes(x)


def attributes(x: Any) -> dict[Any, Any]:
    """Return the attributes that x holds itself, but for what a property keeps of them."""
    slots = {
        name: part.__get__(x)
        for base in type(x).__mro__
        for name, part in vars(base).items()
        if isinstance(part, types.MemberDescriptorType) and hasattr(x, name) and name[:2] != "__"
    }
    return {**slots, **getattr(x, "__dict__", {})}
