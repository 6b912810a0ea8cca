"""Functions and operators by the names that numpy and `math` have for them.

Functions that are made of others are written once here, for numbers of any kind; what one asks of
its argument is what its parts do.
"""

import operator
from collections.abc import Callable
from fractions import Fraction
from operator import methodcaller
from typing import Any

from verify.functions import by_name

_HALF, _THIRD = Fraction(1, 2), Fraction(1, 3)


def _degree(x: Any) -> Any:
    return x.kind.pi() / 180


def _root(x: Any) -> Any:
    return x.raise_to(_HALF)


def _log(x: Any) -> Any:
    return x.apply("log")


def _log_of(base: int) -> Callable[[Any], Any]:
    return lambda x: _log(x) / _log(x.kind.rational(Fraction(base)))


def _arcsin(x: Any) -> Any:
    return (x / _root(1 - x * x)).apply("atan")


def _sinc(x: Any) -> Any:
    turned = x.kind.pi() * x
    return turned.apply("sin") / turned


def _sign(x: Any, at_zero: Any = 0) -> Any:
    """Return the sign of x, by comparisons, as a number of its kind."""
    return x * 0 + (at_zero if x == 0 else 1 if x > 0 else -1)


def arctan2(y: Any, x: Any) -> Any:
    """Return the angle of the point (x, y); its branch is where y = 0 and x < 0."""
    if not y.kind.ordered and None in (
        y.exact_value(),
        x.exact_value(),
    ):  # not there, but smooth elsewhere
        return 2 * (y / (x + hypot(x, y))).apply("atan")
    # The quotient is at most 1 in size, so that nothing is divided by 0 on an axis, and no digits
    # are lost near it.
    if abs(x) >= abs(y):
        angle = (y / x).apply("atan")
        return angle if x > 0 else angle + (y.kind.pi() if y >= 0 else -y.kind.pi())
    quarter = y.kind.pi() / 2
    return (quarter if y > 0 else -quarter) - (x / y).apply("atan")


def _cbrt(x: Any) -> Any:
    return -((-x) ** _THIRD) if x.kind.ordered and x < 0 else x**_THIRD


def hypot(*x: Any) -> Any:
    """Return the root of the sum of the squares."""
    return _root(sum(coordinate * coordinate for coordinate in x))


_COMPOSED: dict[str, Callable[[Any], Any]] = {
    "arcsin": _arcsin,
    "arccos": lambda x: x.kind.pi() / 2 - _arcsin(x),
    "arccosh": lambda x: _log(x + _root(x - 1) * _root(x + 1)),
    "arctanh": lambda x: _log((1 + x) / (1 - x)) / 2,
    "cbrt": _cbrt,
    "degrees": lambda x: x / _degree(x),
    "radians": lambda x: x * _degree(x),
    "exp2": lambda x: 2**x,
    "expm1": lambda x: x.apply("exp") - 1,
    "log10": _log_of(10),
    "log1p": lambda x: _log(x + 1),
    "log2": _log_of(2),
    "sinc": _sinc,
    "sign": _sign,
}
OF_ONE = _COMPOSED | {f.numpy: methodcaller("apply", name) for name, f in by_name().items()}
# As `math` and new versions of numpy call them.
OF_ONE |= {name.replace("arc", "a"): call for name, call in OF_ONE.items()}
OF_ONE |= {"rad2deg": OF_ONE["degrees"], "deg2rad": OF_ONE["radians"]}
OF_TWO: dict[str, Callable[[Any, Any], Any]] = {
    "arctan2": lambda y, x: y.arctan2(x),
    "hypot": hypot,
    "copysign": lambda x, y: abs(x) * _sign(y, at_zero=1),
    "heaviside": lambda x, at_zero: (1 + _sign(x, at_zero=2 * at_zero - 1)) / 2,
    "logaddexp": lambda x, y: _log(x.apply("exp") + y.apply("exp")),
    "maximum": lambda x, y: x if x >= y else y,
    "minimum": lambda x, y: x if x <= y else y,
}
OF_TWO |= {"atan2": OF_TWO["arctan2"], "fmax": OF_TWO["maximum"], "fmin": OF_TWO["minimum"]}
OPERATORS: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "subtract": operator.sub,
    "multiply": operator.mul,
    "divide": operator.truediv,
    "true_divide": operator.truediv,
    "power": operator.pow,
    "float_power": operator.pow,
    "negative": operator.neg,
    "positive": operator.pos,
    "absolute": operator.abs,
    "fabs": operator.abs,
    "square": lambda x: x * x,
    "reciprocal": lambda x: 1 / x,
    "less": operator.lt,
    "less_equal": operator.le,
    "greater": operator.gt,
    "greater_equal": operator.ge,
    "equal": operator.eq,
    "not_equal": operator.ne,
    "isfinite": lambda x: x.isfinite(),
    "isnan": lambda x: not x.isfinite(),
    **OF_TWO,
}
