"""Proofs of what a traced step or map keeps; they stand before every measurement.

A trace with rounded coefficients refutes nothing: the rounding may be the cause. Where the code has
relied on h > 0, its steps of −h are not those of the trace.
"""

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import TypeVar

import sympy

from verify.algebra.domain import FormulaDomain
from verify.algebra.expressions.function_nodes import requirements_of_expression
from verify.hamiltonians.canonical_field import PlainField
from verify.hamiltonians.equations import Equations
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.kept_structures import from_proof
from verify.integrators.results import KeptStructure
from verify.integrators.trace_proof import Trace, domain_of, embed_closed_form, order_of
from verify.integrators.tracing.traced_map import traced_map
from verify.integrators.user_code.step import limit_time
from verify.proof.structures.structure_order import prove_structure
from verify.proof.structures.structure_values import closed_values
from verify.prose import read_prose
from verify.schemes.maps.step_map import StepMap
from verify.structures.reading import ClaimedStructure
from verify.structures.symmetric import Symmetric
from verify.verdict import Verdict

T = TypeVar("T")
Proofs = list[KeptStructure | None]  # None where algebra decides nothing


def prove_step(
    trace: Trace, system: Hamiltonian, claims: Sequence[ClaimedStructure], seconds: float
) -> tuple[Proofs, int | None]:
    """Return the proofs for a step of the system, and the order of the map if it is known.

    `seconds`: for all proofs. Raises InputError if the step has no series and no closed form.
    """
    time_left = _TimeLeft(seconds)
    tape = trace.tape
    # An iteration that is traced may be too long to be written out, however short its trace.
    with limit_time(seconds / 2, "its formulas take too long"):
        step_map, domain = traced_map(system, trace.outputs).step_map, domain_of(tape)

    def prove(claim: ClaimedStructure) -> KeptStructure | None:
        if tape.positive and isinstance(claim.structure, Symmetric):
            return None
        proof = prove_structure(step_map, claim.structure, None, claim.order)
        if proof.verdict is Verdict.UNDECIDED or (tape.rounded and not proof.verdict.holds):
            return None
        return from_proof(proof, domain)

    order = time_left.limit(lambda: order_of(step_map, trace))
    return [time_left.limit(partial(prove, claim)) for claim in claims], order


def prove_map(
    trace: Trace, names: tuple[str, ...], claims: Sequence[ClaimedStructure], seconds: float
) -> Proofs:
    """Return the proofs for a map without an H. Raises StepError if it is too long."""
    with limit_time(seconds / 2, "its formulas take too long"):
        ring, elements = embed_closed_form(trace, names)
    # A step of the system at rest, so that nothing is asked of a flow.
    still = Equations(sympy.Tuple(*[0] * len(names)), names=names)
    field = PlainField(ring, names, [ring.zero] * len(names))
    step_map = StepMap(still, field, formulas=tuple(elements))
    domain = domain_of(trace.tape)
    time_left = _TimeLeft(seconds)
    return [time_left.limit(partial(_prove_of_map, step_map, x, domain)) for x in claims]


def _prove_of_map(
    step_map: StepMap, claim: ClaimedStructure, domain: FormulaDomain
) -> KeptStructure | None:
    """Return the proof that a map keeps the structure; None if it is not shown."""
    values = closed_values(step_map, claim.structure)
    if values is None:
        return None
    components = claim.structure.defect(values).values()
    if not all(values.ring.vanishes(values.ring.reduce(x.value)) is True for x in components):
        return None
    smooth = FormulaDomain.from_requirements(
        r for x in claim.structure.formulas for r in requirements_of_expression(x, smooth=True)
    )
    reason = read_prose(f"`{claim.structure.defect_formula}` is 0 at every point")
    return KeptStructure(
        claim.structure, Verdict.PROVED, reason, "proof", exact=True, domain=domain & smooth
    )


class _TimeLeft:
    """The time for several proofs, of which each may take half of what is left."""

    def __init__(self, seconds: float) -> None:
        self.until = time.monotonic() + seconds

    def limit(self, proof: Callable[[], T]) -> T | None:
        """Return the result of a proof; None if it fails or does not end in time."""
        seconds = max(self.until - time.monotonic(), 0.0) / 2
        with suppress(Exception), limit_time(seconds, "its proof takes too long"):
            return proof()
        return None
