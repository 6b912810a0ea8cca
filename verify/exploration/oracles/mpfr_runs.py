"""Short runs in 60 digits, of a sample or of another H with its scheme, step and t₀: for steps that
solve equations, which balls do not.

A kernel finds the derivatives of such a step by solving other equations; here the Jacobian of a run
is made of central differences of runs in more digits.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import Matrix
from verify.exploration.property import Violation, only_if
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun

DIGITS = 60
STEPS = 2
_KNOWN = Fraction(1, 10**30)
_FAR = 10**6

_DIGITS_OF_DIFFERENCES, _BITS = 160, 700
_APART = Fraction(1, 10**50)  # the derivatives' error is its square, times the third derivatives
_DERIVATIVES_KNOWN = Fraction(1, 10**70)


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


def jacobian_of_run(sample: SampleInDegrees) -> tuple[Matrix, Ball]:
    """J of two steps, and what S of it may be where the map is symplectic: the error of J times its
    size, squared as that grows with the derivatives; Silent where an end is not known."""
    columns = []
    for name, x in sample.point.items():
        ends = [
            RunInDegrees(sample.hamiltonian, {**sample.point, name: x + by}, sample).values(
                digits=_DIGITS_OF_DIFFERENCES
            )
            for by in (_APART, -_APART)
        ]
        up, down = ([end[n] for n in sample.point] for end in ends)
        columns.append([(a - b) / (2 * _APART) for a, b in zip(up, down, strict=True)])
    size = 1 + max(abs(x) for column in columns for x in column)
    with working_precision(_BITS):
        found = Matrix([[rational_ball(x) for x in row] for row in zip(*columns, strict=True)])
        return found, rational_ball(_DERIVATIVES_KNOWN * size**4)
