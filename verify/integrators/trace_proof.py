"""Proofs about a user's map that is called with symbols."""

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
from verify.functions import by_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Finding
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.trace import Node, Tape, write_expressions
from verify.integrators.tracing.traced_map import traced_map
from verify.integrators.user_code.step import StepError, lift_numbers
from verify.integrators.user_code.user_map import UserMap
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order_for_one_h import prove
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
    """Call the step with symbols. Raises what the user's code raises of them, UntraceableError and
    StepError."""
    tape = Tape()
    symbols = [tape.symbol(name) for name in step.names]
    # Where H does not depend on time, t is the number 0, so that a clock that the code computes
    # folds away.
    clock = tape.symbol("t") if step.moving else tape.rational(Fraction(0))
    size = tape.symbol("h")
    result = step.call(copy_function(step.function, tape), symbols, size, clock, tape.rational)
    tape.check()
    return Trace(tape, tuple(x.node for x in lift_numbers(symbols[0], result)))


def _notes(tape: Tape) -> list[Prose]:
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
    """Prove the step by the prover for one H. Raises InputError where it has no series and no
    closed form."""
    traced = traced_map(hamiltonian, trace.roots)
    proof = prove(traced.step_map)
    text, fields = "traced with symbols", dict[str, Any]()
    if proof.planar:  # closed forms and a bound of the order are reported in the plane alone
        text, power = f"{text}; the map {traced.how}", proof.first.power
        fields = {"area_at_least": power or MOST_ORDERS + 1, "delta_j": proof.step_map.delta_j_text}
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
        notes=(prose(text), *_notes(trace.tape)),
        entry=proof.entry,
        **fields,
    )


# -- a map without an H ---------------------------------------------------------------------------


def prove_map(trace: Trace, names: tuple[str, ...]) -> Finding:
    """Decide by exact algebra if S vanishes. Raises StepError where the map is too long."""
    ring, closed = _embed_closed_form(trace, names)
    form = closed_form.defect_of(ring, names, closed)
    decision, place = form.decide()
    domain = domain_of(trace.tape)
    base = Finding(
        Verdict.UNDECIDED, prose("whether S vanishes is not decided"), "proof", len(names) // 2,
        domain=domain.texts, notes=(prose("traced with symbols"), *_notes(trace.tape)),
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


def _embed_closed_form(trace: Trace, names: tuple[str, ...]) -> tuple[Ring, list[Poly]]:
    """Return the map as elements of a ring."""
    forms = write_expressions(trace.roots, _MOST_OF_MAP)
    if forms is None:
        raise StepError(f"written out it has more than {_MOST_OF_MAP} operations")
    return embed([check_expression(x, "map", "its closed form") for x in forms], names, _MOST_TERMS)


# -- where it is defined --------------------------------------------------------------------------


def domain_of(tape: Tape) -> FormulaDomain:
    """Collect the requirements of all operations on the tape, also of those that cancel in the
    end."""
    requirements, words = list[Requirement](), list[str]()
    if tape.positive:
        requirements.append(Requirement(symbol("h"), ">"))
    for node in tape.nodes:
        operand = node.inputs[-1] if node.inputs else None
        if operand is None or not _asks(node):
            continue
        inner = write_expressions([operand], _MOST_INSIDE)
        if inner is None:
            words.append(_NOT_WRITTEN)
        else:
            requirements += _requirements_of(node, inner[0])
    return (
        FormulaDomain.from_requirements(requirements, *words)
        if requirements or words
        else EVERYWHERE
    )


def _asks(node: Node) -> bool:
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
