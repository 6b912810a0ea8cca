"""From a trace to a step map that can be proved: shears, a closed form, or a series in h.

Whether a traced step is a composition of shears, p ↦ p + f(q) or q ↦ q + g(p), each of det 1.

From the end of the step to its beginning: what of p' is a function of q' alone is taken off, which
changes no determinant, then what of q' is a function of the rest of p', and so on, until p and q
are left. No closed form of the composition is written down, and f and g may be anything.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial

import sympy

from verify.algebra.embedding import MAX_TERMS
from verify.algebra.formula import symbol
from verify.algebra.limits import checked
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.linear_sums import Linear, Scalar, Scalars, added, product, scaled
from verify.integrators.tracing.series import TracedSeries
from verify.integrators.tracing.trace import Node, expressions, in_order, written
from verify.schemes.conditions.condition import Condition
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import State

_MOST_NODES, _MOST_SHEARS = 2000, 200
Terms = list[tuple[Scalar, Node]]  # (coefficient, node): a sum


@dataclass(frozen=True)
class Shear:
    """`name` grows by `increment`, an expression in the other one of p and q, and in h."""

    name: str
    increment: sympy.Expr


def shears_of(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> int | None:
    """How many shears the step is made of; None where it is not made of such, or one is no element
    of a ring."""
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
        canonical_field(hamiltonian, *(shear.increment for shear in found))
    except InputError:
        return None
    return len(found)


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


_MOST_WRITTEN = 3000  # operations of z' as trees, of which a closed form is tried
_MOST_TERMS, _MOST_OF_DEFECT = 800, 20_000  # of a closed form in the plane
_ORDERS = 9
_IN_TURN = Condition("every part is a shear", 0, "0", holds=True)
Expand = Callable[[int], tuple[CanonicalField, State]]


@dataclass(frozen=True)
class TracedMap:
    """The step map of a trace, for one H whose parameters have values.

    `how`: as what it is known, a clause. `expand`: None where the map has no Taylor series that can
    be made, and so nothing but its closed form.
    """

    step_map: StepMap
    how: str
    expand: Expand | None

    @cached_property
    def series(self) -> tuple[CanonicalField, State] | None:
        return self.expand(_ORDERS) if self.expand else None


def traced_map(hamiltonian: Hamiltonian, roots: Sequence[Node]) -> TracedMap:
    """InputError where the trace has neither a series in h nor a closed form that is short."""
    expand: Expand | None = None
    with suppress(InputError):
        expand = TracedSeries(roots, partial(canonical_field, hamiltonian))
    shears = shears_of(hamiltonian, *roots) if len(roots) == 2 and expand else None
    field, _ = canonical_field(hamiltonian)
    if shears is not None:
        made = StepMap(hamiltonian, field, conditions=(_IN_TURN,), expand=expand)
        return TracedMap(made, f"is {shears} shears in turn", expand)
    closed = _closed(hamiltonian, roots)
    if closed is not None:
        made = StepMap(
            hamiltonian,
            closed.field,
            formulas=closed.elements,
            expand=None if closed.degree is not None else expand,
        )
        return TracedMap(made, "has a short closed form", expand)
    if expand is None:
        raise InputError("step", "its operations", "have no series in h and no short closed form")
    made = StepMap(hamiltonian, field, expand=expand)
    return TracedMap(made, "is known by its Taylor series in h", expand)


def _closed(hamiltonian: Hamiltonian, roots: Sequence[Node]) -> ClosedForm | None:
    exact, planar = written(roots, _MOST_WRITTEN), len(roots) == 2
    if exact is None:
        return None
    try:
        smooth = [checked(x, "step", "its closed form") for x in exact]
        most = _MOST_TERMS if planar else MAX_TERMS
        field, elements = canonical_field(hamiltonian, *smooth, most_terms=most)
    except InputError:
        return None
    step = ClosedForm(field, tuple(elements))
    return step if not planar or step.products <= _MOST_OF_DEFECT else None
