"""Replacements of functions of `math` and numpy that accept our numbers, too.

numpy's `solve`, `inv` and `det` are among them, as LAPACK does not take our numbers.
"""

import operator
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

from verify.integrators.tracing.named_functions import OF_ONE, OF_TWO, OPERATORS, hypot
from verify.integrators.tracing.traced_number import Kind, TracedNumber, constant

_PLAIN = int | float | Fraction
_FLOATS = ("float", "float64", "double")
_FILLING_FUNCTIONS = (
    "zeros", "ones", "empty", "full", "zeros_like", "ones_like", "empty_like", "full_like", "eye",
    "identity",
)  # fmt: skip
_UFUNC_METHODS = ("accumulate", "at", "outer", "reduce")
_CONVERTING_FUNCTIONS = ("array", "asarray")
_FLOAT_CODES = ("float", "float64", "double", "d", "f8")
# These keep plain numbers as floats: code uses them to compute how often something is done.
_COUNTING_FUNCTIONS = (
    "log2", "log10", "exp2", "sign", "maximum", "minimum", "fmax", "fmin", "copysign", "heaviside",
)  # fmt: skip


def replacement(kind: Kind, called: str, x: Any) -> Any:
    """Return the replacement of x, whose full name is `called`, as "math.sin"; x itself if none is
    needed."""
    home, _, name = called.rpartition(".")
    if name in _FLOATS:
        return Float
    if home == "numpy.linalg" and name in _OF_MATRICES:
        return _guard(partial(_OF_MATRICES[name], kind), x)
    if home not in ("math", "numpy"):
        return x
    if name in ("pi", "e", "tau"):
        pi = kind.pi()
        return {"pi": pi, "tau": 2 * pi, "e": kind.rational(Fraction(1)).apply("exp")}[name]
    if name in _OF_NUMBERS or (home == "math" and name == "pow"):
        return _apply_to_numbers(
            kind, _OF_NUMBERS.get(name, operator.pow), x, plain=name not in _COUNTING_FUNCTIONS
        )
    if name in (*_FILLING_FUNCTIONS, *_CONVERTING_FUNCTIONS):
        return _of_objects(x, untold=name in _FILLING_FUNCTIONS)
    if home == "math":
        return _guard(_OF_MATH[name], x) if name in _OF_MATH else x
    if name in _OF_NUMPY:
        return _guard(_OF_NUMPY[name], x)
    return x


_OF_NUMBERS: dict[str, Callable[..., Any]] = {**OF_ONE, **OF_TWO}


class _FloatType(type):
    def __instancecheck__(cls, x: object) -> bool:
        return isinstance(x, float | TracedNumber)


class Float(float, metaclass=_FloatType):
    """`float` that lets our numbers through; as an array's type it is that of objects."""

    def __new__(cls, x: Any = 0.0) -> Any:
        return x if isinstance(x, TracedNumber) else float(x)


def _of_objects(original: Callable[..., Any], *, untold: bool) -> Callable[..., Any]:
    """Return a function that builds arrays of objects in place of arrays of floats.

    `untold`: True if the original builds an array of floats when no type is named.
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
    """Return our function for our numbers, alone and in arrays; if `plain`, also for plain numbers,
    which stay exact."""

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
        {name: getattr(original, name) for name in _UFUNC_METHODS if hasattr(original, name)}
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


_OF_MATH: dict[str, Callable[..., Any]] = {
    **{name: OPERATORS[name] for name in ("fabs", "isnan", "isfinite")},
    "isinf": OPERATORS["isnan"],
    "isclose": _isclose,
    "fsum": sum,
    "dist": lambda p, q: hypot(*(x - y for x, y in zip(p, q, strict=True))),
}


def _is_near(x: Any, y: Any, rtol: float = 1e-5, atol: float = 1e-8) -> Any:
    return abs(x - y) <= atol + rtol * abs(y)


def _are_near(*arguments: Any, **options: Any) -> bool:
    near = _is_near(*arguments, **options)
    return bool(near.all() if hasattr(near, "all") else near)


def _is_finite(x: Any) -> Any:
    return x - x == 0  # of an array, too


_OF_NUMPY: dict[str, Callable[..., Any]] = {
    "isfinite": _is_finite,
    "isnan": lambda x: x != x,
    "isclose": _is_near,
    "allclose": _are_near,
}


# -- linear algebra -------------------------------------------------------------------------------


def solve(kind: Kind, matrix: Any, right: Any) -> Any:
    """Solve matrix·x = right for x, one vector or the columns of a matrix."""
    import numpy as np

    right = np.asarray(right, dtype=object)
    rows, _ = _eliminate_numbers(kind, matrix, right.reshape(len(right), -1))
    size = len(rows)
    columns = [[x / row[k] for x in row[size:]] for k, row in enumerate(rows)]
    return np.array(columns, dtype=object).reshape(right.shape)


def inv(kind: Kind, matrix: Any) -> Any:
    """Return the inverse."""
    import numpy as np

    return solve(kind, matrix, np.identity(len(matrix), dtype=object))


def det(kind: Kind, matrix: Any) -> Any:
    """Return the determinant."""
    rows, determinant = _eliminate_numbers(kind, matrix, [()] * len(matrix))
    for k, row in enumerate(rows):
        determinant = determinant * row[k]
    return determinant


def _eliminate_numbers(kind: Kind, matrix: Any, right: Any) -> tuple[list[list[Any]], int]:
    """Apply `eliminate` to our numbers."""
    rows = [[constant(kind, x) for x in (*a, *b)] for a, b in zip(matrix, right, strict=True)]
    return rows, eliminate(rows, partial(_size, kind))


def eliminate(rows: list[list[Any]], size: Callable[[Any], Any]) -> int:
    """Make the left of the rows a diagonal matrix, by Gauss; return the sign of its determinant.

    Pivots are the largest of their columns, by that size.
    """
    sign = 1
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i: size(rows[i][k]))
        # An exchange of rows changes the determinant's sign.
        if pivot != k:
            rows[k], rows[pivot], sign = rows[pivot], rows[k], -sign
        for i, row in enumerate(rows):
            if i != k:
                factor = row[k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(row, rows[k], strict=True)]
    return sign


def _size(kind: Kind, x: Any) -> Any:
    """Return the size by which pivots are chosen: a symbol, of no size, comes first, and 0 last."""
    value = x.exact_value()
    return abs(x) if kind.ordered else 1 if value is None else bool(value) / 2


_OF_MATRICES: dict[str, Callable[..., Any]] = {"solve": solve, "inv": inv, "det": det}
