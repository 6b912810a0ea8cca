"""What holds of every scene: the properties that `verify explore` looks at, one file each.

A file's first line of text is the property's sentence; `holds(example)` looks at one example (see
`verify.property`). Adding a property is adding one file.
"""

import pkgutil
from functools import cache
from importlib import import_module

from verify.errors import InputError
from verify.property import Property


@cache
def _all() -> dict[str, Property]:
    found = {}
    for module in sorted(m.name for m in pkgutil.iter_modules(__path__)):
        imported = import_module(f"{__name__}.{module}")
        sentence = (imported.__doc__ or "").strip().splitlines()[0]
        name = module.replace("_", "-")
        found[name] = Property(name, sentence, imported.holds)
    return found


def names() -> tuple[str, ...]:
    """The names of all properties."""
    return tuple(_all())


def get(name: str) -> Property:
    """The property of that name; InputError where there is none."""
    if name not in _all():
        raise InputError("property", name, f"unknown; allowed: {', '.join(_all())}")
    return _all()[name]
