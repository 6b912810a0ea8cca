"""The rounding of one step of a run, counted over the box that its orbit has visited.

`verify.runs.a_posteriori` defines the quantities that are counted, ε and ρ among them, and derives
bounds from them; the rules of counting are in `verify.kernels.rounding`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.clock import error_of_time
from verify.kernels.rounding import FLOAT, Ball, Rounded, analyse, rounding_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs import form_bound
from verify.runs.derivatives import norm


@dataclass(frozen=True)
class StepErrors:
    """The rounding of one step: of the state, of D, of the tangent map relative to its size."""

    state: Ball
    delta_j: Ball
    tangent: Ball
    size: Ball  # a bound of |D|
    defect: Ball  # of an entry of S
    values: Mapping[str, Rounded]  # the kernel's outputs


class StepRounding:
    """A count of rounding for the steps up to the checkpoint of index `note`.

    The run must have carried the tangent map.
    """

    def __init__(
        self, run: KernelRun, arithmetic: Arithmetic, outcome: RunOutcome, note: int
    ) -> None:
        assert outcome.kernel is not None  # noqa: S101 - the caller's condition
        self.run, self.arithmetic, self.kernel = run, arithmetic, outcome.kernel
        self.last = outcome.trail[note]
        self.shift = outcome.shift
        self.steps = int(outcome.tangents[note]["done"])
        self.records = {n: rational_ball(x) for n, x in outcome.tangents[note].items()}
        self.h = rational_ball(run.start["h"])
        self.unit = flint.arb(2) ** -arithmetic.bits
        self.names = self.kernel.coordinates

    # -- where the run has been -----------------------------------------------------------------

    def box(self, margin: Ball, *, last: bool = False) -> dict[str, Ball]:
        """Return the states at which a step was made, and with `last` the last one, all widened.

        float64's rounding of the recorded states is within 2^−50.
        """
        around = flint.arb(0, 1)
        intervals = {}
        for n in self.names:
            low, high = self.records[f"{n}_low"], self.records[f"{n}_high"]
            rounding = flint.arb(2) ** -50 * (1 + abs(low) + abs(high))
            intervals[n] = low.union(high) + around * (margin + rounding)
            if last:
                intervals[n] = intervals[n].union(rational_ball(self.last[n]) + around * margin)
        return intervals

    def times(self) -> Ball:
        """Return all times at which a step is made."""
        turns = self.run.turns(self.arithmetic)
        if turns:
            first, last = map(rational_ball, turns.times)
            return first.union(last)
        start = rational_ball(self.run.start.get("t", Fraction(0)))
        return start.union(start + self.steps * self.h)

    def constants(self) -> dict[str, Ball]:
        """Return h, the parameters, and all times if the kernel has a clock."""
        parameters = {n: rational_ball(x) for n, x in self.run.parameters.items()}
        time = {"t": self.times()} if self.kernel.timed else {}
        return {"h": self.h, **parameters, **time}

    # -- the rounding of a step -----------------------------------------------------------------

    def errors(self) -> StepErrors | None:
        """Return the rounding of one step; None where this kernel or arithmetic has no count."""
        kernel, program = self.kernel, self.kernel.lowering.program
        if kernel.tangent is None or self.arithmetic.rounding is None:
            return None
        live = kernel.lowering.live(kernel.roots)
        enclosures = analyse(
            program, live, self.inputs() | self.matrix(), rounding_of(self.arithmetic)
        )
        if enclosures is None:
            return None
        values = {name: enclosures[index] for name, index in kernel.outputs.items()}
        tangent = self.tangent_error(enclosures)
        if tangent is None:
            return None
        # ε is Euclid's norm of what both components lose.
        sizes = self.box(flint.arb(0))
        state_error = norm(
            self.error_of_addition(sizes[n].abs_upper(), values[f"d{n}"]) for n in self.names
        )
        delta_j, defect = values["dj"], flint.arb(0)
        for index in kernel.defect.values():
            defect = defect.max(enclosures[index].error)
        return StepErrors(state_error, delta_j.error, tangent, delta_j.magnitude, defect, values)

    def matrix(self) -> dict[str, Rounded]:
        """Return the entries of M where it is carried: data too, within the box of `form_bound`."""
        most = form_bound.MOST * self.records["growth_top"].abs_upper().sqrt()
        box = flint.arb(0, 1) * most * (1 + flint.arb(2) ** -10)
        return {name: Rounded(box, flint.arb(0)) for name in self.kernel.matrix}

    def inputs(self) -> dict[str, Rounded]:
        """Return the state, which is data without error, and h, t and the parameters as rounded."""
        inputs = {n: Rounded(x, flint.arb(0)) for n, x in self.box(flint.arb(0)).items()}
        for name, exact in self.run.inputs(self.kernel, self.shift).items():
            # The rounded input against the exact one, as a rational.
            lost = self.arithmetic.exact(self.arithmetic.number(exact)) - exact
            inputs[name] = Rounded(rational_ball(exact), rational_ball(abs(lost)))
        if self.kernel.timed:
            # The clock's error grows with the number of additions and is greatest at the largest
            # time.
            latest = abs(self.run.start["t"]) + self.steps * self.run.start["h"]
            inputs["t"] = Rounded(
                self.times(), rational_ball(error_of_time(self.arithmetic, latest))
            )
        return inputs

    def error_of_addition(self, size: Ball, increment: Rounded) -> Ball:
        """Return the error of an increment, and of its addition to a number of that size."""
        if self.arithmetic.absolute:
            return increment.error
        return increment.error + (size + increment.magnitude) * self.unit

    def tangent_error(self, main: Mapping[int, Rounded]) -> Ball | None:
        """Return ρ, the error of one step of the tangent map, relative to ‖M‖."""
        tangent = self.kernel.tangent
        assert tangent is not None  # noqa: S101 - the caller's condition
        # A's entries come from wide numbers turned into float64, each with an error of its own.
        unit = flint.arb(2) ** -52
        inputs = {}
        for entry in tangent.main_values:
            x = main[entry]
            lost = x.magnitude * unit + flint.arb(2) ** -96
            inputs[f"approx(v{entry})"] = Rounded(x.interval, x.error + lost)
        live = tangent.lowering.live(tangent.change)
        values = analyse(tangent.program, live, inputs, FLOAT)
        if values is None:
            return None
        entries = [values[index] for index in tangent.change]
        size, error = norm(x.magnitude for x in entries), norm(x.error for x in entries)
        # 2n products, their sum, and its sum with M's rest are rounded; the rest is left out of the
        # products. That is 2n + 2 times half a unit, and terms of second order.
        units = len(self.names) // 2 + 2
        return ((error + units * unit * size) * (1 + unit) + unit * unit).abs_upper()
