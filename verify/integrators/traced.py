"""From a user's map, called with symbols, to what is proved of it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial

from verify.algebra.embedding import embed
from verify.algebra.limits import checked
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.exact import decimal
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Finding
from verify.integrators.tracing.domain import domain_of
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.readings_of_floats import readings
from verify.integrators.tracing.rounded_order import (
    Compared,
    Rounded,
    agreement,
    rounded_orders,
)
from verify.integrators.tracing.series import TracedSeries
from verify.integrators.tracing.step_map import TracedMap, traced_map
from verify.integrators.tracing.trace import Node, Tape, expressions, in_order, sizes
from verify.integrators.user_code.step import StepError, lifted
from verify.integrators.user_code.user_map import UserMap
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import prove
from verify.proof.symplectic import closed_form
from verify.proof.symplectic.defect import series_of
from verify.proof.symplectic.order import Claimed, prove_map
from verify.prose import Prose, prose, read_prose
from verify.schemes.degrees.canonical_map import CanonicalMap, State
from verify.verdict import Verdict

_MOST_WRITTEN = 3000  # operations of z' as trees, of which a closed form is tried
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
    finding = Finding(
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
    return _but_for_rounding(finding, traced, tape)


def _but_for_rounding(finding: Finding, traced: TracedMap, tape: Tape) -> Finding:
    """The orders that hold but for the rounding of its coefficients, where they are others."""
    if not tape.rounded or traced.series is None:
        return finding
    field, p, q = traced.series
    better = rounded_orders(field, p, q)
    if better.convergence == finding.convergence_order and better.area in (finding.order, None):
        return finding
    if better.residue == 0:
        return finding
    kept = finding.area_preserving is True
    area = None if kept else better.area
    leading = finding.leading
    if not kept:
        leading = field.ring.text(better.leading) if better.leading is not None else None
    preserved = True if kept else None if area is None else False
    return replace(
        finding,
        verdict=Verdict.MEASURED if _is_scheme(better) else finding.verdict,
        reason=_rounded_reason(finding, better, p.most),
        order=area,
        symplectic=preserved,
        area_preserving=preserved,
        convergence_order=better.convergence if better.convergence is not None else p.most,
        leading=leading,
        area_at_least=p.most,
        proof=None,
    )


def _is_scheme(better: Rounded) -> bool:
    return better.convergence is None or better.convergence >= 1


def _rounded_reason(finding: Finding, better: Rounded, most: int) -> Prose:
    order = f"order {better.convergence}" if better.convergence is not None else f"order ≥ {most}"
    if finding.area_preserving:
        area = "det J ≡ 1, proved"
    else:
        area = f"ΔJ = O(`h^{better.area if better.area is not None else most}`)"
    strictly = finding.convergence_order
    exactly = f"; taken exactly, they make the order {strictly}" if strictly is not None else ""
    residue = decimal(better.residue, 2)
    return read_prose(
        f"{order} and {area}, but for the rounding of its coefficients, which leaves residues of "
        f"up to `{residue}`{exactly}"
    )


# -- a step in several degrees of freedom ---------------------------------------------------------


def proved_in_degrees(trace: Trace, hamiltonian: Hamiltonian) -> Finding:
    """By the prover of n degrees of freedom. Raises InputError where it has no series."""
    made = _canonical(list(trace.roots), hamiltonian)
    proof = prove_map(made, Claimed())
    finding = Finding(
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
    if not trace.tape.rounded:
        return finding
    order = _rounded_order(made)
    exact = finding.convergence_order
    if exact is None or order == exact:
        return finding
    said = (
        f"but for the rounding of its coefficients it agrees with the exact flow up to `h^{order}`"
    )
    return replace(
        finding,
        verdict=Verdict.MEASURED if order >= 1 else Verdict.REFUTED,
        reason=prose(read_prose(said), "; ", finding.reason) if order < 1 else read_prose(said),
        convergence_order=order,
        proof=None if not proof.symplectic else proof,
    )


def _rounded_order(made: CanonicalMap) -> int:
    """Up to which power of h it agrees with the exact flow, but for residues of rounding."""
    series = series_of(made, _MOST + 1)

    def compared(n: int) -> Sequence[Compared]:
        field, state = series._reached(n)
        pairs = zip(state, field.term(n), strict=True)
        return [(x.coefficients[n], y, field.ring.reduce(x.coefficients[n] - y)) for x, y in pairs]

    order = agreement(map(compared, range(_MOST + 1))).order
    return _MOST if order is None else order


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
    if sum(size[root.number] for root in trace.roots) > _MOST_WRITTEN:
        raise StepError(f"written out it has more than {_MOST_WRITTEN} operations")
    made = expressions(nodes, {})
    exact = [checked(made[root.number], "map", "its closed form") for root in trace.roots]
    return embed(exact, names, _MOST_TERMS)
