"""A copy of a user's function in which `math` and numpy accept our numbers, too.

Everything that the function reaches is copied when it is reached: functions with their closures and
defaults, classes, objects, lists and arrays, and modules with the names that are looked up in them.
So a call of the copy changes nothing of the user's. An object that is neither copied nor pure is
used as it is, and recorded in `Kind.surroundings`, as is an object that a call changes: see
`verify.integrators.tracing.purity`.
"""

import abc
import builtins
import contextlib
import functools
import inspect
import sys
import types
from collections.abc import Iterable
from enum import EnumType
from typing import Any

from verify.integrators.tracing.purity import (
    attributes,
    describe_reached,
    is_of_user,
    is_plain,
    is_users_module,
    pure_objects,
    types_of_numpy,
)
from verify.integrators.tracing.replacements import replacement
from verify.integrators.tracing.traced_number import Kind, TracedNumber

_FOREIGN_LIBRARIES = ("jax", "mpmath", "numba", "numpy", "scipy", "sympy", "torch")
# Attributes with which a class is created; the others are set afterwards, as they may refer to it.
_CREATION_ATTRIBUTES = ("__slots__", "__module__", "__qualname__", "__orig_bases__")
_UNCOPIED_ATTRIBUTES = (*_CREATION_ATTRIBUTES, "__dict__", "__weakref__", "_abc_impl")
# Modules of Python's library that define methods of users' classes.
_METHOD_MODULES = ("collections", "dataclasses", "functools", "typing")
_SLOTS = types.MemberDescriptorType | types.GetSetDescriptorType


def copy_function(function: Any, kind: Kind) -> Any:
    """Return a copy of the function with replaced globals; itself if it is not Python code."""
    return _Copier(kind).value(function, getattr(function, "__name__", type(function).__name__))


def _is_traced(x: types.FunctionType) -> bool:
    """Return True unless it belongs to Python's library, or to one with its own number classes."""
    home = (x.__module__ or "").partition(".")[0]
    return home not in sys.stdlib_module_names - {"__main__"} and home not in _FOREIGN_LIBRARIES


