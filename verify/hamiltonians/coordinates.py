"""Names that are likely meant for a coordinate which H lacks: x for q, v for p."""

import re
from collections.abc import Collection

import sympy

from verify.errors import InputError

_LIKELY = {
    "p": re.compile(r"[vPy]|[pPv]_?([1-9xyzr]|theta|phi)|(mom|vel)\w*|[xq]_?dot"),
    "q": re.compile(r"[xyzQXYZ]|[xyzqQ]_?[1-9xyzr]|theta|phi|varphi|angle|pos\w*"),
}


def check_coordinates(formula: str, expression: sympy.Expr, parameters: Collection[str]) -> None:
    """InputError where H has no p or no q, and among its parameters is a name that stands for it.

    `parameters`: those without a value; whoever gives one its value says that it is one.
    """
    present = {s.name for s in expression.free_symbols}
    missing = [name for name in _LIKELY if name not in present]
    meant = [x for x in parameters if any(_LIKELY[name].fullmatch(x) for name in missing)]
    if meant:
        lacks, names = " and no ".join(missing), ", ".join(meant)
        raise InputError(
            "hamiltonian",
            formula,
            f"has no {lacks}, and {names} would be no coordinate; write {' and '.join(missing)}, in"
            " one degree of freedom, or give a parameter its value",
        )
