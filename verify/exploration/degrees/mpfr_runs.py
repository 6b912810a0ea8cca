"""Short runs in 60 digits, of a sample or of another H with its scheme, step and t₀: for steps that
solve equations, which balls do not."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal
from verify.exploration.property import Violation, only_if
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun

DIGITS = 60
STEPS = 2
_KNOWN = Fraction(1, 10**30)
_FAR = 10**6


@dataclass(frozen=True)
class RunInDegrees:
    """Two steps of the sample's scheme for an H, from a point by the names of its coordinates."""

    hamiltonian: Hamiltonian
    point: Mapping[str, Fraction]
    sample: SampleInDegrees

    @classmethod
    def of(cls, sample: SampleInDegrees) -> "RunInDegrees":
        """The sample's own."""
        return cls(sample.hamiltonian, sample.point, sample)

    @property
    def end(self) -> dict[str, Fraction]:
        """Where it ends; Silent where it leaves the range in which digits are kept."""
        found = self.values()
        return {name: found[name] for name in self.point}

    def values(self, *observables: str, digits: int = DIGITS) -> Mapping[str, Fraction]:
        """The coordinates and these observables at the end; Silent as `end`."""
        sample, start = self.sample, {**self.point, "h": self.sample.step_size}
        if self.hamiltonian.time_dependent:
            start["t"] = sample.t0
        run = KernelRun(
            self.hamiltonian, sample.scheme.name, start, STEPS, frozenset(observables), 0
        )
        found = run.run(number_systems.get("mpfr", digits))
        only_if(found.done == STEPS)
        only_if(all(abs(found.values[name]) <= _FAR for name in self.point))
        return found.values


def must_agree(
    found: Mapping[str, Fraction], wanted: Mapping[str, Fraction], size: Fraction
) -> None:
    """Violation where a number is not what is wanted, to 30 digits of 1 or of `size`."""
    for name, x in found.items():
        if abs(x - wanted[name]) > _KNOWN * (size + abs(wanted[name])):
            told = f"{decimal(x, 12)}, and should be {decimal(wanted[name], 12)}"
            raise Violation(f"{name} is {told}")
