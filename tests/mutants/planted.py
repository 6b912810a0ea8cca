"""A mutant in place of its module, from the next import on; no file is written or changed.

Two things could carry a mutant's work over to sound code, and neither does: no bytecode is written
for the module, as its tree is compiled at each import; and what `verify` keeps on disk has the
mutant's name in its fingerprint.
"""

import ast
import hashlib
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType

from tests.mutants.mutate import Mutant, mutants, mutated

_KEEPING = "verify.execution.keeper"


class _Changed(SourceFileLoader):
    """Loads a module from a tree; never from bytecode on disk, nor to there."""

    def __init__(self, name: str, path: str, tree: ast.Module) -> None:
        super().__init__(name, path)
        self._tree = tree

    def get_code(self, fullname: str) -> CodeType:
        return compile(self._tree, self.path, "exec", dont_inherit=True)


class _OwnFingerprint(SourceFileLoader):
    """Loads `verify.execution.keeper`, whose fingerprint is then a mutant's own."""

    def __init__(self, name: str, path: str, key: str) -> None:
        super().__init__(name, path)
        self._key = key

    def exec_module(self, module: ModuleType) -> None:
        super().exec_module(module)
        sound = module.fingerprint

        def fingerprint() -> str:
            return hashlib.sha256(f"{sound()} {self._key}".encode()).hexdigest()[:12]

        module.fingerprint = fingerprint  # type: ignore[attr-defined]


class _Finder:
    def __init__(self, mutant: Mutant) -> None:
        self.mutant = mutant

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name not in (self.mutant.module, _KEEPING):
            return None
        spec = PathFinder.find_spec(name, path, target)
        assert spec is not None
        assert spec.origin is not None
        if name == _KEEPING:
            spec.loader = _OwnFingerprint(name, spec.origin, self.mutant.key)
        else:
            tree = mutated(name, self.mutant.index)
            spec.loader = _Changed(name, spec.origin, tree)
        spec.cached = None
        return spec


def planted(module: str, index: int) -> Mutant:
    """Installs the mutant for the rest of this process, and gives it.

    Raises RuntimeError where a module of `verify` is imported already, as others would hold on to
    the sound one; LookupError where there is no such mutant.
    """
    early = [name for name in sys.modules if name.partition(".")[0] == "verify"]
    if early:
        raise RuntimeError(f"a mutant comes first, and {early[0]} is imported already")
    found = mutants(module)
    if not 0 <= index < len(found):
        raise LookupError(f"{module} has no mutant {index}")
    sys.meta_path.insert(0, _Finder(found[index]))
    return found[index]
