"""Whether a traced step is a composition of shears, p ↦ p + f(q) or q ↦ q + g(p), each of det 1."""

from verify.hamiltonian import Hamiltonian
from verify.step_map import Substep
from verify.trace import Node


def shears_of(
    hamiltonian: Hamiltonian, p_next: Node, q_next: Node
) -> tuple[Substep, ...] | None:
    return None
