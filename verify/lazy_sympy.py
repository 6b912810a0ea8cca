"""sympy, imported at the first use of one of its names.

Its import takes as long as all the rest of a short command, and a Hamiltonian from the cache needs
none of it (`verify.hamiltonians.hamiltonian_store`). A module on the way of a run writes
`from verify.lazy_sympy import sympy`, and uses no name of it while it is itself imported.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING, Any


class _LateModule(ModuleType):
    """A module that is imported when an attribute of it is first read."""

    def __getattr__(self, name: str) -> Any:
        value = getattr(importlib.import_module(self.__name__), name)
        setattr(self, name, value)  # the next look comes no further than this
        return value


if TYPE_CHECKING:
    import sympy as sympy
else:
    sympy = _LateModule("sympy")
