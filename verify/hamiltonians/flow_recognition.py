"""Recognition of flows that are known in closed form: of a named system, or in a polynomial
potential.

In n degrees of freedom H is first split into Hamiltonians that are not coupled.

A constant added to H does not change its flow; so constants are ignored. A named system's
parameters come from sympy's matching of a short sum. A match counts only if algebra then shows that
the two vector fields are the same.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial

import sympy
from flint import fmpq

from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.symbols import P, Q
from verify.effort import answer_unless_long
from verify.errors import InputError
from verify.hamiltonians import potential_motion
from verify.hamiltonians.coordinates import PLANE, coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import Motion, State, System, Values
from verify.hamiltonians.systems import all_systems

_MOST_TERMS = 8


@dataclass(frozen=True)
class NamedSystem:
    """A named system with its parameters' values."""

    system: System
    values: Values


def closed_form(hamiltonian: Hamiltonian, p: Fraction, q: Fraction) -> Motion | None:
    """Return the motion from (p, q) in closed form; None if none is known."""
    return motions(hamiltonian)(p, q)


def motions(hamiltonian: Hamiltonian) -> Callable[[Fraction, Fraction], Motion | None]:
    """Return `closed_form` of this Hamiltonian as a function of (p, q), for many points."""
    if hamiltonian.symbols or hamiltonian.time_dependent:
        return lambda p, q: None
    coefficients = potential(hamiltonian)
    if coefficients is not None:
        return potential_motion.motions(*coefficients)
    flows = [(match.system.flow, match.values) for match in named_systems(hamiltonian)]

    def motion(p: Fraction, q: Fraction) -> Motion | None:
        candidates = (flow(values, p, q) for flow, values in flows if flow)
        return next((x for x in candidates if x is not None), None)

    return motion


@lru_cache(maxsize=64)
def potential(hamiltonian: Hamiltonian) -> tuple[fmpq, tuple[fmpq, ...]] | None:
    """Return α and (c₀, …, c₄) if H = α p²/2 + Σ c_k q^k with α ≠ 0; else None."""
    terms = _terms(hamiltonian.exact)
    if terms is None or not terms.is_polynomial(P, Q):
        return None
    # ℘ solves the motion for powers of q up to 4, and for no others.
    kinetic, coefficients = fmpq(0), [fmpq(0)] * 5
    for (i, j), c in sympy.Poly(terms, P, Q).terms():
        if not c.is_Rational or (i and (i, j) != (2, 0)) or j > 4:
            return None
        value = fmpq(int(c.p), int(c.q))
        if i:
            kinetic = 2 * value
        else:
            coefficients[j] = value
    return (kinetic, tuple(coefficients)) if kinetic else None


@lru_cache(maxsize=64)
def named_systems(hamiltonian: Hamiltonian) -> tuple[NamedSystem, ...]:
    """Return the named systems with the flow of this Hamiltonian, with their parameters' values."""
    return () if hamiltonian.time_dependent else tuple(_matches(hamiltonian))


def state_in_time(
    hamiltonian: Hamiltonian, start: tuple[Fraction, Fraction, Fraction], time: Fraction
) -> Callable[[], State] | None:
    """Return a function that computes p and q after `time` from `start` = (p, q, t), at flint's
    present precision; None unless H(p, q, t) has the formula of a named system with a known
    flow."""
    for system in all_systems().values():
        flow = system.flow_in_time
        if flow and system.hamiltonian().expression == hamiltonian.expression:
            return partial(flow, dict(hamiltonian.values), start, time)
    return None


def _matches(hamiltonian: Hamiltonian) -> Iterator[NamedSystem]:
    exact = hamiltonian.exact
    terms = _terms(exact)
    for system in all_systems().values():
        if system.time_dependent:
            continue
        formula = system.hamiltonian().expression
        if (formula - hamiltonian.expression).is_number:
            yield NamedSystem(system, dict(hamiltonian.values))
            continue
        values = None if terms is None else _values(terms, formula, tuple(system.parameters))
        if values is not None and _same_field(system, values, exact):
            yield NamedSystem(system, values)


