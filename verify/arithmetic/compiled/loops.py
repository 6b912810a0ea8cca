"""Plain Python functions over numbers and arrays, compiled by LLVM, with the bits of Python.

`verify.arithmetic.compiled.loop_writer` describes the language of these functions.
"""

import ctypes
from collections.abc import Callable
from functools import cache
from struct import Struct
from typing import Any

import numpy as np

from verify import code_cache
from verify.arithmetic.compiled import native
from verify.arithmetic.compiled.loop_writer import LoopWriter

_STRUCT_LETTERS = {"int": "q", "float": "d"}


def compile_function(function: Callable[..., Any]) -> Callable[..., tuple[Any, ...]]:
    """Return the function as native code, which returns a tuple.

    It is compiled at its first call with arguments of the same kinds. Arguments are numbers and
    contiguous arrays.
    """

    @cache
    def compile_for(kinds: tuple[str, ...]) -> tuple[Struct, native.Native]:
        writer = LoopWriter()
        results = writer.write(function, kinds)
        key = code_cache.key_of(native.versions(), str(writer.module))
        code = code_cache.load(key)
        if code is None:
            code = native.machine_code(writer.module)
            code_cache.keep(key, code)
        return Struct("=" + "".join(map(_STRUCT_LETTERS.__getitem__, results))), native.link(code)

    def call(*arguments: Any) -> tuple[Any, ...]:
        results, linked = compile_for(tuple(map(_kind, arguments)))
        buffer = ctypes.create_string_buffer(results.size)
        linked(b"".join(map(_words, arguments)), buffer)
        return results.unpack(buffer.raw)

    return call


def _kind(x: Any) -> str:
    """Return `float` or `int`; for an array that of its elements, with the number of columns."""
    if not isinstance(x, np.ndarray):
        return "float" if isinstance(x, float) else "int"
    assert x.flags.c_contiguous  # noqa: S101 - the compiled code has its address alone
    return f"{_kind(x.dtype.type(0).item())} {x.shape[1] if x.ndim > 1 else 0}"


def _words(x: Any) -> bytes:
    """Return the bytes of a number; for an array those of its address and length."""
    if isinstance(x, np.ndarray):
        return Struct("=qq").pack(x.ctypes.data, len(x))
    return Struct("=" + _STRUCT_LETTERS[_kind(x)]).pack(x)
