"""Decomposition of H into parts that are not coupled."""

from collections.abc import Sequence

import sympy

from verify.algebra.formula import symbol
from verify.effort import answer_unless_long
from verify.hamiltonians.coordinates import PLANE, coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian


def uncouple(hamiltonian: Hamiltonian) -> list[tuple[Hamiltonian, tuple[str, ...]]]:
    """Return H as a sum of Hamiltonians in separate coordinates: each, in p and q or p1 … qn, with
    the names that these have in H. Degrees of freedom that are not coupled and do not move stay
    together."""
    if hamiltonian.planar:  # whose p and q have no numbers, and which need not be expanded
        return [(hamiltonian, PLANE)]
    # Degrees of freedom that occur in one term are merged: the groups are the connected components.
    groups = {k: {k} for k in range(1, hamiltonian.degrees + 1)}
    exact = hamiltonian.exact
    terms = sympy.Add.make_args(answer_unless_long(lambda: sympy.expand(exact), exact))
    for term in terms:
        numbers = sorted(_numbers(term, hamiltonian.coordinates))
        together = set[int]().union(*(groups[k] for k in numbers)) if numbers else set[int]()
        groups |= dict.fromkeys(together, together)
    parts = sorted({min(g): sorted(g) for g in groups.values()}.values())
    if len(parts) == 1:
        return [(hamiltonian, hamiltonian.coordinates)]
    return [_part(terms, part, hamiltonian.coordinates) for part in parts]


def _numbers(term: sympy.Expr, coordinates: Sequence[str]) -> set[int]:
    """Return the degrees of freedom that occur in a term."""
    return {int(s.name[1:]) for s in term.free_symbols if s.name in coordinates}


def _part(
    terms: Sequence[sympy.Expr], numbers: Sequence[int], coordinates: Sequence[str]
) -> tuple[Hamiltonian, tuple[str, ...]]:
    """Return the part of H in these degrees of freedom, with the names of its coordinates in H."""
    old = tuple(f"{letter}{k}" for letter in PLANE for k in numbers)
    renaming = {
        symbol(a): symbol(b) for a, b in zip(old, coordinates_in(len(numbers)), strict=True)
    }
    inside = [x for x in terms if _numbers(x, coordinates) & set(numbers)]
    return Hamiltonian(sympy.Add(*inside).xreplace(renaming)), old
