"""Functions compiled by numba, with machine code that an earlier process has compiled.

numba's own cache wants a file for every function and trusts what lies beside it. Here its results
go where all compiled code goes, `verify.code_cache`, which says what is trusted.
"""

import os
import pickle
import sys
from collections.abc import Callable
from typing import Any, cast

from verify import code_cache

_SETTINGS = "NUMBA_"  # numba's own variables, some of which change what it compiles


def compiled(function: Callable[..., Any], *source: str) -> Callable[..., Any]:
    """The function, compiled at its first call for the types it is then given. No fast-math.

    `source` is all that its code depends on: its text, that of what it calls, and the values of
    the names in it.
    """
    import numba

    made: Any = numba.njit(nogil=True, error_model="numpy", fastmath=False)(function)
    # What enable_caching() of numba would set; it has no public way to another store.
    made._cache = _store(source)
    return cast(Callable[..., Any], made)


def _versions(target: Any) -> str:
    import llvmlite
    import numba
    import numpy

    python = ".".join(map(str, sys.version_info[:3]))
    libraries = f"numba {numba.__version__}, llvmlite {llvmlite.__version__}"
    settings = sorted(x for x in os.environ.items() if x[0].startswith(_SETTINGS))
    return (
        f"Python {python}, {libraries}, numpy {numpy.__version__}, {settings}, {_processor(target)}"
    )


def _processor(target: Any) -> str:
    """The triple, the processor's name and its features, as numba compiles for them."""
    return repr(target.codegen().magic_tuple())


def _store(source: tuple[str, ...]) -> Any:
    """What numba asks before it compiles one function, and tells afterwards."""
    from numba.core.caching import NullCache
    from numba.core.compiler import CompileResult
    from numba.core.runtime.nrt import rtsys
    from numba.core.serialize import dumps

    dumped: Any = dumps  # numba has types here and there

    class Store(NullCache):
        def load_overload(self, sig: Any, target_context: Any) -> Any:
            kept = code_cache.load(self.key(sig, target_context))
            if kept is None:
                return None
            # Functions in C that machine code may call. numba's own cache refreshes the whole
            # context, which imports all that can be compiled, and takes as long as a kernel.
            rtsys.initialize(target_context)
            rebuild: Any = CompileResult._rebuild
            parts = pickle.loads(kept)  # noqa: S301 - nobody but this user has written it
            return rebuild(target_context, *parts)

        def save_overload(self, sig: Any, data: Any) -> None:
            # Addresses in this process are of no use in another one.
            if not data.library.has_dynamic_globals and not data.lifted:
                code_cache.keep(self.key(sig, data.target_context), dumped(data._reduce()))

        def key(self, sig: Any, target: Any) -> str:
            return code_cache.key_of("numba", _versions(target), str(sig), *source)

    return Store()