class _Copier:
    """Copies what a function reaches, each thing once."""

    def __init__(self, kind: Kind) -> None:
        self.kind, self.record = kind, kind.surroundings
        self.copies: dict[int, Any] = {}
        self.held_objects: list[Any] = []  # so that no id is used again
        self.late: dict[tuple[int, str], tuple[Any, str]] = {}  # attributes that are not pure
        self.pure = pure_objects()
        self.builtins = {**vars(builtins), "__import__": self._import}

    def value(self, x: Any, name: str = "") -> Any:
        """Return the copy of x, which the function reaches by that name."""
        if id(x) in self.copies:
            return self.copies[id(x)]
        if id(x) in self.pure:
            return self._keep(x, replacement(self.kind, *self.pure[id(x)]))
        if is_plain(x) or isinstance(x, TracedNumber) or self._is_method_of_pure(x):
            if isinstance(x, EnumType):
                for member in list[Any](x):
                    self.record.watch(str(member), member)
            return x
        try:
            copy = self._copy(x, name)
        except (TypeError, AttributeError):  # it does not let itself be made
            copy = x
        if copy is x and type(x) not in (tuple, frozenset):
            self.record.reach(describe_reached(x, name))
        return self._keep(x, copy) if copy is not x else x

    def _keep(self, x: Any, copy: Any) -> Any:
        self.held_objects.append(x)
        self.copies[id(x)] = copy
        return copy

    def _is_method_of_pure(self, x: Any) -> bool:
        """Return True for methods such as `tuple.__new__` and `list.append`."""
        if not isinstance(x, types.BuiltinFunctionType | types.MethodDescriptorType):
            return False
        return id(getattr(x, "__objclass__", getattr(x, "__self__", None))) in self.pure

    def attribute(self, module: types.ModuleType, name: str) -> Any:
        """Return the copy of the attribute of that name of a library's module."""
        x, label = getattr(module, name), f"{module.__name__}.{name}"
        if type(x) in (list, dict, set):  # who may change it is not known
            self.record.reach(describe_reached(x, label))
        return self.value(x, label)

    def _copy(self, x: Any, name: str) -> Any:
        # numba's functions, and those with a cache, hold the plain one.
        inner = getattr(x, "py_func", None) or getattr(x, "__wrapped__", None)
        if isinstance(inner, types.FunctionType) and not isinstance(x, types.FunctionType):
            return self.value(inner, name)
        match x:
            case types.ModuleType():
                return _Module(x, self)
            case types.FunctionType() if _is_traced(x):
                return self._function(x)
            case types.MethodType(__func__=types.FunctionType() as called) if _is_traced(called):
                return types.MethodType(self.value(called), self.value(x.__self__, "self"))
            case functools.partial():
                bound = {k: self.value(v, f"{name}.{k}") for k, v in x.keywords.items()}
                return functools.partial(
                    self.value(x.func, name), *(self.value(v, name) for v in x.args), **bound
                )
            case type() if is_of_user(x):
                return self._class(x)
        return self._holder(x, name)

    def _holder(self, x: Any, name: str) -> Any:
        """Copy a container with what it holds."""
        if type(x) in (tuple, frozenset):
            return type(x)(self.value(v, name) for v in x)
        if type(x) is types.MappingProxyType:
            return types.MappingProxyType(self.value(dict(x), name))
        copy: Any
        if type(x) in (list, set):
            copy = self._keep(x, type(x)())
            (copy.extend if isinstance(copy, list) else copy.update)(self.value(v, name) for v in x)
        elif type(x) is dict:
            copy = self._keep(x, {})
            copy.update((self.value(k, name), self.value(v, name)) for k, v in x.items())
        elif type(x) in types_of_numpy("ndarray"):
            copy = self._keep(x, x.copy())
            if x.dtype == object:
                copy.flat = [self.value(v, name) for v in x.flat]
        elif is_of_user(type(x)) or type(x) is types.SimpleNamespace:
            return self._object(x, name)
        else:
            return x
        # The copy is compared with itself after the call: a change means that the function keeps a
        # state.
        self.record.watch(name, copy)
        return copy

    def scope(self, names: dict[str, Any]) -> "_Scope":
        """Return the copy of a module's globals."""
        if id(names) not in self.copies:
            self._keep(names, _Scope(names, self))
        scope: _Scope = self.copies[id(names)]
        return scope

    def _function(self, x: types.FunctionType) -> types.FunctionType:
        code, scope = x.__code__, self.scope(x.__globals__)
        # Closures share cells: each is copied once, so that two functions that share a variable
        # still do.
        cells = dict(zip(code.co_freevars, x.__closure__ or (), strict=True))
        new = {name: cell for name, cell in cells.items() if id(cell) not in self.copies}
        for cell in new.values():
            self._keep(cell, types.CellType())
        closure = tuple(self.copies[id(cell)] for cell in cells.values())
        copy = types.FunctionType(code, scope, x.__name__, None, closure or None)
        self._keep(x, copy)  # before what it calls: it may call itself
        for name, cell in new.items():
            with contextlib.suppress(ValueError):  # a name that has no value yet
                self.copies[id(cell)].cell_contents = self.value(cell.cell_contents, name)
            self.record.watch(name, self.copies[id(cell)])
        for inner in code.co_consts:  # a class's names are looked up in the globals as they stand
            if isinstance(inner, types.CodeType) and not inner.co_flags & inspect.CO_OPTIMIZED:
                for name in inner.co_names:
                    with contextlib.suppress(KeyError):
                        scope[name]
        of_it = f"a default of {x.__name__}"
        if x.__defaults__:
            copy.__defaults__ = tuple(self.value(v, of_it) for v in x.__defaults__)
        if x.__kwdefaults__:
            copy.__kwdefaults__ = {k: self.value(v, of_it) for k, v in x.__kwdefaults__.items()}
        for name, v in vars(x).items():
            setattr(copy, name, self.value(v, f"{x.__name__}.{name}"))
        self.record.watch(x.__name__, copy)
        return copy

    def _class(self, x: type) -> type:
        if type(x) not in (type, abc.ABCMeta):
            return x  # what others make is not known
        bases = tuple(self.value(base, base.__name__) for base in x.__bases__)
        declared = {name: vars(x)[name] for name in _CREATION_ATTRIBUTES if name in vars(x)}
        if not any("__getattr__" in vars(base) for base in x.__mro__):
            declared["__getattr__"] = lambda instance, name: self._copy_late(instance, name)
        copy: type = self._keep(x, type(x)(x.__name__, bases, declared))
        for name, part in vars(x).items():
            if name not in _UNCOPIED_ATTRIBUTES and not isinstance(part, _SLOTS):
                setattr(copy, name, self._part(part, f"{x.__name__}.{name}", name))
        self.record.watch(x.__name__, copy)
        return copy

    def _part(self, part: Any, called: str, name: str) -> Any:
        """Copy what a class has by that name."""
        match part:
            case property():
                return property(*(f and self.value(f) for f in (part.fget, part.fset, part.fdel)))
            case staticmethod() | classmethod():
                return type(part)(self._part(part.__func__, called, name))
        is_generated = isinstance(part, types.FunctionType) and part.__module__ in _METHOD_MODULES
        return part if is_generated or name == "__annotations__" else self.value(part, called)

    def _object(self, x: Any, name: str) -> Any:
        """Copy an object of a user's class."""
        made_of = self.value(type(x), name)
        if made_of is type(x) and made_of is not types.SimpleNamespace:
            return x
        base = next(c for c in (tuple, types.SimpleNamespace, object) if isinstance(x, c))
        inner = [[self.value(v, name) for v in x]] if isinstance(x, tuple) else []
        instance = self._keep(x, base.__new__(made_of, *inner))
        for part, v in attributes(x).items():
            reached_before, label = dict(self.record.reached), f"{name}.{part}"
            copy = self.value(v, label)
            if copy is v and reached_before != self.record.reached and not hasattr(made_of, part):
                self.record.reached = reached_before  # it is not, before the function asks for it
                self.late[id(instance), part] = v, label
            elif part in getattr(x, "__dict__", {}):
                instance.__dict__[part] = copy
            else:
                object.__setattr__(instance, part, copy)
        self.record.watch(name, instance)
        return instance

    def _copy_late(self, instance: Any, name: str) -> Any:
        """Serve as the `__getattr__` of copied objects, which have copies of all else."""
        if (id(instance), name) not in self.late:
            raise AttributeError(f"{type(instance).__name__!r} object has no attribute {name!r}")
        return self.value(*self.late[id(instance), name])

    def _import(self, *arguments: Any, **options: Any) -> Any:
        return self.value(builtins.__import__(*arguments, **options))


