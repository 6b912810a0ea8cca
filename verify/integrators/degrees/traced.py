"""From a step of arrays, called with symbols, to a map that can be proved."""

from fractions import Fraction
from functools import partial

from verify.algebra.limits import checked
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.degrees.called import StepOfArrays
from verify.integrators.step import lifted
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.series import TracedSeries
from verify.integrators.tracing.trace import Node, Tape, expressions, in_order, sizes
from verify.schemes.degrees.canonical_map import CanonicalMap, State

_MOST_WRITTEN = 3000  # operations of z' as trees, of which a closed form is tried


def traced_map(own: StepOfArrays, hamiltonian: Hamiltonian) -> tuple[Tape, CanonicalMap]:
    """The map, with its series in h, and its closed form where that is short.

    Raises what the user's code raises of symbols, UntraceableError, StepError, and InputError where
    it has no series.
    """
    tape = Tape()
    symbols = [tape.symbol(name) for name in own.names]
    clock = tape.symbol("t") if own.step.moving else tape.rational(Fraction(0))
    found = own.called(copied(own.function, tape), symbols, tape.symbol("h"), clock)
    tape.check()
    roots = [x.node for x in lifted(symbols[0], found)]
    return tape, _made(roots, hamiltonian)


def _made(roots: list[Node], hamiltonian: Hamiltonian) -> CanonicalMap:
    series = TracedSeries(roots, partial(canonical_field, hamiltonian))

    def expand(most: int) -> tuple[CanonicalField, State]:
        return series(most)

    nodes = in_order(*roots)
    size = sizes(nodes)
    field, _ = canonical_field(hamiltonian)
    if sum(size[root.number] for root in roots) <= _MOST_WRITTEN:
        made = expressions(nodes, {})
        try:
            exact = [checked(made[root.number], "step", "its closed form") for root in roots]
            field, closed = canonical_field(hamiltonian, *exact)
        except InputError:
            pass
        else:
            whole = tuple(closed)
            return CanonicalMap(hamiltonian, field, closed=whole, expand=expand)
    return CanonicalMap(hamiltonian, field, expand=expand)
