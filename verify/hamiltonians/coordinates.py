"""The names of coordinates: p and q, or p1 … pn and q1 … qn.

Names that a user likely meant for a missing coordinate are recognised: x for q, pq for p*q.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from verify.algebra.expressions.monomials import names_in
from verify.errors import InputError
from verify.functions import names as names_of_functions
from verify.lazy_sympy import sympy

_LIKELY = {
    "p": re.compile(r"[vPy]|[pPv]_?([1-9xyzr]|theta|phi)|(mom|vel)\w*|[xpq]_?dot|dp|dx"),
    "q": re.compile(r"[xyzQXYZ]|[xyzqQ]_?[1-9xyzr]|theta|phi|varphi|angle|pos\w*|dq"),
}
_NUMBERED = re.compile(r"[pq]([1-9]\d{0,2})", re.ASCII)
PLANE = ("p", "q")
MAX_DEGREES = 64  # degrees of freedom; quantities with n² entries or more have lower limits
_PRODUCT = re.compile(r"[pq]{2,}")
_CALL = re.compile(rf"({'|'.join((*names_of_functions(), 'ln'))})_?([pq])")


def coordinates_of(names: Collection[str]) -> tuple[str, ...]:
    """Return p1 … pn, q1 … qn if numbered names are among these and neither p nor q is; else p and
    q.

    >>> coordinates_of({"p1", "q2", "k"})
    ('p1', 'p2', 'q1', 'q2')
    """
    numbers = [int(match[1]) for match in map(_NUMBERED.fullmatch, names) if match]
    if not numbers or {"p", "q"} & set(names):
        return PLANE
    return numbered_names(max(numbers))


def numbered_names(degrees: int) -> tuple[str, ...]:
    """Return p1 … pn, q1 … qn."""
    return tuple(f"{letter}{k}" for letter in PLANE for k in range(1, degrees + 1))


def coordinates_in(degrees: int) -> tuple[str, ...]:
    """Return the coordinates in n = `degrees` degrees of freedom: p and q, or p1 … pn, q1 … qn."""
    return PLANE if degrees == 1 else numbered_names(degrees)


def check_degrees(degrees: int) -> None:
    """Raise InputError unless the number of degrees of freedom is allowed."""
    if not 1 <= degrees <= MAX_DEGREES:
        raise InputError("degrees", degrees, f"must be 1 … {MAX_DEGREES}")


def check_coordinates(formula: str, expression: sympy.Expr, parameters: Collection[str]) -> None:
    """Raise InputError if H has no p or no q, and a parameter's name is likely meant for it.

    `parameters`: those without a value; a name with a value is a parameter on purpose.
    """
    # A missing coordinate is legal (H = p²/2): it is refused only if a parameter looks like it.
    present = names_in(expression)
    if coordinates_of(present) != PLANE:
        _check_numbers(formula, present)
        return
    numbered = sorted(x for x in parameters if _NUMBERED.fullmatch(x))
    if numbered and {"p", "q"} & set(present):
        problem = (
            f"has {', '.join(numbered)} beside p and q; allowed: p and q alone, a parameter of"
        )
        raise InputError("hamiltonian", formula, f"{problem} that name with its value, or p1 … qn")
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


def _check_numbers(formula: str, present: Collection[str]) -> None:
    """Raise InputError if a number from 1 to n is missing, or n is too large."""
    degrees = len(coordinates_of(present)) // 2
    if degrees > MAX_DEGREES:
        problem = f"has {degrees} degrees of freedom; allowed: up to {MAX_DEGREES}"
        raise InputError("hamiltonian", formula, problem)
    for k in range(1, degrees):
        if not {f"p{k}", f"q{k}"} & set(present):
            present_names = ", ".join(x for x in numbered_names(degrees) if x in present)
            problem = (
                f"has {present_names}, and neither p{k} nor q{k}; allowed: p1 … pn and q1 … qn"
            )
            raise InputError("hamiltonian", formula, problem)


def _check_words(formula: str, lacks: str, parameters: Collection[str]) -> None:
    """Raise InputError if a parameter's name is a product or a call, written as one word."""
    for name in parameters:
        write = ""
        if _PRODUCT.fullmatch(name):
            write = f"write {'*'.join(name)}"
        elif match := _CALL.fullmatch(name):
            write = f"write {match[1].replace('ln', 'log')}({match[2]})"
        if write:
            problem = f"has no {lacks}, and {name} would be a parameter; {write}"
            raise InputError("hamiltonian", formula, f"{problem}, or give {name} its value")
