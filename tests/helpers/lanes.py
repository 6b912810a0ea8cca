"""Functions in lanes beside those of one orbit: the same source, the same arguments, all paths."""

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from typing import Any
from unittest import mock

import numpy as np

from verify.arithmetic.compiled import engine, paths
from verify.arithmetic.compiled.translation import Fixed, Source
from verify.arithmetic.lanes.vectors import LANES
from verify.arithmetic.systems import fixed
from verify.arithmetic.wide.size import INTEGER_BITS
from verify.kernels.kernel import kernel_for
from verify.studies.separation.mixed_kernel import mixed_kernel

NATIVE = [name for name, path in paths.PATHS.items() if path.required and path.is_available]
IN_LANES = [*NATIVE, "portable"]
PATHS = [*IN_LANES, paths.OFF]


@contextmanager
def path(name: str) -> Iterator[None]:
    """As though VERIFY_LANES said so; functions that are made meanwhile take that way."""
    with mock.patch.dict(os.environ, {paths.VARIABLE: name}):
        _forget()
        yield
        _forget()


def _forget() -> None:
    engine._cached_function.cache_clear()
    kernel_for.cache_clear()
    mixed_kernel.cache_clear()


class Both:
    """A function of one orbit and the same in lanes, of one width, which takes long to compile."""

    def __init__(self, text: str, width: int, way: str, names: Mapping[str, Any] | None = None):
        made = fixed.at_bits(width - INTEGER_BITS)
        known = tuple(sorted({**made.functions, **(names or {})}.items()))
        own = Source(text, made.bits, known)
        target = paths.PATHS[way].target
        self._source = Source(text, made.bits, known, f"lanes, {way}", target)
        self.one = engine.NativeFunction(own, anew=True)

    @cached_property
    def _lanes(self) -> tuple[Any, Any]:
        """Its layout, and the function."""
        layout, linked = self._source.compile(anew=True)
        return layout, linked()

    def of_one(self, arguments: Sequence[Any]) -> Any:
        """What the function of one orbit gives; None where it has no value."""
        try:
            return self.one(*arguments)
        except ValueError:
            return None

    def in_lanes(self, rows: Sequence[Sequence[Any]]) -> list[Any]:
        """The same of each of up to eight rows of arguments."""
        layout, function = self._lanes
        given = [layout.pack(row) for row in rows]
        given += [given[0]] * (LANES - len(rows))
        words = [np.frombuffer(row, dtype=np.uint64) for row in given]
        size = sum(layout.result_sizes) // 8 + 1
        found = engine._call(function, size, np.ascontiguousarray(np.stack(words, axis=1)))
        return [self._read(column.tobytes()) for column in found.T[: len(rows)]]

    def _read(self, raw: bytes) -> Any:
        try:
            return self._lanes[0].unpack(raw)
        except ValueError:
            return None


def same(x: Any, y: Any) -> bool:
    """Bit for bit; NaN is itself."""
    if isinstance(x, tuple) and isinstance(y, tuple):
        return len(x) == len(y) and all(map(same, x, y))
    return bool(x == y) or (x != x and y != y)


def number(raw: int, width: int) -> Fixed:
    return Fixed(raw, width - INTEGER_BITS)
