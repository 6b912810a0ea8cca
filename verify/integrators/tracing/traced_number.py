"""Our number classes, with which a user's code is called in place of floats.

Arithmetic, numpy's functions of scalars and of object arrays, and the functions that
`verify.integrators.tracing.function_copy` puts in place of those of `math` call their methods. A
float in the code is read as the number that is meant, if it is the nearest float of one simple
rational: 0.1 as 1/10, and 0.16666666666666666 as 1/6. Any other float, such as 1.3512071919596578,
stands for its exact binary value, and counts as a rounded coefficient.
"""

import math
import operator
from abc import ABC, abstractmethod
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NoReturn

from verify.integrators.tracing.named_functions import OF_ONE, OF_TWO, OPERATORS, arctan2
from verify.integrators.tracing.purity import Surroundings

if TYPE_CHECKING:
    import numpy

_MAX_DENOMINATOR = 10_000  # of a simple rational; the chance that a float is read as one is 10⁻⁸
_EXACT_INTEGERS, _EXACT_DIGITS = 2**53, 15  # a double has all such integers, and all such decimals
_MAX_SIMPLE = 100  # the size of a float that is read as a simple rational
_MAX_READ_DIGITS = 12  # significant digits of a decimal as which a float is read


class UntraceableError(TypeError):
    """The user's code requests an operation that our numbers do not have, as the message tells."""


def read_float(value: float) -> Fraction | None:
    """Return the simple rational or short decimal whose nearest float this is; None if none is."""
    simple = Fraction(value).limit_denominator(_MAX_DENOMINATOR)
    # Among large numbers such a rational is near any float.
    if simple and abs(value) < _MAX_SIMPLE and float(simple) == value:
        return simple
    return Fraction(repr(float(value))) if _count_digits(float(value)) <= _MAX_READ_DIGITS else None


class Kind(ABC):
    """A factory of numbers of one class, with a record of the floats that it has read.

    `readings`: floats that were read as another number than their value; `rounded`: those taken by
    their binary value that are no integers; `refused`: impossible operations that were requested,
    since the code may catch their error; `surroundings`: the objects that the code has reached
    beside its arguments.
    """

    ordered = True  # False if its numbers cannot be compared

    def __init__(self) -> None:
        self.readings: dict[float, Fraction] = {}
        self.rounded: set[float] = set()
        self.refused: list[str] = []
        self.surroundings = Surroundings()

    @abstractmethod
    def rational(self, value: Fraction) -> "TracedNumber": ...

    @abstractmethod
    def pi(self) -> "TracedNumber": ...


def constant(kind: Kind, value: Any) -> "TracedNumber | None":
    """Return a user's number as one of ours; None if it is no number. Raises UntraceableError for
    complex and non-finite numbers."""
    if hasattr(value, "dtype") and getattr(value, "ndim", 1) == 0:
        value = value.item()  # one of numpy's scalars
    if isinstance(value, TracedNumber):
        return value
    if isinstance(value, int | Fraction | Decimal):
        return kind.rational(Fraction(value))
    if isinstance(value, complex):
        raise UntraceableError("it computes with complex numbers")
    if not isinstance(value, float):
        return None
    if value - value != 0:
        raise UntraceableError("it computes with infinity or NaN")
    binary_value = Fraction(value)
    # First an exact number, as 0.5; then a short rational or decimal that rounds to this float, as
    # 0.1; otherwise the binary value, which counts as rounded.
    read = binary_value if _is_written(value, binary_value) else read_float(value)
    if read is None:
        kind.rounded.add(value)
        return kind.rational(binary_value)
    if read != binary_value:
        kind.readings[value] = read
    return kind.rational(read)


def _is_written(value: float, binary_value: Fraction) -> bool:
    """Return True if a float is likely to be the number that was written, and no rounded product.

    From 10¹² on a double has few bits after its point, whatever it comes from: 75674920197265.2, a
    product, is …265.203125.
    """
    plain = binary_value.denominator <= _MAX_DENOMINATOR and abs(binary_value) < _EXACT_INTEGERS
    return plain and _count_digits(value) <= _EXACT_DIGITS and Fraction(repr(value)) == binary_value


def _count_digits(value: float) -> int:
    return len(Decimal(repr(value)).as_tuple().digits)


def _operator(
    name: str, *, swapped: bool = False
) -> Callable[["TracedNumber", object], "TracedNumber"]:
    """Return the method of `TracedNumber` that is an operator, or, `swapped`, its other side's."""

    def apply_operator(self: "TracedNumber", other: object) -> "TracedNumber":
        lifted = constant(self.kind, other)
        if lifted is None:
            unknown: TracedNumber = NotImplemented  # Python then asks the other one
            return unknown
        return lifted.combine(name, self) if swapped else self.combine(name, lifted)

    return apply_operator


def _comparison(holds: Callable[[int, int], bool]) -> Callable[["TracedNumber", object], bool]:
    return lambda self, other: holds(self._order(other), 0)


