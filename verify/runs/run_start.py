"""The inputs of a run: the scheme with its H, and the initial state."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import text
from verify.hamiltonians.equations import read_system
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import coordinate_texts, start_of
from verify.scenes.results.run import RunResult


@dataclass(frozen=True)
class Start:
    """A scheme with its H, its step size and its initial values.

    `point` has each coordinate by its name; t0 is the initial time if H depends on time.
    """

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    point: Mapping[str, Fraction]
    t0: Fraction

    @classmethod
    def from_result(cls, result: RunResult) -> "Start":
        """Return the start of a finished run."""
        hamiltonian = read_system(result.hamiltonian, result.parameters)
        q, p = (result.q, result.p) if hamiltonian.has_energy else (None, None)
        point = start_of(hamiltonian, q, p, result.start)
        step_size, t0 = Fraction(result.step_size), Fraction(result.t0)
        return cls(hamiltonian, result.scheme, step_size, point, t0)

    def __hash__(self) -> int:
        point = frozenset(self.point.items())
        return hash((self.hamiltonian, self.scheme, self.step_size, point, self.t0))

    @property
    def run_arguments(self) -> dict[str, Any]:
        """The keyword arguments of a run from this start, without its number of steps."""
        fields = {name: x for name, x in vars(self).items() if name != "point"}
        return {**fields, "q": self.text("q"), "p": self.text("p")}

    @property
    def inputs(self) -> dict[str, Fraction]:
        """The initial values, h and t of a kernel's run, by their names."""
        return {**self.point, "h": self.step_size, "t": self.t0}

    @property
    def texts(self) -> dict[str, str]:
        """The initial values of equations, by name; empty for an H, which has q and p."""
        point = {} if self.hamiltonian.has_energy else self.point
        return {name: text(x) for name, x in point.items()}

    def text(self, letter: str) -> str | tuple[str, ...]:
        """Return q or p as results show it: a number, or a list in n degrees of freedom; an empty
        list for equations."""
        if not self.hamiltonian.has_energy:
            return ()
        return coordinate_texts(self.hamiltonian, self.point, letter)
