"""LLVM modules → native functions on this machine's processor."""

import ctypes
import threading
from collections.abc import Callable, Mapping
from functools import cache, lru_cache
from operator import itemgetter
from typing import Any

from llvmlite import binding as llvm
from llvmlite import ir

from verify.arithmetic.wide.translate import Translator

_LOCK = threading.Lock()  # LLVM's set-up is not made for threads
_ENGINES: list[llvm.ExecutionEngine] = []  # what runs must not be freed


class Fixed:
    """raw / 2^fraction, a number that kernels take and give."""

    __slots__ = ("fraction", "raw")

    def __init__(self, raw: int, fraction: int) -> None:
        self.raw, self.fraction = raw, fraction

    def __repr__(self) -> str:
        return f"Fixed({self.raw}, {self.fraction})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fixed) and (self.raw, self.fraction) == (other.raw, other.fraction)

    def __hash__(self) -> int:
        return hash((self.raw, self.fraction))

    def __neg__(self) -> "Fixed":
        return Fixed(-self.raw, self.fraction)

    def __lt__(self, other: "Fixed") -> bool:
        return self.raw < other.raw

    def __gt__(self, other: "Fixed") -> bool:
        return self.raw > other.raw


Word = Fixed | float | int  # by the kind of an argument, or of a result


def compiled(
    source: str, width: int, fraction: int, names: Mapping[str, Any]
) -> Callable[..., object]:
    """The function that the source defines (see `verify.arithmetic.wide.translate`).

    It is compiled once, when it is first called, since not every kernel that is made is run. It
    takes and gives `Fixed`, int and float. Raises OverflowError where an argument is outside the
    format, and ValueError where a function had no value outside a loop.
    """
    return _compiled(source, width, fraction, tuple(sorted(names.items(), key=itemgetter(0))))


@lru_cache(maxsize=256)
def _compiled(
    source: str, width: int, fraction: int, names: tuple[tuple[str, Any], ...]
) -> Callable[..., object]:
    translator = Translator(source, width, fraction, dict(names))
    module = translator.translate()
    native = cache(lambda: _native(module))
    sizes = {"wide": width // 64, "sum": width // 64 + 1, "float": 1, "int": 1}
    kinds = [kind for _, kind in translator.arguments]
    room = 8 * (sum(sizes[kind] for kind in translator.results) + 1)

    def call(*arguments: Word) -> object:
        given = b"".join(map(_packed, arguments, kinds, (sizes[k] for k in kinds)))
        result = ctypes.create_string_buffer(room)
        native()(given, result)
        values, at = [], 0
        for kind in translator.results:
            words = result.raw[at : at + 8 * sizes[kind]]
            values.append(_unpacked(words, kind, fraction))
            at += 8 * sizes[kind]
        if not result.raw[at]:
            raise ValueError("a function has no value there")
        return tuple(values) if translator.returns_tuple else values[0]

    return call


def _packed(value: Any, kind: str, size: int) -> bytes:
    if kind == "float":
        return bytes(ctypes.c_double(value))
    raw = value if kind == "int" else value.raw
    return int(raw).to_bytes(8 * size, "little", signed=True)  # OverflowError beyond the format


def _unpacked(words: bytes, kind: str, fraction: int) -> Word:
    if kind == "float":
        return ctypes.c_double.from_buffer_copy(words).value
    number = int.from_bytes(words, "little", signed=True)
    return number if kind == "int" else Fixed(number, fraction)


def _native(module: ir.Module) -> Callable[[bytes, ctypes.Array[ctypes.c_char]], None]:
    with _LOCK:
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        module.triple = llvm.get_process_triple()
        parsed = llvm.parse_assembly(str(module))
        parsed.verify()
        target = llvm.Target.from_triple(module.triple).create_target_machine(
            cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), opt=2
        )
        _optimise(parsed, target)
        engine = llvm.create_mcjit_compiler(parsed, target)
        engine.finalize_object()
        _ENGINES.append(engine)
        address = engine.get_function_address("main")
    return ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_char_p)(address)


def _optimise(module: llvm.ModuleRef, target: llvm.TargetMachine) -> None:
    """Registers for variables, and common subexpressions.

    The rest of LLVM's pipeline makes these kernels no faster, and takes ten times as long.
    """
    passes = llvm.create_new_module_pass_manager()
    passes.add_sroa_pass()
    passes.add_simplify_cfg_pass()
    passes.add_new_gvn_pass()
    passes.add_dead_code_elimination_pass()
    passes.add_simplify_cfg_pass()
    builder = llvm.create_pass_builder(target, llvm.create_pipeline_tuning_options())
    passes.run(module, builder)
