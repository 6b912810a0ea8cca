"""A user's own module, imported so that no file beside it is taken for a library that we import.

Much of what a command imports it imports late, numpy among it, and so do libraries. A user's folder
is therefore searched behind all libraries; the module that was named alone is taken from it first.
"""

import sys
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType


def from_file(path: Path) -> ModuleType:
    """The module that a .py file is, which is run anew."""
    name = _free_name(path.stem, path.parent.resolve())
    return _executed(spec_from_file_location(name, path))


def from_folder(name: str) -> ModuleType:
    """The module of that name in the current folder, else the one that is installed."""
    top, dot, rest = name.partition(".")
    here = Path.cwd()
    there = PathFinder.find_spec(top, [str(here)])
    free = _free_name(top, here)
    if there is None or there.origin is None:  # a folder without code is behind libraries, too
        return import_module(name)
    if free != top and free not in sys.modules:
        inside = there.submodule_search_locations
        _executed(spec_from_file_location(free, there.origin, submodule_search_locations=inside))
    return import_module(f"{free}{dot}{rest}")


def _free_name(name: str, folder: Path) -> str:
    """The name, or another one where that is a library's; the folder's other modules are found."""
    before = [x for x in sys.path if Path(x).resolve() != folder]
    taken = name in sys.stdlib_module_names or PathFinder.find_spec(name, before) is not None
    if str(folder) not in sys.path:
        sys.path.append(str(folder))
    return f"{name}_{hash(folder) & 0xFFFFFFFF:x}" if taken else name


def _executed(spec: ModuleSpec | None) -> ModuleType:
    assert spec is not None and spec.loader is not None  # noqa: PT018, S101 - a file has one
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # as pickles and dataclasses in it expect
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[spec.name]
        raise
    return module
