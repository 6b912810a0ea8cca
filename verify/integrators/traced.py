"""From a user's map, called with symbols, to what is proved of it."""

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from verify.algebra.embedding import embed
from verify.algebra.limits import checked
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Finding
from verify.integrators.tracing.domain import domain_of
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.readings_of_floats import readings
from verify.integrators.tracing.series import TracedSeries
from verify.integrators.tracing.step_map import traced_map
from verify.integrators.tracing.trace import Node, Tape, expressions, in_order, sizes
from verify.integrators.user_code.step import StepError, lifted
from verify.integrators.user_code.user_map import UserMap
from verify.proof.claimed import Claimed
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import prove
from verify.proof.symplectic import closed_form
from verify.proof.symplectic.order import prove_map
from verify.prose import prose
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.step_algebra import State
from verify.verdict import Verdict

_MOST_WRITTEN, _MOST_OF_MAP = (
    3000,
    4000,
)  # operations of z' as trees, of which a closed form is tried
_MOST_TERMS = 2000
_MOST = 8  # orders that are looked at but for rounding


@dataclass(frozen=True)
class Trace:
    """z' as operations on symbols."""

    tape: Tape
    roots: tuple[Node, ...]


def trace_of(step: UserMap) -> Trace:
    """Calls it with symbols. Raises what the user's code raises of them, UntraceableError and
    StepError."""
    tape = Tape()
    symbols = [tape.symbol(name) for name in step.names]
    clock = tape.symbol("t") if step.moving else tape.rational(Fraction(0))
    size = tape.symbol("h")
    after = step.call(copied(step.function, tape), symbols, size, clock, tape.rational)
    tape.check()
    return Trace(tape, tuple(x.node for x in lifted(symbols[0], after)))


# -- a step in the plane --------------------------------------------------------------------------


def proved_in_plane(trace: Trace, hamiltonian: Hamiltonian) -> Finding:
    """By the prover of the plane. Raises InputError where it has no series and no closed form."""
    tape = trace.tape
    traced = traced_map(hamiltonian, *trace.roots)
    proof = prove(traced.step_map)
    return Finding(
        proof.verdict,
        proof.reason,
        "proof",
        order=proof.order,
        symplectic=proof.area_preserving,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        order_decided=proof.convergence_decided,
        area_at_least=proof.first.power or MOST_ORDERS + 1,
        leading=proof.first.text,
        delta_j=proof.step_map.delta_j_text,
        proof=proof,
        domain=(proof.domain & domain_of(tape)).texts,
    ).noting(f"traced with symbols; the map {traced.how}", *readings(tape))


# -- a step in several degrees of freedom ---------------------------------------------------------


def proved_in_degrees(trace: Trace, hamiltonian: Hamiltonian) -> Finding:
    """By the prover of n degrees of freedom. Raises InputError where it has no series."""
    proof = prove_map(_canonical(list(trace.roots), hamiltonian), Claimed())
    return Finding(
        proof.verdict,
        proof.reason,
        "proof",
        hamiltonian.degrees,
        order=proof.order,
        proof=proof,
        symplectic=proof.symplectic,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        order_decided=True,
        entry=proof.entry,
        leading=proof.leading_text,
        domain=(proof.domain & domain_of(trace.tape)).texts,
        notes=(prose("traced with symbols"), *readings(trace.tape)),
    )


def _canonical(roots: list[Node], hamiltonian: Hamiltonian) -> CanonicalMap:
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
            return CanonicalMap(hamiltonian, field, closed=tuple(closed), expand=expand)
    return CanonicalMap(hamiltonian, field, expand=expand)


# -- a map without an H ---------------------------------------------------------------------------


def proved_of_map(trace: Trace, names: tuple[str, ...]) -> Finding:
    """Whether S vanishes, decided by exact algebra. Raises StepError where it is too long."""
    ring, closed = _closed(trace, names)
    form = closed_form.defect(ring, names, closed)
    decision, place = form.decide()
    where = domain_of(trace.tape)
    base = Finding(
        Verdict.UNDECIDED, prose("whether S vanishes is not decided"), "proof", len(names) // 2,
        domain=where.texts, notes=(prose("traced with symbols"), *readings(trace.tape)),
    )  # fmt: skip
    if decision.zero is True:
        said = prose("S is the zero form: the map is symplectic")
        reason = prose(said, ", where ", where.prose) if where else said
        return replace(
            base, verdict=Verdict.PROVED, reason=reason, symplectic=True, area_preserving=True
        )
    if decision.zero is None or place is None:
        return base
    volume = closed_form.preserves_volume(ring, names, closed)
    return replace(
        base,
        verdict=Verdict.REFUTED,
        symplectic=False,
        area_preserving=volume,
        entry=form.called(place),
    )


def _closed(trace: Trace, names: tuple[str, ...]) -> tuple[Ring, list[Poly]]:
    """The map as elements of a ring."""
    nodes = in_order(*trace.roots)
    size = sizes(nodes)
    if sum(size[root.number] for root in trace.roots) > _MOST_OF_MAP:
        raise StepError(f"written out it has more than {_MOST_OF_MAP} operations")
    made = expressions(nodes, {})
    exact = [checked(made[root.number], "map", "its closed form") for root in trace.roots]
    return embed(exact, names, _MOST_TERMS)
