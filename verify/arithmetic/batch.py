"""Many numbers in the place of one, so that a formula written for one number serves them all.

A comparison of a batch that does not come out the same for all of it cannot decide a branch: then
`MixedError` tells by a mask where it holds, and who evaluates the formula splits the batch there.
"""

import operator
from collections.abc import Callable
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import gmpy2

if TYPE_CHECKING:
    import numpy

Array: TypeAlias = "numpy.ndarray"  # which is imported where it is used
Operand: TypeAlias = Any  # a number or a truth value of any kind, an array, or a Batch
_BITS = 120  # more than two float64 hold


class MixedError(Exception):
    """A branch that some of a batch take and others do not."""

    def __init__(self, mask: Array) -> None:
        super().__init__()
        self.mask = mask


class DoubtfulError(MixedError):
    """What float64 cannot decide for some of a batch, which are to be evaluated one by one."""


class Batch:
    """An array of floats, of truth values, or of exact rationals (gmpy2.mpq), elementwise."""

    __array_ufunc__ = None  # an array with a batch is a batch

    def __init__(self, values: Array) -> None:
        self.values = values

    def __bool__(self) -> bool:
        mask = self.values.astype(bool)
        if mask.all():
            return True
        if mask.any():
            raise MixedError(mask)
        return False

    def __abs__(self) -> "Batch":
        return Batch(abs(self.values))

    def __neg__(self) -> "Batch":
        return Batch(-self.values)

    def __eq__(self, other: object) -> "Batch":  # type: ignore[override]
        return Batch(self.values == _bare(other))

    def __ne__(self, other: object) -> "Batch":  # type: ignore[override]
        return Batch(self.values != _bare(other))

    __hash__ = object.__hash__

    @cached_property
    def parts(self) -> tuple[Array, Array]:
        """Exact rationals as sums of two float64 each, the first of them the nearest."""
        import numpy as np

        with gmpy2.context(precision=_BITS):
            wide = [gmpy2.mpfr(x) for x in self.values]
            high = [float(x) for x in wide]
            low = [float(x - y) for x, y in zip(wide, high, strict=True)]
        return np.array(high), np.array(low)


def _binary(name: str) -> None:
    apply = getattr(operator, name)

    def forwards(self: Batch, other: Operand) -> Batch:
        return Batch(apply(self.values, _bare(other)))

    def backwards(self: Batch, other: Operand) -> Batch:
        return Batch(apply(_bare(other), self.values))

    plain = name.strip("_")
    setattr(Batch, f"__{plain}__", forwards)
    if plain not in ("lt", "le", "gt", "ge"):
        setattr(Batch, f"__r{plain}__", backwards)


for _name in ("add", "sub", "mul", "truediv", "pow", "lt", "le", "gt", "ge"):
    _binary(_name)


def _bare(x: Operand) -> Operand:
    if isinstance(x, Batch):
        return x.values
    return gmpy2.mpq(x) if isinstance(x, Fraction) else x


def exact(values: Array) -> Batch:
    """An array of float64 as the exact rationals that they are."""
    import numpy as np

    found = np.empty(len(values), object)
    found[:] = [gmpy2.mpq(*x.as_integer_ratio()) for x in values.tolist()]
    return Batch(found)


def choose(condition: Operand, then: Operand, otherwise: Operand) -> Operand:
    """`then` where the condition holds, for one number or for each of a batch."""
    if not isinstance(condition, Batch):
        return then if condition else otherwise
    import numpy as np

    x: Array = _bare(then)
    y: Array = _bare(otherwise)
    return Batch(np.where(condition.values, x, y))


def some(condition: Operand) -> bool:
    """Whether it holds for the number, or for any of a batch."""
    return bool(condition.values.any() if isinstance(condition, Batch) else condition)


def in_groups(size: int, evaluate: Callable[[Array], None], alone: Callable[[Array], None]) -> None:
    """Evaluate the indices 0 … size − 1 in groups of which each takes one way through.

    `evaluate` raises MixedError with a mask over its group; `alone` gets those who cannot be
    decided in a group, or whose evaluation fails (ArithmeticError, ValueError).
    """
    import numpy as np

    waiting = [np.arange(size)] if size else []
    while waiting:
        group = waiting.pop()
        try:
            evaluate(group)
        except DoubtfulError as doubt:
            alone(group[doubt.mask])
            waiting += [rest] if len(rest := group[~doubt.mask]) else []
        except MixedError as mixed:
            waiting += [group[mixed.mask], group[~mixed.mask]]
        except (ArithmeticError, ValueError):
            alone(group)
