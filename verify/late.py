"""sympy, imported when it is first asked for something.

Its import takes as long as all else that a short command does, and what was read of a Hamiltonian
before needs none of it (`verify.hamiltonians.kept`). A module on the way of a run writes
`from verify.late import sympy`, and asks for nothing of it as it is imported.
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING, Any


class _Late(ModuleType):
    """A module that is imported by the first look at it."""

    def __getattr__(self, name: str) -> Any:
        found = getattr(importlib.import_module(self.__name__), name)
        setattr(self, name, found)  # the next look comes no further than this
        return found


if TYPE_CHECKING:
    import sympy as sympy
else:
    sympy = _Late("sympy")
