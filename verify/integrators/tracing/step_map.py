"""From a trace to a step map that can be proved: shears, a closed form, or a series in h.

Whether a traced step is a composition of shears, p ↦ p + f(q) or q ↦ q + g(p), each of det 1.

From the end of the step to its beginning: what of p' is a function of q' alone is taken off, which
changes no determinant, then what of q' is a function of the rest of p', and so on, until p and q
are left. No closed form of the composition is written down, and f and g may be anything.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import sympy

from verify.algebra.formula import symbol
from verify.algebra.limits import checked
from verify.algebra.ring import Ring
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.vector_field import VectorField
from verify.integrators.tracing.linear_sums import Linear, Scalar, Scalars, added, product, scaled
from verify.integrators.tracing.series import TracedSeries
from verify.integrators.tracing.trace import Node, expressions, in_order, written
from verify.schemes.step_map import Expanded, StepMap, Substep

_MOST_NODES, _MOST_SHEARS = 2000, 200
Terms = list[tuple[Scalar, Node]]  # (coefficient, node): a sum


@dataclass(frozen=True)
class Shear:
    """`name` grows by `increment`, an expression in the other one of p and q, and in h."""

    name: str
    increment: sympy.Expr


def shears_of(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> tuple[Substep, ...] | None:
    """The shears, first one first, as substeps of one field; None where the step is none."""
    nodes = in_order(p_next, q_next)
    if len(nodes) > _MOST_NODES:
        return None
    try:
        found = _Peeler(nodes).shears(p_next, q_next)
    except RecursionError:  # a sum of very many terms
        return None
    if not found:
        return None
    try:
        field, increments = hamiltonian.field(*(shear.increment for shear in found))
    except InputError:
        return None
    p, q = (field.ring.variable(name) for name in "pq")
    return tuple(
        Substep(field, p + x, q) if shear.name == "p" else Substep(field, p, q + x)
        for shear, x in zip(found, increments, strict=True)
    )


class _Peeler:
    """Takes shears off the end of a step."""

    def __init__(self, nodes: list[Node]) -> None:
        self.scalars = Scalars(nodes)
        self.written = expressions(nodes, {})

    def shears(self, p_next: Node, q_next: Node) -> list[Shear] | None:
        """First one first; None where something is left that is no shear."""
        one = self.scalars.one
        left: dict[str, Terms] = {"p": [(one, p_next)], "q": [(one, q_next)]}
        found: list[Shear] = []
        last = ""
        while len(found) < _MOST_SHEARS:
            if all(self._is_symbol(left[name], name) for name in "pq"):
                return found[::-1]
            # What is a function as it stands is taken off before multiples are.
            for take, name in ((t, n) for t in (self._off, self._multiple_off) for n in "pq"):
                other = "q" if name == "p" else "p"
                increment = take(left, name, other) if name != last else None
                if increment is not None:
                    found.append(Shear(name, increment))
                    last = name
                    break
            else:
                return None
        return None

    def _is_symbol(self, terms: Terms, name: str) -> bool:
        return self.scalars.sum(terms) == {self.scalars.symbols.get(name): self.scalars.one}

    def _off(self, left: dict[str, Terms], name: str, other: str) -> sympy.Expr | None:
        """Takes off what is a function of the other one; it as an expression in that one's name."""
        function = _Function(self, self.scalars.sum(left[other]), symbol(other))
        kept, taken = function.parted(left[name])
        if not any(node.number in self.scalars.moving for _, node in taken):
            return None
        left[name] = kept
        parts = [self.scalars.expression(c) * function.expression(node) for c, node in taken]
        return sympy.Add(*parts)

    def _multiple_off(self, left: dict[str, Terms], name: str, other: str) -> sympy.Expr | None:
        """Takes off such a multiple of the other one as makes its symbol vanish."""
        mine, others = (self.scalars.sum(left[x]) for x in (name, other))
        at = self.scalars.symbols.get(other)
        if at is None or at not in mine or others.get(at) != self.scalars.one:
            return None
        factor = mine[at]
        minus = {monomial: -value for monomial, value in factor.items()}
        rest = added(mine, scaled(others, minus))
        left[name] = [(c, self.scalars.leaf(number)) for number, c in rest.items()]
        return self.scalars.expression(factor) * symbol(other)


