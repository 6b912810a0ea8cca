"""The rounding of one step of a run, counted over the box that its orbit has visited.

What is counted, ε and ρ among it, and what follows from it is told in `verify.runs.a_posteriori`;
by what rules, in `verify.kernels.rounding`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.clock import error_of_time
from verify.kernels.rounding import FLOAT, Ball, Rounded, analyse, rounding_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs import form_bound
from verify.runs.derivatives import norm


@dataclass(frozen=True)
class StepErrors:
    """One step's rounding: of the state, of D, of the tangent map relative to its size."""

    state: Ball
    delta_j: Ball
    tangent: Ball
    size: Ball  # a bound of |D|
    defect: Ball  # of an entry of S
    values: Mapping[str, Rounded]  # the kernel's outputs


class StepRounding:
    """Counts it for the steps up to the checkpoint of index `note`; the run has carried the tangent
    map."""

    def __init__(self, run: KernelRun, arithmetic: Arithmetic, outcome: Outcome, note: int) -> None:
        assert outcome.kernel is not None  # noqa: S101 - the caller's condition
        self.run, self.arithmetic, self.kernel = run, arithmetic, outcome.kernel
        self.last = outcome.trail[note]
        self.shift = outcome.shift
        self.steps = int(outcome.tangents[note]["done"])
        self.seen = {n: rational_ball(x) for n, x in outcome.tangents[note].items()}
        self.h = rational_ball(run.start["h"])
        self.unit = flint.arb(2) ** -arithmetic.bits
        self.names = self.kernel.coordinates

    # -- where the run has been -----------------------------------------------------------------

    def box(self, margin: Ball, *, last: bool = False) -> dict[str, Ball]:
        """The states at which a step was made, and the last one where it is asked for, widened;
        float64's rounding of them is within 2^−50."""
        around = flint.arb(0, 1)
        found = {}
        for n in self.names:
            low, high = self.seen[f"{n}_low"], self.seen[f"{n}_high"]
            rounded = flint.arb(2) ** -50 * (1 + abs(low) + abs(high))
            found[n] = low.union(high) + around * (margin + rounded)
            if last:
                found[n] = found[n].union(rational_ball(self.last[n]) + around * margin)
        return found

    def times(self) -> Ball:
        """All times at which a step is made."""
        turns = self.run.turns(self.arithmetic)
        if turns:
            first, last = map(rational_ball, turns.times)
            return first.union(last)
        begun = rational_ball(self.run.start.get("t", Fraction(0)))
        return begun.union(begun + self.steps * self.h)

    def fixed(self) -> dict[str, Ball]:
        """h, the parameters, and all times where they are asked for."""
        named = {n: rational_ball(x) for n, x in self.run.parameters.items()}
        time = {"t": self.times()} if self.kernel.timed else {}
        return {"h": self.h, **named, **time}

    # -- what a step loses ----------------------------------------------------------------------

    def errors(self) -> StepErrors | None:
        """None where they are not known for this kernel or arithmetic."""
        kernel, program = self.kernel, self.kernel.lowering.program
        if kernel.tangent is None or self.arithmetic.rounding is None:
            return None
        live = kernel.lowering.live(kernel.roots)
        found = analyse(program, live, self.inputs() | self.matrix(), rounding_of(self.arithmetic))
        if found is None:
            return None
        values = {name: found[index] for name, index in kernel.outputs.items()}
        tangent = self.of_tangent(found)
        if tangent is None:
            return None
        # ε is Euclid's norm of what both components lose.
        sizes = self.box(flint.arb(0))
        added = norm(self.adding(sizes[n].abs_upper(), values[f"d{n}"]) for n in self.names)
        changed, defect = values["dj"], flint.arb(0)
        for index in kernel.defect.values():
            defect = defect.max(found[index].error)
        return StepErrors(added, changed.error, tangent, changed.magnitude, defect, values)

    def matrix(self) -> dict[str, Rounded]:
        """The entries of M where it is carried: data too, within the box of `form_bound`."""
        most = form_bound.MOST * self.seen["growth_top"].abs_upper().sqrt()
        box = flint.arb(0, 1) * most * (1 + flint.arb(2) ** -10)
        return {name: Rounded(box, flint.arb(0)) for name in self.kernel.matrix}

    def inputs(self) -> dict[str, Rounded]:
        """The state, which is data and has no error, and h, t and the parameters as rounded."""
        given = {n: Rounded(x, flint.arb(0)) for n, x in self.box(flint.arb(0)).items()}
        for name, exact in self.run.inputs(self.kernel, self.shift).items():
            lost = self.arithmetic.exact(self.arithmetic.number(exact)) - exact
            given[name] = Rounded(rational_ball(exact), rational_ball(abs(lost)))
        if self.kernel.timed:
            latest = abs(self.run.start["t"]) + self.steps * self.run.start["h"]
            given["t"] = Rounded(
                self.times(), rational_ball(error_of_time(self.arithmetic, latest))
            )
        return given

    def adding(self, size: Ball, increment: Rounded) -> Ball:
        """The error of an increment, and of adding it to what is of that size."""
        if self.arithmetic.absolute:
            return increment.error
        return increment.error + (size + increment.magnitude) * self.unit

    def of_tangent(self, main: Mapping[int, Rounded]) -> Ball | None:
        """ρ: the error of one step of the tangent map, relative to ‖M‖."""
        tangent = self.kernel.tangent
        assert tangent is not None  # noqa: S101 - the caller's condition
        # A's entries come from wide numbers turned into float64, each with an error of its own.
        unit = flint.arb(2) ** -52
        inputs = {}
        for at in tangent.needed:
            x = main[at]
            lost = x.magnitude * unit + flint.arb(2) ** -96
            inputs[f"approx(v{at})"] = Rounded(x.interval, x.error + lost)
        live = tangent.lowering.live(tangent.change)
        found = analyse(tangent.program, live, inputs, FLOAT)
        if found is None:
            return None
        entries = [found[index] for index in tangent.change]
        size, error = norm(x.magnitude for x in entries), norm(x.error for x in entries)
        # 2n products, their sum, and its sum with M's rest are rounded; the rest is left out of the
        # products. That is 2n + 2 times half a unit, and what is of second order.
        units = len(self.names) // 2 + 2
        return ((error + units * unit * size) * (1 + unit) + unit * unit).abs_upper()
