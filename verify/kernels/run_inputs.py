"""What is run in a kernel, apart from the arithmetic that it is run in."""

from copy import copy
from fractions import Fraction
from functools import lru_cache
from typing import Self

from verify.arithmetic.number_system import Arithmetic
from verify.errors import InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel
from verify.kernels.step.in_degrees import map_of
from verify.kernels.turns import Times, Turns, turns_of

SECTIONS = 16  # notes of a run, where nothing is said


def _compilable(hamiltonian: Hamiltonian, scheme: str) -> Hamiltonian:
    """H with its parameters as the kernel's arguments, where the scheme takes it so.

    A scheme may take H for the given values only, as symplectic Euler does (a − 1) p q + … at
    a = 1; then the values are put in.
    """
    generic = hamiltonian.with_symbols()
    return generic if _takes(generic, scheme) else Hamiltonian(hamiltonian.exact)


@lru_cache(maxsize=256)
def _takes(hamiltonian: Hamiltonian, scheme: str) -> bool:
    try:
        map_of(hamiltonian, scheme)
    except InputError:
        return False
    return True


class RunInputs:
    """H, a scheme, where it starts, so many steps, and what is asked of them.

    `start` has p, q, the step size h, and the time t where H depends on it.

    The state is noted `points` times on the way where a series is kept, else `sections` times.
    `shares_kernel`: so many other runs are done with the same kernel that it repays being compiled.
    """

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        start: dict[str, Fraction],
        steps: int,
        observables: frozenset[str],
        points: int,
        keeper: Keeper = NOTHING,
        sections: int = SECTIONS,
        shares_kernel: bool = False,
    ) -> None:
        self.hamiltonian, self.scheme = _compilable(hamiltonian, scheme), scheme
        self._given = hamiltonian
        self.parameters, self.start = dict(hamiltonian.values), start
        self.steps, self.observables, self.points = steps, observables, points
        self.sections = points or sections
        self.keeper, self.shares_kernel = keeper, shares_kernel

    @property
    def section(self) -> int:
        """Steps between two notes."""
        return -(-self.steps // self.sections)

    @property
    def implicit(self) -> bool:
        """Whether a step solves equations; there is no certificate of such runs."""
        return map_of(self.hamiltonian, self.scheme).implicit

    def observing(self, observables: frozenset[str]) -> Self:
        """The same run with other observables, and without a series."""
        other = copy(self)
        other.observables, other.points = observables, 0
        other.sections = SECTIONS
        return other

    def inputs(self, kernel: Kernel, shift: int) -> dict[str, Fraction]:
        """h, the parameters and the scales by the names that the kernel's source has for them."""
        h = self.start["h"]
        named = {f"x{k}": self.parameters[n] for k, n in enumerate(kernel.parameters)}
        scales = {"kappa": 2**shift * h**kernel.power, "down": Fraction(1, 2**shift)}
        return {"h": h, **named, **(scales if kernel.scales else {})}

    def turns(self, arithmetic: Arithmetic) -> Turns | None:
        """What is taken off t in this arithmetic, if anything is."""
        if not (arithmetic.absolute and self.hamiltonian.time_dependent):
            return None
        return turns_of(self._given, self._all_times(), self.start["h"])

    def times(self, arithmetic: Arithmetic) -> Times | None:
        """The first and the last time at which a step is made in this arithmetic; None where H does
        not depend on it."""
        if not self.hamiltonian.time_dependent:
            return None
        turns = self.turns(arithmetic)
        return turns.times if turns else self._all_times()

    def _all_times(self) -> Times:
        first = self.start["t"]
        return first, first + self.steps * self.start["h"]
