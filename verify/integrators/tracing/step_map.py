"""From a trace to a step map that can be proved: shears, a closed form, or a series in h."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from verify.algebra.limits import checked
from verify.algebra.ring import Ring
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.vector_field import VectorField
from verify.integrators.tracing.series import TracedSeries
from verify.integrators.tracing.shears import shears_of
from verify.integrators.tracing.trace import Node, written
from verify.schemes.step_map import Expanded, StepMap, Substep

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
