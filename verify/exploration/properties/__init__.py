"""Properties that hold for every scene, which `verify explore` checks; one file each.

The first line of a file's docstring is the property's sentence, which is shown to users.
`holds(sample)` checks one sample, in the plane or in n degrees of freedom; it raises Violation if
the property fails, and Silent if it does not apply (see `verify.exploration.property`). To add a
property, add one file.
"""

import ast
from collections.abc import Callable, Mapping
from functools import cache
from inspect import getsource

from verify.discovery import Catalogue
from verify.errors import unknown_name
from verify.exploration.property import Property
from verify.exploration.sample import Sample

_FILES = Catalogue(__name__, __path__)
# The samples to which the properties in a folder apply; those in other folders apply to all.
_APPLIES_IN_FOLDER: Mapping[str, Callable[[Sample], bool]] = {
    "plane": lambda sample: sample.hamiltonian.planar,
    "several": lambda sample: not sample.hamiltonian.planar,
    "time": lambda sample: sample.depends_on_time,
}


def names() -> tuple[str, ...]:
    """Return the names of all properties."""
    return _FILES.names


@cache
def get(name: str) -> Property:
    """Return the property of that name; InputError if there is none.

    >>> print(get("symmetric-schemes").sentence)
    The step of −h undoes the step of h, for a scheme that claims to be symmetric.
    """
    if name not in _FILES:
        raise unknown_name("property", name, names())
    module = _FILES.module(name)
    text = ast.get_docstring(ast.parse(getsource(module)))  # python -OO keeps no __doc__
    sentence = (text or "").splitlines()[0]
    speaks_of = _APPLIES_IN_FOLDER.get(_FILES.folder(name), lambda _: True)
    return Property(name, sentence, module.holds, speaks_of=speaks_of)
