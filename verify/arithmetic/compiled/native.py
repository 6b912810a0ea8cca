"""LLVM modules → machine code of this machine's processor → functions of this process."""

import ctypes
import sys
import threading
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

import llvmlite
from llvmlite import binding as llvm

from verify.arithmetic.lanes.vectors import LANES

if TYPE_CHECKING:
    from llvmlite import ir

Native = Callable[[Any, Any], None]  # of the addresses of arguments and results
_LOCK = threading.Lock()  # LLVM is not set up for several threads
_ENGINES: list[llvm.ExecutionEngine] = []  # kept, since their code must not be freed
# The files are read at import: they are then those whose code this process runs, even if they
# change on disk later.
_COMPILER_FOLDERS = (
    "arithmetic/compiled",
    "arithmetic/lanes",
    "arithmetic/wide",
    "functions/elementary",
)
_COMPILER_FILES = [
    path
    for room in _COMPILER_FOLDERS
    for path in sorted(Path(__file__).parents[2].joinpath(room).glob("*.py"))
]
_COMPILER_HASH = sha256(b"\n".join(path.read_bytes() for path in _COMPILER_FILES))


@cache
def versions() -> str:
    """Return what machine code depends on besides its source: this package's compiler and lanes,
    Python, llvmlite, LLVM and the processor."""
    python = ".".join(map(str, sys.version_info[:3]))
    ours = f"Python {python}, {_COMPILER_HASH.hexdigest()}, {LANES} lanes"
    libraries = f"llvmlite {llvmlite.__version__}, LLVM {llvm.llvm_version_info}"
    return f"{ours}, {libraries}, {llvm.get_process_triple()}, {' '.join(_processor())}"


def machine_code(module: "ir.Module") -> bytes:
    """Return the module as an object file. Any thread may call it; one compiles at a time."""
    with _LOCK:
        target = _target()
        module.triple = target.triple
        parsed = llvm.parse_assembly(str(module))
        parsed.verify()
        _optimise(parsed, target)
        return bytes(target.emit_object(parsed))


def link(code: bytes, name: str = "main") -> Native:
    """Return the function of that name in an object file, which stays in memory until the process
    ends."""
    with _LOCK:
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target())
        # The object file has no references outside the C library; the engine resolves these in this
        # process.
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
        _ENGINES.append(engine)
        address = engine.get_function_address(name)
    return ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(address)


@cache
def _processor() -> tuple[str, str]:
    """Return the processor's name and its features."""
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def _target() -> llvm.TargetMachine:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    cpu, features = _processor()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    # Level 1 would compile in four fifths of the time, but lanes would run up to an eighth longer.
    return target.create_target_machine(cpu=cpu, features=features, opt=2)


def _optimise(module: llvm.ModuleRef, target: llvm.TargetMachine) -> None:
    """Optimise a module: registers for variables, and common subexpressions.

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
