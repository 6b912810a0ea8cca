"""Replacements of `math`'s and numpy's functions that know our numbers, too."""

import operator
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

from verify.integrators.tracing import derived, linear_algebra
from verify.integrators.tracing.number import OPERATORS, Kind, TracedNumber, constant

_PLAIN = int | float | Fraction
_FLOATS = ("float", "float64", "double")
_FILLED = ("zeros", "ones", "empty", "full", "zeros_like", "ones_like", "empty_like", "full_like",
           "eye", "identity")  # fmt: skip
_METHODS = ("accumulate", "at", "outer", "reduce")  # of numpy's functions
_TYPED, _FLOAT_CODES = ("array", "asarray"), ("float", "float64", "double", "d", "f8")
# Of plain numbers they are left as they are: they say how often something is done.
_COUNTS = ("log2", "log10", "exp2", "sign", "maximum", "minimum", "fmax", "fmin", "copysign",
           "heaviside")  # fmt: skip


def replacement(kind: Kind, called: str, x: Any) -> Any:
    """Return the replacement of x, which is called so, as `math.sin` is; x itself where none is
    needed."""
    home, _, name = called.rpartition(".")
    if name in _FLOATS:
        return Float
    if home == "numpy.linalg" and name in ("solve", "inv", "det"):
        return _guard(partial(getattr(linear_algebra, name), kind), x)
    if home not in ("math", "numpy"):
        return x
    if name in ("pi", "e", "tau"):
        pi = kind.pi()
        return {"pi": pi, "tau": 2 * pi, "e": kind.rational(Fraction(1)).apply("exp")}[name]
    if name in _OF_NUMBERS or (home == "math" and name == "pow"):
        return _apply_to_numbers(
            kind, _OF_NUMBERS.get(name, operator.pow), x, plain=name not in _COUNTS
        )
    if name in (*_FILLED, *_TYPED):
        return _of_objects(x, untold=name in _FILLED)
    if home == "math":
        return _guard(_OTHERS[name], x) if name in _OTHERS else x
    if name in _OF_NUMPY:
        return _guard(_OF_NUMPY[name], x)
    return x


_OF_NUMBERS: dict[str, Callable[..., Any]] = {**derived.OF_ONE, **derived.OF_TWO}


class _FloatType(type):
    def __instancecheck__(cls, x: object) -> bool:
        return isinstance(x, float | TracedNumber)


class Float(float, metaclass=_FloatType):
    """`float` that lets our numbers through; as an array's type it is that of objects."""

    def __new__(cls, x: Any = 0.0) -> Any:
        return x if isinstance(x, TracedNumber) else float(x)


def _of_objects(original: Callable[..., Any], *, untold: bool) -> Callable[..., Any]:
    """Make a function that builds arrays of floats build arrays of objects, which our numbers can
    be put into.

    `untold`: it builds one of floats where no type is named.
    """

    def call(*arguments: Any, **options: Any) -> Any:
        # The first argument is a shape or the contents; a type may stand in any later place.
        arguments = (*arguments[:1], *(object if _is_float(x) else x for x in arguments[1:]))
        has_type = options.get("dtype") is not None or any(
            isinstance(x, type) for x in arguments[1:]
        )
        if _is_float(options.get("dtype")) or (untold and not has_type):
            options["dtype"] = object
        return original(*arguments, **options)

    return call


def _is_float(x: Any) -> bool:
    return x in (float, Float) if isinstance(x, type) else isinstance(x, str) and x in _FLOAT_CODES


def _of_our_numbers(x: Any) -> bool:
    return str(getattr(x, "dtype", "")) == "object"


def _apply_to_numbers(
    kind: Kind, function: Callable[..., Any], original: Callable[..., Any], *, plain: bool = True
) -> Callable[..., Any]:
    """Return our function for our numbers, alone and in arrays; where `plain`, for others, too,
    whose value stays exact."""

    def call(*arguments: Any, **options: Any) -> Any:
        if options or not arguments:
            return original(*arguments, **options)
        if all(isinstance(x, TracedNumber | _PLAIN) for x in arguments):
            if plain or any(isinstance(x, TracedNumber) for x in arguments):
                return function(*(constant(kind, x) for x in arguments))
        # numpy's own functions call methods of the objects in an array; those that have none are
        # mapped here, entry by entry.
        elif any(map(_of_our_numbers, arguments)):
            import numpy as np

            return np.frompyfunc(call, len(arguments), 1)(*arguments)
        return original(*arguments)

    vars(call).update(
        {name: getattr(original, name) for name in _METHODS if hasattr(original, name)}
    )
    return call


def _guard(function: Callable[..., Any], original: Callable[..., Any]) -> Callable[..., Any]:
    """Return `function` where one of our numbers is an argument, alone or in a sequence, else the
    original."""

    def call(*arguments: Any, **options: Any) -> Any:
        numbers = [y for x in arguments for y in (x if isinstance(x, list | tuple) else [x])]
        ours = any(isinstance(x, TracedNumber) or _of_our_numbers(x) for x in numbers)
        return (function if ours else original)(*arguments, **options)

    return call


def _isclose(x: Any, y: Any, *, rel_tol: float = 1e-9, abs_tol: float = 0.0) -> bool:
    return bool(abs(x - y) <= max(rel_tol * max(abs(x), abs(y)), abs_tol))


_OTHERS: dict[str, Callable[..., Any]] = {
    **{name: OPERATORS[name] for name in ("fabs", "isnan", "isfinite")},
    "isinf": OPERATORS["isnan"],
    "isclose": _isclose,
    "fsum": sum,
    "dist": lambda p, q: derived.hypot(*(x - y for x, y in zip(p, q, strict=True))),
}


def _near(x: Any, y: Any, rtol: float = 1e-5, atol: float = 1e-8) -> Any:
    return abs(x - y) <= atol + rtol * abs(y)


def _all_near(*arguments: Any, **options: Any) -> bool:
    near = _near(*arguments, **options)
    return bool(near.all() if hasattr(near, "all") else near)


def _is_finite(x: Any) -> Any:
    return x - x == 0  # of an array, too


_OF_NUMPY: dict[str, Callable[..., Any]] = {
    "isfinite": _is_finite,
    "isnan": lambda x: x != x,
    "isclose": _near,
    "allclose": _all_near,
}
