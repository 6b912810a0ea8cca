"""Names likely meant for something else where H lacks a coordinate: x for q, pq for p*q."""

import re
from collections.abc import Collection

import sympy

from verify.algebra.monomials import names_in
from verify.errors import InputError

_LIKELY = {
    "p": re.compile(r"[vPy]|[pPv]_?([1-9xyzr]|theta|phi)|(mom|vel)\w*|[xpq]_?dot|dp|dx"),
    "q": re.compile(r"[xyzQXYZ]|[xyzqQ]_?[1-9xyzr]|theta|phi|varphi|angle|pos\w*|dq"),
}
_PRODUCT = re.compile(r"[pq]{2,}")
_CALL = re.compile(r"(sinh?|cosh?|tanh?|exp|log|ln|sqrt|atan)_?([pq])")


def check_coordinates(formula: str, expression: sympy.Expr, parameters: Collection[str]) -> None:
    """InputError where H has no p or no q, and among its parameters is a name that stands for it.

    `parameters`: those without a value; whoever gives one its value says that it is one.
    """
    present = names_in(expression)
    missing = [name for name in _LIKELY if name not in present]
    if missing:
        _check_words(formula, " and no ".join(missing), parameters)
    meant = [x for x in parameters if any(_LIKELY[name].fullmatch(x) for name in missing)]
    if meant:
        lacks, names = " and no ".join(missing), ", ".join(meant)
        raise InputError(
            "hamiltonian",
            formula,
            f"has no {lacks}; {'is' if len(meant) == 1 else 'are'} {names} meant? write"
            f" {' and '.join(missing)}, in one degree of freedom, or give a parameter its value",
        )


def _check_words(formula: str, lacks: str, parameters: Collection[str]) -> None:
    """InputError where a parameter's name is a product or a call written in one."""
    for name in parameters:
        write = ""
        if _PRODUCT.fullmatch(name):
            write = f"write {'*'.join(name)}"
        elif called := _CALL.fullmatch(name):
            write = f"write {called[1].replace('ln', 'log')}({called[2]})"
        if write:
            problem = f"has no {lacks}, and {name} would be a parameter; {write}"
            raise InputError("hamiltonian", formula, f"{problem}, or give {name} its value")