class TracedNumber(ABC):
    """A number of one `kind`; subclasses say what an operation on it is."""

    __slots__ = ("kind",)
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, kind: Kind) -> None:
        self.kind = kind

    # -- what a subclass says -----------------------------------------------------------------

    @abstractmethod
    def combine(self, name: str, other: Any) -> "TracedNumber":  # Any: of the subclass itself
        """Return self + other for "add", and so for "subtract", "multiply", "divide"; other is of
        the same kind."""

    @abstractmethod
    def apply(self, name: str) -> "TracedNumber":
        """Return the function of `verify.functions` of that name at this number."""

    @abstractmethod
    def raise_to(self, exponent: Fraction) -> "TracedNumber": ...

    @abstractmethod
    def exact_value(self) -> Fraction | None:
        """Return its value, where it is a rational number that does not depend on p, q and h."""

    def arctan2(self, other: Any) -> "TracedNumber":
        """Return the angle of the point (other, self), of whose coordinates one may be a plain
        number."""
        lifted = constant(self.kind, other)
        if lifted is None:
            self.refuse("it takes the angle of what is no number")
        angle: TracedNumber = arctan2(self, lifted)
        return angle

    def compare(self, other: Any) -> int:
        """Return −1, 0 or 1."""
        self.refuse("it compares numbers")

    def refuse(self, problem: str) -> NoReturn:
        self.kind.refused.append(problem)
        raise UntraceableError(problem)

    # -- arithmetic ---------------------------------------------------------------------------

    __add__, __radd__ = _operator("add"), _operator("add", swapped=True)
    __sub__, __rsub__ = _operator("subtract"), _operator("subtract", swapped=True)
    __mul__, __rmul__ = _operator("multiply"), _operator("multiply", swapped=True)
    __truediv__, __rtruediv__ = _operator("divide"), _operator("divide", swapped=True)

    def __neg__(self) -> "TracedNumber":
        return self * -1

    def __pos__(self) -> "TracedNumber":
        return self

    def __pow__(self, other: object, modulus: object = None) -> "TracedNumber":
        exponent = constant(self.kind, other)
        if exponent is None or modulus is not None:
            return NotImplemented
        value = exponent.exact_value()
        if value is not None:
            return self.raise_to(value)
        return (exponent * self.apply("log")).apply("exp")

    def __rpow__(self, other: object) -> "TracedNumber":
        base = constant(self.kind, other)
        return NotImplemented if base is None else base**self

    def conjugate(self) -> "TracedNumber":
        return self

    @property
    def real(self) -> "TracedNumber":
        return self

    # -- comparisons and other types ----------------------------------------------------------

    def _order(self, other: object) -> int:
        lifted = constant(self.kind, other)
        if lifted is None:
            self.refuse("it compares a number with what is none")
        value, other_value = self.exact_value(), lifted.exact_value()
        if value is not None and other_value is not None:
            return (value > other_value) - (value < other_value)
        return self.compare(lifted)

    __lt__, __le__ = _comparison(operator.lt), _comparison(operator.le)
    __gt__, __ge__ = _comparison(operator.gt), _comparison(operator.ge)

    def __eq__(self, other: object) -> bool:
        return other is not None and self._order(other) == 0

    def __ne__(self, other: object) -> bool:
        return other is None or self._order(other) != 0

    def __bool__(self) -> bool:
        return self._order(0) != 0

    def __abs__(self) -> "TracedNumber":
        return -self if self._order(0) < 0 else self

    def _number(self, problem: str = "it turns numbers into floats or integers") -> Fraction:
        value = self.exact_value()
        if value is None:
            self.refuse(problem)
        return value

    def __round__(self, digits: int | None = None) -> int | Fraction:
        return round(self._number("it rounds numbers"), digits)

    def __floor__(self) -> int:
        return math.floor(self._number("it rounds numbers"))

    def __ceil__(self) -> int:
        return math.ceil(self._number("it rounds numbers"))

    def __trunc__(self) -> int:
        return int(self._number("it rounds numbers"))

    def _remainder(self, *_: object) -> NoReturn:
        self.refuse("it takes remainders")

    __mod__ = __rmod__ = __floordiv__ = __rfloordiv__ = __divmod__ = __rdivmod__ = _remainder

    def __float__(self) -> float:
        return float(self._number())

    def __int__(self) -> int:
        return int(self._number())

    def __complex__(self) -> complex:
        self.refuse("it computes with complex numbers")

    def isfinite(self) -> bool:
        self._order(0)
        return True

    # -- numpy --------------------------------------------------------------------------------

    def __getattr__(self, name: str) -> "Callable[..., TracedNumber]":
        """Return `sin`, `arctan`, …: the methods that numpy calls of the objects in an array."""
        if name in OF_ONE:
            return lambda: OF_ONE[name](self)
        if name in OF_TWO:
            return lambda other: OPERATORS[name](self, constant(self.kind, other))
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        import numpy as np

        if method != "__call__" or any(value is not None for value in options.values()):
            self.refuse(f"it writes into arrays of floats by numpy's {ufunc.__name__}")
        if any(isinstance(x, np.ndarray) and x.ndim for x in inputs):
            return ufunc(*map(_objects, inputs))
        lifted = [constant(self.kind, x) for x in inputs]
        if None in [x if x is None else 0 for x in lifted]:
            self.refuse(f"it gives numpy's {ufunc.__name__} what is no number")
        if ufunc.__name__ in OF_ONE:
            return OF_ONE[ufunc.__name__](*lifted)
        if ufunc.__name__ in OPERATORS:
            return OPERATORS[ufunc.__name__](*lifted)
        self.refuse(f"it calls numpy's {ufunc.__name__}")


def _objects(x: object) -> "numpy.ndarray":
    import numpy as np

    if isinstance(x, np.ndarray):
        return x.astype(object)
    alone = np.empty((), dtype=object)
    alone[()] = x
    return alone
