"""Proofs about a user's map that is called with symbols.

A call with symbols writes the operations of the code on a tape: the trace of the map.
"""

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.expressions.function_nodes import (
    Requirement,
    requirements_of_divisor,
    requirements_of_function,
    requirements_of_power,
)
from verify.algebra.formula import symbol
from verify.algebra.limits import check_expression
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.exact import text
from verify.effort import MAX_CALLS, answer_unless_long
from verify.functions import by_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Finding
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.trace import Node, Tape, write_expressions
from verify.integrators.tracing.traced_map import traced_map
from verify.integrators.user_code.step import StepError, lift_numbers
from verify.integrators.user_code.user_map import UserMap
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order_for_one_h import convergence_of_scheme, prove
from verify.prose import Prose, prose, read_prose
from verify.schemes.maps import closed_form
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

# Operations of a map without an H, written out as trees, up to which a closed form is tried.
_MAX_MAP_OPERATIONS = 4000
_MAX_TERMS = 2000  # of an element of the ring
_MAX_OPERAND_OPERATIONS = 100  # of a divisor or of the operand of a root, for the stated domain
_UNWRITTEN_DOMAIN = (
    "the function divides by no 0, and takes no root or logarithm of what is negative"
)


@dataclass(frozen=True)
class Trace:
    """The operations of a map on symbols: `outputs` are the nodes of p' and then q' on the tape."""

    tape: Tape
    outputs: tuple[Node, ...]


def trace_of(step: UserMap) -> Trace:
    """Call the step with symbols, and return the trace.

    Raises UntraceableError, StepError, and what the user's code raises when it meets symbols.
    """
    tape = Tape()
    symbols = [tape.symbol(name) for name in step.names]
    # Where H does not depend on time, t is the number 0, so that a clock that the code computes
    # folds away.
    clock = tape.symbol("t") if step.time_dependent else tape.rational(Fraction(0))
    size = tape.symbol("h")
    result = step.call(copy_function(step.function, tape), symbols, size, clock, tape.rational)
    tape.check()
    return Trace(tape, tuple(x.node for x in lift_numbers(symbols[0], result)))


def notes_of(tape: Tape) -> list[Prose]:
    """Return notes on how the floats in a user's code were read, and on other assumptions."""
    notes = [prose("h > 0 is taken for granted")] if tape.positive else []
    if tape.readings:
        pairs = ", ".join(f"`{x!r}` as `{text(v)}`" for x, v in sorted(tape.readings.items()))
        sentence = f"floats are read as the exact numbers that they are written for: {pairs}"
        notes.append(read_prose(sentence))
    if tape.rounded:
        pairs = ", ".join(f"`{x!r}`" for x in sorted(tape.rounded))
        notes.append(read_prose(f"floats taken by their exact binary values: {pairs}"))
    return notes


# -- a step for an H ------------------------------------------------------------------------------


def prove_step(trace: Trace, hamiltonian: Hamiltonian) -> Finding:
    """Prove the step by the prover for one H.

    Raises InputError if the step has neither a series in h nor a closed form.
    """
    traced = traced_map(hamiltonian, trace.outputs)
    proof = prove(traced.step_map)
    text, fields = "traced with symbols", dict[str, Any]()
    if proof.planar:  # closed forms and a bound of the order are reported in the plane alone
        text, power = f"{text}; the map {traced.how}", proof.first.power
        # That of many iterations is a formula of a million characters.
        delta_j = answer_unless_long(lambda: proof.step_map.delta_j_text, None, MAX_CALLS)
        fields = {"area_at_least": power or MOST_ORDERS + 1, "delta_j": delta_j}
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
        notes=(prose(text), *notes_of(trace.tape)),
        entry=proof.entry,
        **fields,
    )


def order_of(step_map: StepMap, trace: Trace) -> int | None:
    """Return the order of a traced step; None where that is open, as with rounded numbers."""
    convergence = convergence_of_scheme(step_map, None)[0]
    return convergence.order if convergence.decided and not trace.tape.rounded else None


def prove_order(trace: Trace, system: Hamiltonian) -> Finding:
    """Prove the order of a step for equations without an H. Raises StepError if that is open."""
    step_map = traced_map(system, trace.outputs).step_map
    order = order_of(step_map, trace)
    if order is None:
        raise StepError("its order is not decided")
    lead = "" if order else "not a scheme for these equations: "
    return Finding(
        Verdict.PROVED if order else Verdict.REFUTED,
        read_prose(f"{lead}the map agrees with the exact flow up to `h^{order}`"),
        "proof", len(system.coordinates) // 2, convergence_order=order, order_decided=True,
        domain=(step_map.domain & domain_of(trace.tape)).texts, notes=tuple(notes_of(trace.tape)),
    )  # fmt: skip


# -- a map without an H ---------------------------------------------------------------------------


def prove_map(trace: Trace, names: tuple[str, ...]) -> Finding:
    """Decide by exact algebra if S = JᵀΩJ − Ω vanishes. Raises StepError if the map is too long."""
    ring, closed = embed_closed_form(trace, names)
    form = closed_form.defect_of(ring, names, closed)
    decision, place = form.decide()
    domain = domain_of(trace.tape)
    base = Finding(
        Verdict.UNDECIDED, prose("whether S vanishes is not decided"), "proof", len(names) // 2,
        domain=domain.texts, notes=(prose("traced with symbols"), *notes_of(trace.tape)),
    )  # fmt: skip
    if decision.zero is True:
        text = prose("S is the zero form: the map is symplectic")
        reason = prose(text, ", where ", domain.prose) if domain else text
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
        entry=form.entry_name(place),
    )


def embed_closed_form(trace: Trace, names: tuple[str, ...]) -> tuple[Ring, list[Poly]]:
    """Return the map as elements of a ring."""
    forms = write_expressions(trace.outputs, _MAX_MAP_OPERATIONS)
    if forms is None:
        raise StepError(f"written out it has more than {_MAX_MAP_OPERATIONS} operations")
    return embed([check_expression(x, "map", "its closed form") for x in forms], names, _MAX_TERMS)


# -- where it is defined --------------------------------------------------------------------------


def domain_of(tape: Tape) -> FormulaDomain:
    """Collect the requirements of all operations on the tape, also of those that cancel later."""
    requirements, words = list[Requirement](), list[str]()
    if tape.positive:
        requirements.append(Requirement(symbol("h"), ">"))
    for node in tape.nodes:
        operand = node.inputs[-1] if node.inputs else None
        if operand is None or not _has_requirement(node):
            continue
        inner = write_expressions([operand], _MAX_OPERAND_OPERATIONS)
        if inner is None:
            words.append(_UNWRITTEN_DOMAIN)
        else:
            requirements += _requirements_of(node, inner[0])
    return (
        FormulaDomain.from_requirements(requirements, *words)
        if requirements or words
        else EVERYWHERE
    )


def _has_requirement(node: Node) -> bool:
    power = node.operation == "power" and (node.value < 0 or node.value.denominator > 1)
    function = by_name().get(node.operation)
    return power or node.operation == "divide" or bool(function and function.domain)


def _requirements_of(node: Node, operand: sympy.Expr) -> list[Requirement]:
    """Return the requirements of a node of a smooth map: no root is taken of 0."""
    match node.operation:
        case "divide":
            return requirements_of_divisor(operand)
        case "power" | "sqrt":
            exponent = sympy.Rational(node.value or Fraction(1, 2))
            requirements = requirements_of_power(operand, exponent)
            return [Requirement(r.expression, ">") if exponent.q > 1 else r for r in requirements]
        case name:
            return requirements_of_function(name, operand)
