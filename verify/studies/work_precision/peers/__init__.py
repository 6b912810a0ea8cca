"""Other people's integrators, for the same error and the same clock; one file each.

A peer is prepared to solve one problem to one tolerance. Its file defines `NAME`, `LIBRARY`, the
package that it needs and imports only where it is used, `TOLERANCES`, and
`make(problem, tolerance)`, which returns a `Solver`. Adding a peer is adding one file.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from types import ModuleType

from verify.discovery import Catalogue
from verify.hamiltonians.hamiltonian import Hamiltonian

_FILES = Catalogue(__name__, __path__)


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


@cache
def _modules() -> dict[str, ModuleType]:
    modules = (_FILES.module(file) for file in _FILES.names)
    return {module.NAME: module for module in modules}


def libraries() -> dict[str, str]:
    """Return the package that each peer needs, by the peer's name."""
    return {name: module.LIBRARY for name, module in _modules().items()}


def get(name: str) -> ModuleType:
    """Return the module of the peer of that name."""
    return _modules()[name]
