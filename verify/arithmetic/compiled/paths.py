"""The code path by which several orbits are stepped on this machine.

The environment variable `VERIFY_LANES` forces one:

- `avx512`: by the 52-bit multiply-add of AVX-512;
- `avx2`: by the fused multiply-add of float64;
- `portable`: the same code with products of 128 bits, for tests; it is slower than `off`;
- `off`: one orbit after the other.
"""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from verify.errors import InputError

if TYPE_CHECKING:
    from verify.arithmetic.wide.translator import Target

VARIABLE, OFF = "VERIFY_LANES", "off"


@dataclass(frozen=True)
class Path:
    """A code path: the class that multiplies, and the features that the processor must have."""

    name: str
    multiply_add: str  # a class of `verify.arithmetic.lanes.multiply_add`
    required: tuple[str, ...] = ()

    @property
    def target(self) -> "Callable[[int], Target]":
        """The function from a number of fraction bits to the writer of code for that format."""
        from verify.arithmetic.lanes import multiply_add
        from verify.arithmetic.lanes.ensemble import Ensemble

        kind = getattr(multiply_add, self.multiply_add)
        return lambda fraction: Ensemble(fraction, kind)

    @property
    def is_available(self) -> bool:
        """True if this processor has the required features."""
        from verify.arithmetic.lanes import vectors

        return all(vectors.features().get(name, False) for name in self.required)


_FASTEST_FIRST = (
    Path("avx512", "Avx512", ("avx512f", "avx512dq", "avx512vl", "avx512ifma")),
    Path("avx2", "Fused", ("avx2", "fma")),
)
PATHS = {path.name: path for path in (*_FASTEST_FIRST, Path("portable", "Portable"))}


def forced_path() -> str:
    """Return the path that VERIFY_LANES names; empty if it is not set.

    Raises InputError if it is unknown.
    """
    name = os.environ.get(VARIABLE, "")
    if name and name not in (*PATHS, OFF):
        raise InputError(VARIABLE, name, f"allowed: {', '.join([*PATHS, OFF])}")
    return name


def choose_path() -> Path | None:
    """Choose the path; None means one orbit after the other.

    Raises InputError if VERIFY_LANES names a path that is unknown, or not available.
    """
    name = forced_path()
    if name == OFF:
        return None
    if not name:
        return next((path for path in _FASTEST_FIRST if path.is_available), None)
    # A forced path that the processor lacks would end the process with an illegal instruction.
    if not PATHS[name].is_available:
        raise InputError(VARIABLE, name, "this processor has no such instructions")
    return PATHS[name]
