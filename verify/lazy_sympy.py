"""sympy, imported at the first use of one of its names.

The import of sympy takes as long as all the rest of a short command, and a Hamiltonian from the
cache needs no sympy (`verify.hamiltonians.hamiltonian_store`). A module that a run imports writes
`from verify.lazy_sympy import sympy`, and uses names of sympy only inside its functions.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING, Any


class _LateModule(ModuleType):
    """A module that is imported when an attribute of it is first read."""

    def __getattr__(self, name: str) -> Any:
        value = getattr(importlib.import_module(self.__name__), name)
        setattr(self, name, value)  # the next access finds it here
        return value


if TYPE_CHECKING:
    import sympy as sympy
else:
    sympy = _LateModule("sympy")
