"""The step map of a trace in a form that can be proved: shears, a closed form, or a series in h.

A closed form writes p' and q' as formulas in p, q and h. A traced step may also be a composition of
shears, p ↦ p + f(q) or q ↦ q + g(p), each with det J = 1. The shears are found from the end of the
step to its beginning: the part of p' that is a function of q' is subtracted, then the part of q'
that is a function of the rest of p', and so on, until p and q are left. This needs no closed form
of the composition, and f and g may be any functions.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial

import sympy

from verify.algebra.embedding import MAX_TERMS
from verify.algebra.formula import symbol
from verify.algebra.limits import check_expression
from verify.errors import InputError
from verify.hamiltonians.canonical_field import PlainField, canonical_field, field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.linear_sums import Linear, Scalar, Scalars, add, product, scale
from verify.integrators.tracing.trace import Node, expressions, in_order, write_expressions
from verify.integrators.tracing.traced_series import TracedSeries
from verify.schemes.conditions.condition import Condition
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import State

_MAX_NODES, _MAX_SHEARS = 2000, 200
Terms = list[tuple[Scalar, Node]]  # a sum of products, each coefficient times node


@dataclass(frozen=True)
class Shear:
    """A map that adds `increment` to the coordinate `name`.

    The increment is an expression in the other coordinate and in h.
    """

    name: str
    increment: sympy.Expr


def shears_of(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> int | None:
    """Return the number of shears of which the step is composed; None if it is no composition of
    shears, or one of them is no element of a ring."""
    nodes = in_order(p_next, q_next)
    if len(nodes) > _MAX_NODES:
        return None
    try:
        shears = _Peeler(nodes).shears(p_next, q_next)
    except RecursionError:  # a sum of very many terms
        return None
    if not shears:
        return None
    try:
        canonical_field(hamiltonian, *(shear.increment for shear in shears))
    except InputError:
        return None
    return len(shears)


class _Peeler:
    """A reader that takes shears off the end of a step."""

    def __init__(self, nodes: list[Node]) -> None:
        self.scalars = Scalars(nodes)
        self.written = expressions(nodes, {})

    def shears(self, p_next: Node, q_next: Node) -> list[Shear] | None:
        """Return the shears in their order; None if the rest is no shear."""
        one = self.scalars.one
        left: dict[str, Terms] = {"p": [(one, p_next)], "q": [(one, q_next)]}
        peeled: list[Shear] = []
        last = ""
        while len(peeled) < _MAX_SHEARS:
            if all(self._is_symbol(left[name], name) for name in "pq"):
                return peeled[::-1]
            # Functions of the other coordinate are taken off before multiples of its node are.
            for take, name in (
                (t, n) for t in (self._take_function_off, self._take_multiple_off) for n in "pq"
            ):
                other = "q" if name == "p" else "p"
                increment = take(left, name, other) if name != last else None
                if increment is not None:
                    peeled.append(Shear(name, increment))
                    last = name
                    break
            else:
                return None
        return None

    def _is_symbol(self, terms: Terms, name: str) -> bool:
        return self.scalars.sum(terms) == {self.scalars.symbols.get(name): self.scalars.one}

    def _take_function_off(
        self, left: dict[str, Terms], name: str, other: str
    ) -> sympy.Expr | None:
        """Subtract the terms that are functions of the other coordinate; return their sum as an
        expression in its name."""
        function = _Function(self, self.scalars.sum(left[other]), symbol(other))
        remaining, removed = function.split_terms(left[name])
        if not any(node.number in self.scalars.moving for _, node in removed):
            return None
        left[name] = remaining
        parts = [self.scalars.expression(c) * function.expression(node) for c, node in removed]
        return sympy.Add(*parts)

    def _take_multiple_off(
        self, left: dict[str, Terms], name: str, other: str
    ) -> sympy.Expr | None:
        """Take off such a multiple of the other coordinate as makes its symbol vanish."""
        own_sum, other_sum = (self.scalars.sum(left[x]) for x in (name, other))
        leaf = self.scalars.symbols.get(other)
        if leaf is None or leaf not in own_sum or other_sum.get(leaf) != self.scalars.one:
            return None
        factor = own_sum[leaf]
        minus = {monomial: -value for monomial, value in factor.items()}
        # The multiple is chosen so that the other coordinate's symbol cancels.
        remainder = add(own_sum, scale(other_sum, minus))
        left[name] = [(c, self.scalars.leaf(number)) for number, c in remainder.items()]
        return self.scalars.expression(factor) * symbol(other)


class _Function:
    """Functions of one thing, `target`: which nodes are such, and as what in `name`."""

    def __init__(self, peeler: _Peeler, target: Linear, name: sympy.Symbol) -> None:
        self.scalars, self.written = peeler.scalars, peeler.written
        self.target, self.name = target, name
        self._results: dict[int, bool] = {}

    def holds(self, node: Node) -> bool:
        """Return True if the node is a function of the target and of h alone."""
        for inner in in_order(node):
            if inner.number not in self._results:
                self._results[inner.number] = (
                    inner.number not in self.scalars.moving
                    or self.scalars.linear(inner) == self.target
                    or (bool(inner.inputs) and all(self._results[x.number] for x in inner.inputs))
                )
        return self._results[node.number]

    def split_terms(self, terms: Terms) -> tuple[Terms, Terms]:
        """Split off what is such a function, after what is left; a sum is opened where it holds
        one."""
        remaining: Terms = []
        functions: Terms = []
        for coefficient, node in terms:
            if self.holds(node):
                functions.append((coefficient, node))
                continue
            parts = self.scalars.parts(node)
            inner = self.split_terms([(product(coefficient, c), x) for c, x in parts])
            if inner[1]:
                remaining += inner[0]
                functions += inner[1]
            else:
                remaining.append((coefficient, node))
        return remaining, functions

    def expression(self, node: Node) -> sympy.Expr:
        values: dict[int, sympy.Expr] = {}
        for inner in in_order(node):
            if inner.number not in self.scalars.moving:
                values[inner.number] = self.written[inner.number]
            elif self.scalars.linear(inner) == self.target:
                values[inner.number] = self.name
            elif all(x.number in values for x in inner.inputs) and inner.inputs:
                values[inner.number] = expressions([inner], {}, values)[inner.number]
        return values[node.number]


_MAX_OPERATIONS = 3000  # of z' written out as trees, up to which a closed form is tried
_MAX_PLANAR_TERMS, _MAX_PLANAR_PRODUCTS = 800, 20_000  # of a closed form in the plane
_SERIES_ORDER = 9  # the power of h up to which `series` is computed
_SHEARS_CONDITION = Condition("every part is a shear", 0, "0", holds=True)
Expand = Callable[[int], tuple[PlainField, State]]


@dataclass(frozen=True)
class TracedMap:
    """The step map of a trace, for one H whose parameters have values.

    `how`: a clause that tells its form. `expand`: returns the Taylor series up to a power of h;
    None if this cannot be computed, so that only the closed form is known.
    """

    step_map: StepMap
    how: str
    expand: Expand | None

    @cached_property
    def series(self) -> tuple[PlainField, State] | None:
        return self.expand(_SERIES_ORDER) if self.expand else None


def traced_map(hamiltonian: Hamiltonian, roots: Sequence[Node]) -> TracedMap:
    """Build the step map. Raises InputError if the trace has neither a series in h nor a short
    closed form."""
    expand: Expand | None = None
    with suppress(InputError):
        expand = TracedSeries(roots, partial(field_of, hamiltonian))
    # Shears first: they prove det J = 1 without any closed form, which for many stages would be too
    # long to be expanded.
    shears = shears_of(hamiltonian, *roots) if hamiltonian.planar and expand else None
    field, _ = field_of(hamiltonian)
    if shears is not None:
        step_map = StepMap(hamiltonian, field, conditions=(_SHEARS_CONDITION,), expand=expand)
        return TracedMap(step_map, f"is {shears} shears in turn", expand)
    closed = _build_closed_form(hamiltonian, roots)
    if closed is not None:
        step_map = StepMap(
            hamiltonian,
            closed.field,
            formulas=closed.elements,
            expand=None if closed.degree is not None else expand,
        )
        return TracedMap(step_map, "has a short closed form", expand)
    if expand is None:
        raise InputError("step", "its operations", "have no series in h and no short closed form")
    step_map = StepMap(hamiltonian, field, expand=expand)
    return TracedMap(step_map, "is known by its Taylor series in h", expand)


def _build_closed_form(hamiltonian: Hamiltonian, roots: Sequence[Node]) -> ClosedForm | None:
    formulas, planar = write_expressions(roots, _MAX_OPERATIONS), hamiltonian.planar
    if formulas is None:
        return None
    try:
        smooth = [check_expression(x, "step", "its closed form") for x in formulas]
        term_limit = _MAX_PLANAR_TERMS if planar else MAX_TERMS
        field, elements = field_of(hamiltonian, *smooth, most_terms=term_limit)
    except InputError:
        return None
    step = ClosedForm(field, tuple(elements))
    return step if not planar or step.products <= _MAX_PLANAR_PRODUCTS else None
