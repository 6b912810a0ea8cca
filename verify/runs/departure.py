"""The departure of a run from the domain of H, by a step over a pole or past an end of the domain.

Störmer–Verlet of log(q) evaluates 1/q, which is defined for q < 0 as well; no solution goes there.
At most 64 of the states that the run has noted are checked, so that a departure between two of them
is not seen.
"""

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, RunOutcome

_CHECKED_STATES = 64  # a run's noted states that are checked against H's domain, at most


def describe_departure(hamiltonian: Hamiltonian, run: KernelRun, outcome: RunOutcome) -> str:
    """Describe by which step a run has left H's domain, and which conditions no longer hold.

    The text is empty if no checked state is outside the domain.
    """
    domain, start, count = hamiltonian.domain, run.start, len(outcome.trail)
    if not domain.requirements or not count:
        return ""
    signs = domain.signs(run.in_user_names(start))
    for k in _select_notes(count):
        done = min(k * run.section, run.steps)
        note = outcome.trail[k - 1]
        state = run.in_user_names({name: note[name] for name in run.coordinates})
        violations = domain.left_since(signs, {**state, "t": start["t"] + done * start["h"]})
        if violations:
            return f"by step {done} the orbit has left where H is defined: {', '.join(violations)}"
    return ""


def _select_notes(count: int) -> list[int]:
    """Select the numbers, from 1, of at most 64 notes, evenly spaced, the last among them."""
    return sorted({-(-count * k // _CHECKED_STATES) for k in range(1, _CHECKED_STATES + 1)})
