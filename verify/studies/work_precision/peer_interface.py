"""The interface of a peer: another integrator, prepared to solve one problem to one tolerance."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian


class PeerError(Exception):
    """A peer that does not take H, or did not reach the end; the message says why."""


@dataclass(frozen=True)
class InitialValueProblem:
    """The problem p' = −H_q, q' = H_p from `point`, at t0 for the length `time`.

    `point`: each coordinate's value by its name, in the order p1 … pn, q1 … qn.
    """

    hamiltonian: Hamiltonian
    point: Mapping[str, Fraction]
    time: Fraction
    t0: Fraction


@dataclass(frozen=True)
class Answer:
    """The coordinates at the end, the steps taken, and evaluations of the field if counted."""

    state: tuple[float, ...]
    steps: int | None
    evaluations: int | None


@dataclass(frozen=True)
class Solver:
    """A prepared peer: `solve` goes from the start to the end, each time anew, or raises PeerError.

    `compile_seconds`: the time of its preparation.
    """

    solve: Callable[[], Answer]
    compile_seconds: float