class _Scope(dict[str, Any]):
    """A module's globals, each copied when it is first looked up, and Python's names after them."""

    def __init__(self, names: dict[str, Any], copier: _Copier) -> None:
        special = {name: x for name, x in names.items() if name.startswith("__")}
        super().__init__({**special, "__builtins__": copier.builtins})
        self.names, self.copier, self.initial_values = names, copier, dict(self)
        copier.record.watch("", self, self.initial_values)

    def __missing__(self, name: str) -> Any:
        home = self.names if name in self.names else vars(builtins)
        if name in self.initial_values or name not in home:  # deleted, or not there
            raise KeyError(name)
        self[name] = self.initial_values[name] = self.copier.value(home[name], name)
        return self[name]


class _Module:
    """A module, whose functions are copied or replaced when they are first used."""

    def __init__(self, module: types.ModuleType, copier: _Copier) -> None:
        scope = copier.scope(vars(module)) if is_users_module(module) else None
        vars(self).update(_module=module, _copier=copier, _scope=scope)

    def __getattr__(self, name: str) -> Any:
        if self._scope is None:
            vars(self)[name] = self._copier.attribute(self._module, name)
            return vars(self)[name]
        if name in self._scope or name in vars(self._module):
            return self._scope[name]
        return self._copier.value(getattr(self._module, name), name)

    def __setattr__(self, name: str, value: Any) -> None:
        if self._scope is None:
            self._copier.record.reach(f"{self._module.__name__}.{name} is changed")
            vars(self)[name] = value
        else:
            self._scope[name] = value


def names_in(code: types.CodeType) -> Iterable[str]:
    """Yield the names that the code, and what is defined in it, may look up."""
    yield from code.co_names
    for inner in code.co_consts:
        if isinstance(inner, types.CodeType):
            yield from names_in(inner)
