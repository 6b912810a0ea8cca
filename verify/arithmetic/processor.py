"""The features of this machine's processor, and how many 64-bit words one of its registers
holds."""

from functools import cache

from llvmlite import binding as llvm


@cache
def features() -> dict[str, bool]:
    """Return the processor's features by LLVM's names, and whether each is present."""
    return dict(llvm.get_host_cpu_features())


LANES = 8 if features().get("avx512f") else 4
