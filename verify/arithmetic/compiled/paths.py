"""By what way several orbits are stepped on this machine.

`VERIFY_LANES` forces one: `avx512` (its 52-bit multiply-add), `avx2` (the fused multiply-add of
float64), `portable` (the same code by products of 128 bits, slower than one orbit after the other,
for tests), or `off` (one after the other).
"""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from verify.errors import InputError

if TYPE_CHECKING:
    from verify.arithmetic.wide.translate import Target

VARIABLE, OFF = "VERIFY_LANES", "off"


@dataclass(frozen=True)
class Path:
    """A way: the class that multiplies by it, and what the processor must have."""

    name: str
    multiply_add: str
    needed: tuple[str, ...] = ()

    @property
    def target(self) -> "Callable[[int], Target]":
        """Writes code for numbers with so many fraction bits."""
        from verify.arithmetic.lanes import multiply_add
        from verify.arithmetic.lanes.ensemble import Ensemble

        own = getattr(multiply_add, self.multiply_add)
        return lambda fraction: Ensemble(fraction, own)

    @property
    def there(self) -> bool:
        """Whether this processor has what it needs."""
        from verify.arithmetic import processor

        return all(processor.features().get(name, False) for name in self.needed)


_FASTEST_FIRST = (
    Path("avx512", "Avx512", ("avx512f", "avx512dq", "avx512vl", "avx512ifma")),
    Path("avx2", "Fused", ("avx2", "fma")),
)
PATHS = {path.name: path for path in (*_FASTEST_FIRST, Path("portable", "Portable"))}


def forced() -> str:
    """The way that VERIFY_LANES asks for, or empty. Raises InputError where that is unknown."""
    asked = os.environ.get(VARIABLE, "")
    if asked and asked not in (*PATHS, OFF):
        raise InputError(VARIABLE, asked, f"allowed: {', '.join([*PATHS, OFF])}")
    return asked


def chosen() -> Path | None:
    """The way; None is one orbit after the other.

    Raises InputError where VERIFY_LANES asks for what is unknown, or not there.
    """
    asked = forced()
    if asked == OFF:
        return None
    if not asked:
        return next((path for path in _FASTEST_FIRST if path.there), None)
    if not PATHS[asked].there:
        raise InputError(VARIABLE, asked, "this processor has no such instructions")
    return PATHS[asked]
