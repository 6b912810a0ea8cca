"""A splitting with a wrong clock, for comparison: `forest-ruth, clock frozen`.

Without time it is the same splitting. For an H that depends on time it reads

- `frozen`: every part at the step's start;
- `at the end`: every part at the step's end;
- `exchanged`: each part at the sum of the parts of its own kind before it, and not of the other's.

It claims the order that the splitting has with its right clocks, and is refuted.
"""

import re
from collections.abc import Callable, Mapping, Sequence

import sympy

from verify.errors import InputError
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting, sums_before
from verify.schemes.splitting_conditions import Part, Splitting

EXAMPLES = ()  # its names are the users' own
_NAME = re.compile(r"\s*(?P<base>[^,;]+?)\s*,\s*clock\s+(?P<clock>.*\S)\s*")


def make(name: str) -> Scheme | None:
    """The scheme for a text `NAME, clock HOW`; InputError for what is no splitting, or no HOW."""
    from verify.schemes import get

    found = _NAME.fullmatch(name)
    if found is None:
        return None
    base, how = get(found["base"]), " ".join(found["clock"].split())
    if not isinstance(base.every_h, Splitting):
        raise InputError(
            "scheme", name, f"{base.name} is no splitting; only those have such clocks"
        )
    if how not in _CLOCKS:
        raise InputError("scheme", name, f"clock {how}: unknown; allowed: {', '.join(_CLOCKS)}")
    parts = base.every_h.parts
    return splitting(
        f"{base.name}, clock {how}",
        parts,
        order=base.order,
        symmetric=False,
        source=f"{base.source}; with a wrong clock",
        times=_CLOCKS[how](parts),
    )


_CLOCKS: Mapping[str, Callable[[Sequence[Part]], tuple[sympy.Expr, ...]]] = {
    "frozen": lambda parts: (sympy.S.Zero,) * len(parts),
    "at the end": lambda parts: (sympy.S.One,) * len(parts),
    "exchanged": lambda parts: sums_before(parts, own=True),
}
