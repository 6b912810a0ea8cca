"""Whether a run has left where H is defined: a scheme may step over a pole, or beyond it.

Störmer-Verlet of log(q) evaluates 1/q, which is defined for q < 0 as well; no solution goes there.
What is looked at are the states that the run has noted, so that what lies between two of them is
not seen.
"""

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, Outcome

_MOST = 64  # states that are looked at


def left_domain(hamiltonian: Hamiltonian, run: KernelRun, outcome: Outcome) -> str:
    """By which step it has, and what then no longer holds; empty where none is seen to."""
    domain, start, count = hamiltonian.domain, run.start, len(outcome.trail)
    if not domain.requirements or not count:
        return ""
    signs = domain.signs(start)
    for k in _looked_at(count):
        done = min(k * run.section, run.steps)
        note = outcome.trail[k - 1]
        state = {name: note[name] for name in hamiltonian.coordinates}
        left = domain.left_since(signs, {**state, "t": start["t"] + done * start["h"]})
        if left:
            return f"by step {done} the orbit has left where H is defined: {', '.join(left)}"
    return ""


def _looked_at(count: int) -> list[int]:
    """The numbers of some notes, the last among them."""
    return sorted({-(-count * k // _MOST) for k in range(1, _MOST + 1)})
