"""A bound of the distance of a computed orbit from the exact one; see `a_posteriori_bound`.

The tangent map M may begin anew at each note of the run, as it must where the flow contracts: there
one that begins at the start is soon singular to float64. The bound at the end of a section is then
the error with which the next one begins.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.rounding import PRECISION_BITS, Ball
from verify.kernels.step.tangent_map import entries_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs import matrix_growth
from verify.runs.step_bounds import StepDerivatives, StepErrors, StepRounding, norm


def linear_error(
    run: KernelRun, arithmetic: Arithmetic, outcome: RunOutcome, note: int = -1
) -> Ball | None:
    """Return the bound of an orbit's error without its quadratic term; None if there is none."""
    with working_precision(PRECISION_BITS):
        orbit = OrbitBound(run, arithmetic, outcome, note)
        rounded = orbit.rounding.errors()
        if rounded is None:
            return None
        orbit.rounded = rounded
        if orbit.sections is None:
            return None
        return matrix_growth.follow(orbit.sections, orbit.first_error(), rounded.state)[0]


class OrbitBound:
    """The quantities that bound an orbit, up to the checkpoint of index `note`."""

    rounded: StepErrors
    derivatives: StepDerivatives

    def __init__(
        self, run: KernelRun, arithmetic: Arithmetic, outcome: RunOutcome, note: int
    ) -> None:
        self.run, self.arithmetic, self.values = run, arithmetic, outcome.trail[note]
        self.rounding = StepRounding(run, arithmetic, outcome, note)
        self.steps, self.records = self.rounding.steps, self.rounding.records
        self.notes = self.rounding.notes
        self.noted: Mapping[str, Fraction] = self.notes[-1]
        self.names, self.unit = self.rounding.names, self.rounding.unit
        self.scale = flint.arb(2) ** -outcome.shift

    @cached_property
    def sections(self) -> list[matrix_growth.MatrixGrowth] | None:
        """The growth of M along each section; None if no bound follows from it."""
        size, rounding = len(self.names), self.rounded.tangent
        done, sections = 0, list[matrix_growth.MatrixGrowth]()
        for records in self.notes:
            steps = int(records["done"]) - done
            numbers = {name: rational_ball(x) for name, x in records.items()}
            last = [numbers[name] for name in entries_of(self.names) if name in numbers]
            growth = matrix_growth.growth_of(size, numbers, steps, rounding, last)
            if growth is None:
                return None
            done += steps
            sections.append(growth)
        return sections

    @property
    def motion(self) -> matrix_growth.MatrixGrowth | None:
        """The growth of M along the whole run; None if it began anew."""
        return self.sections[0] if self.sections and not self.run.restarts else None

    def orbit(self) -> tuple[Ball, Ball] | None:
        """Return a bound of ‖e_k‖ for all k, and one of Σ ‖e_k‖."""
        sections, first, rounding = self.sections, self.first_error(), self.rounded.state
        if sections is None:
            return None
        # B is taken over the box widened by E*, twice the error without the quadratic term; where M
        # begins anew the terms of all sections before add to it.
        room = 4 if self.run.restarts else 2
        width = room * matrix_growth.follow(sections, first, rounding)[0]
        second = self.derivatives.second(self.rounding.constants(), self.rounding.box(width))
        top, total = matrix_growth.follow(sections, first, rounding, second)
        # All E* are at most 2 `top`, and B holds up to `width`.
        return (top, total) if room * top <= 2 * width else None

    def first_error(self) -> Ball:
        """Return ‖e_0‖, the rounding of the initial values, and how far these may be off."""
        start, number, to_fraction = self.run.start, self.arithmetic.number, self.arithmetic.exact
        lost = [rational_ball(to_fraction(number(start[n])) - start[n]) for n in self.names]
        radii = (rational_ball(x) for x in self.run.start_radii.values())
        return norm(lost) + norm(radii)