def _terms(exact: sympy.Expr) -> sympy.Expr | None:
    """Return H expanded to a sum; None if it has many terms."""
    ring, (element,) = embed([exact], ("p", "q"))
    return ring.expression(element) if len(element) <= _MOST_TERMS else None


def _values(terms: sympy.Expr, formula: sympy.Expr, names: tuple[str, ...]) -> Values | None:
    """Return parameters' values for which the system may equal this sum; None if there are none."""
    wild = {symbol(name): sympy.Wild(name, exclude=[P, Q]) for name in names}
    pattern = _without_constant(sympy.expand(formula)).subs(wild)
    match = answer_unless_long(lambda: _without_constant(terms).match(pattern), None)
    if match is None or not all(x.is_Rational for x in match.values()):
        return None
    return {x.name: Fraction(int(value.p), int(value.q)) for x, value in match.items()}


def _without_constant(terms: sympy.Expr) -> sympy.Expr:
    return terms.as_independent(P, Q, as_Add=True)[1]


def _same_field(system: System, values: Values, exact: sympy.Expr) -> bool:
    if set(values) != set(system.parameters):
        return False
    try:
        candidate = system.hamiltonian(values)
    except InputError:
        return False
    # sympy's match is only a guess; the ring decides whether the difference is constant.
    ring, (difference,) = embed([candidate.exact - exact], ("p", "q"))
    return all(ring.decide(ring.diff(difference, name)).zero is True for name in ("p", "q"))


# -- parts that are not coupled -------------------------------------------------------------------


def uncouple(hamiltonian: Hamiltonian) -> list[tuple[Hamiltonian, tuple[str, ...]]]:
    """Return H as a sum of Hamiltonians in separate coordinates, if its terms separate them.

    Each item: the Hamiltonian in p and q or p1 … qn, and the names of these coordinates in H. A
    degree of freedom that is in no term is an item of its own.
    """
    if hamiltonian.planar:  # p and q have no numbers, and nothing is to be split
        return [(hamiltonian, PLANE)]
    # Degrees of freedom in one term are merged: the groups are the connected components.
    groups = {k: {k} for k in range(1, hamiltonian.degrees + 1)}
    exact = hamiltonian.exact
    terms = sympy.Add.make_args(answer_unless_long(lambda: sympy.expand(exact), exact))
    for term in terms:
        numbers = sorted(_degrees_in(term, hamiltonian.coordinates))
        together = set[int]().union(*(groups[k] for k in numbers)) if numbers else set[int]()
        groups |= dict.fromkeys(together, together)
    parts = sorted({min(g): sorted(g) for g in groups.values()}.values())
    if len(parts) == 1:
        return [(hamiltonian, hamiltonian.coordinates)]
    return [_part(terms, part, hamiltonian.coordinates) for part in parts]


def _degrees_in(term: sympy.Expr, coordinates: Sequence[str]) -> set[int]:
    """Return the degrees of freedom that occur in a term."""
    return {int(s.name[1:]) for s in term.free_symbols if s.name in coordinates}


def _part(
    terms: Sequence[sympy.Expr], numbers: Sequence[int], coordinates: Sequence[str]
) -> tuple[Hamiltonian, tuple[str, ...]]:
    """Return the part of H in the degrees of freedom `numbers`, and its coordinates' names in H."""
    names = tuple(f"{letter}{k}" for letter in PLANE for k in numbers)
    renaming = {
        symbol(a): symbol(b) for a, b in zip(names, coordinates_in(len(numbers)), strict=True)
    }
    inside = [x for x in terms if _degrees_in(x, coordinates) & set(numbers)]
    return Hamiltonian(sympy.Add(*inside).xreplace(renaming)), names
