"""Compositions of the two shears of H = T(p) + V(q): kicks p − a h V'(q), drifts q + a h T'(p)."""

from collections.abc import Sequence

import sympy

from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.step_map import StepMap, Substep


def shears(
    hamiltonian: Hamiltonian, scheme: str, parts: Sequence[tuple[str, sympy.Expr]]
) -> StepMap:
    """The map that kicks and drifts by these parts of h in turn, `scheme` being its name.

    Raises InputError unless H = T(p) + V(q).
    """
    field, sizes = hamiltonian.field(*(size for _, size in parts))
    ring = field.ring
    if not field.separable():
        raise InputError(
            "hamiltonian",
            str(hamiltonian.expression),
            f"{scheme} is explicit only for H = T(p) + V(q)",
        )
    p, q, h = (ring.variable(name) for name in ("p", "q", "h"))
    steps = []
    for (kind, _), size in zip(parts, sizes, strict=True):
        kicked, drifted = p - size * h * field.h_q, q + size * h * field.h_p
        step = Substep(field, kicked, q) if kind == "kick" else Substep(field, p, drifted)
        steps.append(step)
    return StepMap(hamiltonian, tuple(steps))
