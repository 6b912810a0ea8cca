"""H taken apart into what is not coupled."""

from collections.abc import Sequence

import sympy

from verify.algebra.formula import symbol
from verify.effort import unless_long
from verify.hamiltonians.coordinates import PLANE, coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian


def uncoupled(hamiltonian: Hamiltonian) -> list[tuple[Hamiltonian, tuple[str, ...]]]:
    """H as a sum of Hamiltonians in coordinates of their own: each, in p and q or p1 … qn, with the
    names that these have in H. What is coupled with nothing and does not move is left together."""
    if hamiltonian.planar:  # whose p and q have no numbers, and which need not be expanded
        return [(hamiltonian, PLANE)]
    groups = {k: {k} for k in range(1, hamiltonian.degrees + 1)}
    exact = hamiltonian.exact
    terms = sympy.Add.make_args(unless_long(lambda: sympy.expand(exact), exact))
    for term in terms:
        numbers = sorted(_numbers(term, hamiltonian.coordinates))
        together = set[int]().union(*(groups[k] for k in numbers)) if numbers else set[int]()
        groups |= dict.fromkeys(together, together)
    parts = sorted({min(g): sorted(g) for g in groups.values()}.values())
    if len(parts) == 1:
        return [(hamiltonian, hamiltonian.coordinates)]
    return [_part(terms, own, hamiltonian.coordinates) for own in parts]


def _numbers(term: sympy.Expr, coordinates: Sequence[str]) -> set[int]:
    """Which degrees of freedom are in it."""
    return {int(s.name[1:]) for s in term.free_symbols if s.name in coordinates}


def _part(
    terms: Sequence[sympy.Expr], own: Sequence[int], coordinates: Sequence[str]
) -> tuple[Hamiltonian, tuple[str, ...]]:
    old = tuple(f"{letter}{k}" for letter in PLANE for k in own)
    put = {symbol(a): symbol(b) for a, b in zip(old, coordinates_in(len(own)), strict=True)}
    inside = [x for x in terms if _numbers(x, coordinates) & set(own)]
    return Hamiltonian(sympy.Add(*inside).xreplace(put)), old
