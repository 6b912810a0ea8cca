"""From a user's map, called with symbols, to what is proved of it."""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.limits import checked
from verify.algebra.requirement import Requirement, of_divisor, of_function, of_power
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.exact import text
from verify.functions import by_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Finding
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.step_map import traced_map
from verify.integrators.tracing.trace import Node, Tape, written
from verify.integrators.user_code.step import StepError, lifted
from verify.integrators.user_code.user_map import UserMap
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import prove
from verify.prose import Prose, prose, read_prose
from verify.schemes.maps import closed_form
from verify.verdict import Verdict

_MOST_OF_MAP = 4000  # operations of which a closed form is tried
_MOST_TERMS = 2000
_MOST_INSIDE = 100  # operations of what is divided by, or of which a root is taken
_NOT_WRITTEN = "the function divides by no 0, and takes no root or logarithm of what is negative"


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


def _notes(tape: Tape) -> list[Prose]:
    """What the floats in a user's code were read as, and what else was taken for granted."""
    notes = [prose("h > 0 is taken for granted")] if tape.positive else []
    if tape.readings:
        shown = ", ".join(f"`{x!r}` as `{text(v)}`" for x, v in sorted(tape.readings.items()))
        told = f"floats are read as the exact numbers that they are written for: {shown}"
        notes.append(read_prose(told))
    if tape.rounded:
        shown = ", ".join(f"`{x!r}`" for x in sorted(tape.rounded))
        notes.append(read_prose(f"floats taken by their exact binary values: {shown}"))
    return notes


# -- a step for an H ------------------------------------------------------------------------------


def proved_step(trace: Trace, hamiltonian: Hamiltonian) -> Finding:
    """By the prover for one H. Raises InputError where it has no series and no closed form."""
    traced = traced_map(hamiltonian, trace.roots)
    proof = prove(traced.step_map)
    said, more = "traced with symbols", dict[str, Any]()
    if proof.planar:  # of which alone closed forms and a bound of the order are told
        said, power = f"{said}; the map {traced.how}", proof.first.power
        more = {"area_at_least": power or MOST_ORDERS + 1, "delta_j": proof.step_map.delta_j_text}
    return Finding(
        proof.verdict,
        proof.reason,
        "proof",
        proof.degrees,
        order=proof.order,
        proof=proof,
        symplectic=proof.symplectic,
        area_preserving=proof.area_preserving,
        leading=proof.leading_text,
        convergence_order=proof.convergence_order,
        order_decided=proof.convergence_decided,
        domain=(proof.domain & domain_of(trace.tape)).texts,
        notes=(prose(said), *_notes(trace.tape)),
        entry=proof.entry,
        **more,
    )


# -- a map without an H ---------------------------------------------------------------------------


def proved_of_map(trace: Trace, names: tuple[str, ...]) -> Finding:
    """Whether S vanishes, decided by exact algebra. Raises StepError where it is too long."""
    ring, closed = _closed(trace, names)
    form = closed_form.defect_of(ring, names, closed)
    decision, place = form.decide()
    where = domain_of(trace.tape)
    base = Finding(
        Verdict.UNDECIDED, prose("whether S vanishes is not decided"), "proof", len(names) // 2,
        domain=where.texts, notes=(prose("traced with symbols"), *_notes(trace.tape)),
    )  # fmt: skip
    if decision.zero is True:
        said = prose("S is the zero form: the map is symplectic")
        reason = prose(said, ", where ", where.prose) if where else said
        return replace(
            base, verdict=Verdict.PROVED, reason=reason, symplectic=True, area_preserving=True
        )
    if decision.zero is None or place is None:
        return base
    rows = [[ring.diff(x, name) for name in names] for x in closed]
    volume = closed_form.preserves_volume(ring, rows)
    return replace(
        base,
        verdict=Verdict.REFUTED,
        symplectic=False,
        area_preserving=volume,
        entry=form.called(place),
    )


def _closed(trace: Trace, names: tuple[str, ...]) -> tuple[Ring, list[Poly]]:
    """The map as elements of a ring."""
    exact = written(trace.roots, _MOST_OF_MAP)
    if exact is None:
        raise StepError(f"written out it has more than {_MOST_OF_MAP} operations")
    return embed([checked(x, "map", "its closed form") for x in exact], names, _MOST_TERMS)


# -- where it is defined --------------------------------------------------------------------------


def domain_of(tape: Tape) -> Domain:
    """What all operations on the tape ask for, those that cancelled in the end, too."""
    found, words = list[Requirement](), list[str]()
    if tape.positive:
        found.append(Requirement(symbol("h"), ">"))
    for node in tape.nodes:
        operand = node.inputs[-1] if node.inputs else None
        if operand is None or not _asks(node):
            continue
        inside = written([operand], _MOST_INSIDE)
        if inside is None:
            words.append(_NOT_WRITTEN)
        else:
            found += _asked(node, inside[0])
    return Domain.of(found, *words) if found or words else EVERYWHERE


def _asks(node: Node) -> bool:
    power = node.operation == "power" and (node.value < 0 or node.value.denominator > 1)
    function = by_name().get(node.operation)
    return power or node.operation == "divide" or bool(function and function.domain)


def _asked(node: Node, operand: sympy.Expr) -> list[Requirement]:
    """Of a smooth map: no root is taken of 0."""
    match node.operation:
        case "divide":
            return of_divisor(operand)
        case "power" | "sqrt":
            exponent = sympy.Rational(node.value or Fraction(1, 2))
            asked = of_power(operand, exponent)
            return [Requirement(r.expression, ">") if exponent.q > 1 else r for r in asked]
        case name:
            return of_function(name, operand)
