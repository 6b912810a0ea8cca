"""By what way several orbits are stepped on this machine.

`VERIFY_LANES` forces one: `avx512` (its 52-bit multiply-add), `portable` (the same code without
that instruction, slower than one orbit after the other, for tests), or `off` (one after the other).
"""

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from verify.errors import InputError

if TYPE_CHECKING:
    from verify.arithmetic.wide.translate import Target

LANES = 8
VARIABLE, OFF = "VERIFY_LANES", "off"
_NATIVE, _PORTABLE = "avx512", "portable"
_NEEDED = ("avx512f", "avx512dq", "avx512vl", "avx512ifma")


@dataclass(frozen=True)
class Path:
    """A way; `target` writes code for numbers of a width and fraction."""

    name: str

    @property
    def target(self) -> "Callable[[int, int], Target]":
        from verify.arithmetic.lanes.ensemble import Ensemble

        native = self.name == _NATIVE
        return lambda width, fraction: Ensemble(width, fraction, native=native)


def chosen() -> Path | None:
    """The way; None is one orbit after the other.

    Raises InputError where VERIFY_LANES asks for what is unknown, or not there.
    """
    asked = os.environ.get(VARIABLE, "")
    if asked == OFF or (not asked and not _has_instructions()):
        return None
    if asked == _NATIVE and not _has_instructions():
        raise InputError(VARIABLE, asked, "this processor has no such instructions")
    if asked not in ("", _NATIVE, _PORTABLE):
        raise InputError(VARIABLE, asked, f"allowed: {_NATIVE}, {_PORTABLE}, {OFF}")
    return Path(asked or _NATIVE)


@cache
def _has_instructions() -> bool:
    from llvmlite import binding as llvm

    features = llvm.get_host_cpu_features()
    return all(features.get(name, False) for name in _NEEDED)