class _Function:
    """Functions of one thing, `target`: which nodes are such, and as what in `name`."""

    def __init__(self, peeler: _Peeler, target: Linear, name: sympy.Symbol) -> None:
        self.scalars, self.written = peeler.scalars, peeler.written
        self.target, self.name = target, name
        self._known: dict[int, bool] = {}

    def holds(self, node: Node) -> bool:
        """Whether the node is a function of the target and of h alone."""
        for inner in in_order(node):
            if inner.number not in self._known:
                self._known[inner.number] = (
                    inner.number not in self.scalars.moving
                    or self.scalars.linear(inner) == self.target
                    or (bool(inner.inputs) and all(self._known[x.number] for x in inner.inputs))
                )
        return self._known[node.number]

    def parted(self, terms: Terms) -> tuple[Terms, Terms]:
        """What is left, and what is such a function; a sum is opened where it holds one."""
        kept: Terms = []
        taken: Terms = []
        for coefficient, node in terms:
            if self.holds(node):
                taken.append((coefficient, node))
                continue
            parts = self.scalars.parts(node)
            inner = self.parted([(product(coefficient, c), x) for c, x in parts])
            if inner[1]:
                kept += inner[0]
                taken += inner[1]
            else:
                kept.append((coefficient, node))
        return kept, taken

    def expression(self, node: Node) -> sympy.Expr:
        made: dict[int, sympy.Expr] = {}
        for inner in in_order(node):
            if inner.number not in self.scalars.moving:
                made[inner.number] = self.written[inner.number]
            elif self.scalars.linear(inner) == self.target:
                made[inner.number] = self.name
            elif all(x.number in made for x in inner.inputs) and inner.inputs:
                made[inner.number] = expressions([inner], {}, made)[inner.number]
        return made[node.number]


_MOST_WRITTEN = 3000  # operations of p' and q' as trees, of which a closed form is tried
_MOST_TERMS, _MOST_OF_DELTA_J = 800, 20_000


@dataclass(frozen=True)
class TracedMap:
    """The step map of a trace, for one H whose parameters have values.

    `how`: as what it is known, a clause. `series`: None where the map has no Taylor series that
    can be made, and so nothing but its closed form.
    """

    step_map: StepMap
    how: str
    make: Callable[[int], Expanded] | None

    @cached_property
    def series(self) -> Expanded | None:
        return self.make(_ORDERS) if self.make else None


_ORDERS = 9


def traced_map(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> TracedMap:
    """InputError where the trace has neither a series in h nor a closed form that is short."""
    series = _series(hamiltonian, p_next, q_next)
    shears = shears_of(hamiltonian, p_next, q_next)
    if shears is not None:
        return TracedMap(
            StepMap(hamiltonian, shears, series), f"is {len(shears)} shears in turn", series
        )
    closed = _closed(hamiltonian, p_next, q_next)
    if closed is not None:
        polynomial = closed.terms is not None
        made = StepMap(hamiltonian, (closed,), None if polynomial else series)
        return TracedMap(made, "has a short closed form", series)
    if series is None:
        raise InputError("step", "its operations", "have no series in h and no short closed form")
    return TracedMap(
        StepMap(hamiltonian, (_unwritten(hamiltonian),), series),
        "is known by its Taylor series in h",
        series,
    )


def _series(
    hamiltonian: Hamiltonian, p_next: Node, q_next: Node
) -> Callable[[int], Expanded] | None:
    """None where it has none at h = 0."""
    try:
        traced = TracedSeries((p_next, q_next), hamiltonian.field)
    except InputError:
        return None

    def series(most: int) -> Expanded:
        field, (p, q) = traced(most)
        return field, p, q

    return series


def _closed(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> Substep | None:
    pair = written((p_next, q_next), _MOST_WRITTEN)
    if pair is None:
        return None
    try:
        smooth = [checked(x, "step", "its closed form") for x in pair]
        field, (p, q) = hamiltonian.field(*smooth, most_terms=_MOST_TERMS)
    except InputError:
        return None
    step = Substep(field, p, q)
    return step if step.terms_of_delta_j <= _MOST_OF_DELTA_J else None


def _unwritten(hamiltonian: Hamiltonian) -> Substep:
    """A map of which nothing but its series is known: two unknowns without an equation."""
    ring = Ring(("p", "q", "h", *hamiltonian.symbols), 2, spare=0)
    unknowns = [ring.add("solved", None, k) for k in range(2)]
    field = VectorField(ring, ring.variable("p"), ring.variable("q"))
    return Substep(field, unknowns[0], unknowns[1])
