"""Bounds of the derivatives and of the rounding of one step, over the box that a run has visited.

The new state z', det J − 1 and the entries of S = JᵀΩJ − Ω are differentiated operation by
operation (`verify.kernels.step.program_algebra`), and enclosed over the box by interval arithmetic.
The rounding of a step is counted by the rules in `verify.kernels.rounding`.
`verify.runs.a_posteriori_bound` defines B, ε and ρ, and derives bounds of a run from them.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.number_system import Arithmetic
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import bound_time_error
from verify.kernels.rounding import FLOAT64_ROUNDING, Ball, RoundedValue, analyse, rounding_of
from verify.kernels.step.computation import StepRequest, computation_of, step_map_of
from verify.kernels.step.operations import StepProgram
from verify.kernels.step.partials import Partials
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.observables.observable import Need
from verify.runs import matrix_growth

_ZERO = flint.arb(0)


def norm(values: Iterable[Ball]) -> Ball:
    """Return a bound of the Euclidean norm."""
    return sum((x.abs_upper() ** 2 for x in values), flint.arb(0)).sqrt().abs_upper()


# -- derivatives ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class StepDerivatives:
    """Derivatives of a step, by their indices in `program`.

    `values` are the increments z' − z and det J − 1, `defect` the entries of S; `hessians` are the
    second derivatives of z'. `of_volume` and `of_defect` are the gradients of det J − 1 and of the
    entries of S, one after the other.
    """

    hamiltonian: Hamiltonian
    program: StepProgram
    parameters: tuple[str, ...]
    values: tuple[int, ...]
    hessians: tuple[int, ...]
    of_volume: tuple[int, ...]
    defect: tuple[int, ...]
    of_defect: tuple[int, ...]

    @classmethod
    @lru_cache(maxsize=32)
    def from_scheme(
        cls, hamiltonian: Hamiltonian, scheme: str, *, volume: bool, form: bool
    ) -> "StepDerivatives | None":
        """Return the derivatives of a scheme's step.

        None for a scheme that does not take this H, and for one that solves equations for it.
        `volume`: True if det J is needed; otherwise its gradient is 0. `form`: True if S is needed;
        otherwise there are no entries of it.
        """
        try:
            step = step_map_of(hamiltonian, scheme)
        except InputError:
            return None
        # The outputs of an implicit step come from an iteration, whose operations have no
        # derivatives of the exact map.
        if step.implicit:
            return None
        is_needed: dict[Need, bool] = {"delta_j": volume, "symplectic": form}
        needs = frozenset(need for need, needed in is_needed.items() if needed)
        request = StepRequest(
            pipelined=False, scaled=False, tangent=False, needs=needs, slopes=True
        )
        computation = computation_of(step, request)
        program = computation.program.copy()
        # `computation.slopes` are the entries of DΦ, and their gradients the second derivatives.
        partials = Partials(
            program, [program.input(n, static=False) for n in computation.coordinates]
        )
        second = [
            x for row in computation.slopes for index in row for x in partials.gradient(index)
        ]
        defect = tuple(computation.defect.values())
        return cls(
            hamiltonian,
            program,
            computation.parameters,
            (
                *(computation.outputs[f"d{name}"] for name in computation.coordinates),
                computation.outputs["dj"],
            ),
            tuple(second),
            tuple(partials.gradient(computation.outputs["dj"])),
            defect,
            tuple(x for index in defect for x in partials.gradient(index)),
        )

    def second(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """Return B with ‖Φ(z + e) − Φ(z) − DΦ(z) e‖ ≤ ½ B ‖e‖² in the box, a bound of ‖D²Φ‖.

        Then ‖DΦ(z + e) − DΦ(z)‖ ≤ B ‖e‖, too. B is not finite if Φ may be undefined in the box.
        """
        values = self._enclose((*self.hessians, *self.values), constants, box)
        return flint.arb.nan() if values is None else norm(values[: len(self.hessians)])

    def gradient(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> Ball:
        """Return a bound of ‖∇ det J‖ in the box."""
        values = self._enclose(self.of_volume, constants, box)
        return flint.arb.nan() if values is None else norm(values)

    def form(self, constants: Mapping[str, Ball], box: Mapping[str, Ball]) -> tuple[Ball, Ball]:
        """Return bounds in the box of the Frobenius norms of S and of its gradient."""
        values = self._enclose((*self.defect, *self.of_defect), constants, box)
        if values is None:
            return flint.arb.nan(), flint.arb.nan()
        count, twice = len(self.defect), flint.arb(2).sqrt()  # each entry stands in S twice
        return twice * norm(values[:count]), twice * norm(values[count:])

    def _enclose(
        self, indices: Sequence[int], constants: Mapping[str, Ball], box: Mapping[str, Ball]
    ) -> list[Ball] | None:
        parameters = {f"x{k}": constants[n] for k, n in enumerate(self.parameters)}
        step_and_time = {n: x for n, x in constants.items() if n in ("h", "t")}
        inputs = {
            n: RoundedValue(x, _ZERO) for n, x in {**box, **parameters, **step_and_time}.items()
        }
        results = analyse(self.program, self.program.live(indices), inputs, lambda *_: _ZERO)
        return None if results is None else [results[index].interval for index in indices]


# -- rounding -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class StepErrors:
    """Bounds of the rounding of one step: of the state (ε), of D, and of the tangent map (ρ)."""

    state: Ball
    delta_j: Ball
    tangent: Ball
    size: Ball  # a bound of |D|
    defect: Ball  # the rounding of an entry of S
    values: Mapping[str, RoundedValue]  # the kernel's outputs


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
        # Of a tangent map that begins anew all notes count, else the last one.
        last = note % len(outcome.tangents)
        self.notes = outcome.tangents[0 if run.restarts else last : last + 1]
        self.h = rational_ball(run.start["h"])
        self.unit = flint.arb(2) ** -arithmetic.bits
        self.names = self.kernel.coordinates

    # -- the box of the run ---------------------------------------------------------------------

    def box(self, margin: Ball, *, last: bool = False) -> dict[str, Ball]:
        """Return a box of the states before each step, and if `last` of the last one, widened.

        The box is widened by `margin`, and by 2^−50 for the recorded states, which are float64s.
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
        """Return an interval that contains the time of each step."""
        turns = self.run.turns(self.arithmetic)
        if turns:
            first, last = map(rational_ball, turns.times)
            return first.union(last)
        start = rational_ball(self.run.start.get("t", Fraction(0)))
        return start.union(start + self.steps * self.h)

    def constants(self) -> dict[str, Ball]:
        """Return h and the parameters, and if the kernel has a clock the interval of its times."""
        parameters = {n: rational_ball(x) for n, x in self.run.parameters.items()}
        time = {"t": self.times()} if self.kernel.timed else {}
        return {"h": self.h, **parameters, **time}

    # -- the rounding of a step -----------------------------------------------------------------

    def errors(self) -> StepErrors | None:
        """Return bounds of the rounding of one step; None if none is known for this kernel."""
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
        # ε is the Euclidean norm of the roundings of all coordinates.
        sizes = self.box(flint.arb(0))
        state_error = norm(
            self.error_of_addition(sizes[n].abs_upper(), values[f"d{n}"]) for n in self.names
        )
        delta_j, defect = values["dj"], flint.arb(0)
        for index in kernel.defect.values():
            defect = defect.max(enclosures[index].error)
        return StepErrors(state_error, delta_j.error, tangent, delta_j.magnitude, defect, values)

    def matrix(self) -> dict[str, RoundedValue]:
        """Return the entries of a carried Ĵ as exact inputs, in the box of `matrix_growth`."""
        most = matrix_growth.MOST * self.top
        box = flint.arb(0, 1) * most * (1 + flint.arb(2) ** -10)
        return {name: RoundedValue(box, flint.arb(0)) for name in self.kernel.matrix}

    @property
    def top(self) -> Ball:
        """A bound of the norms of M, or where it begins anew room for those of the products."""
        if not self.run.restarts:
            return self.records["growth_top"].abs_upper().sqrt()
        return 2 * matrix_growth.bound_product(self.notes, self.names)

    def inputs(self) -> dict[str, RoundedValue]:
        """Return the state as an exact input, and h, t and the parameters with their rounding."""
        inputs = {n: RoundedValue(x, flint.arb(0)) for n, x in self.box(flint.arb(0)).items()}
        for name, value in self.run.inputs(self.kernel, self.shift).items():
            # The distance of the rounded input from the exact one, a rational.
            lost = self.arithmetic.exact(self.arithmetic.number(value)) - value
            inputs[name] = RoundedValue(rational_ball(value), rational_ball(abs(lost)))
        if self.kernel.timed:
            # The clock's error is largest at the largest time.
            latest = abs(self.run.start["t"]) + self.steps * abs(self.run.start["h"])
            inputs["t"] = RoundedValue(
                self.times(), rational_ball(bound_time_error(self.arithmetic, latest))
            )
        return inputs

    def error_of_addition(self, size: Ball, increment: RoundedValue) -> Ball:
        """Return a bound of the error of an increment and of its addition to a number of `size`."""
        if self.arithmetic.absolute:
            return increment.error
        return increment.error + (size + increment.magnitude) * self.unit

    def tangent_error(self, main: Mapping[int, RoundedValue]) -> Ball | None:
        """Return ρ, a bound of the error of one step of the tangent map, relative to ‖M‖."""
        tangent = self.kernel.tangent
        assert tangent is not None  # noqa: S101 - the caller's condition
        # A's entries come from wide numbers that are rounded to float64, each with its own error.
        unit = flint.arb(2) ** -52
        inputs = {}
        for entry in tangent.main_values:
            x = main[entry]
            lost = x.magnitude * unit + flint.arb(2) ** -96
            inputs[f"approx(v{entry})"] = RoundedValue(x.interval, x.error + lost)
        live = tangent.lowering.live(tangent.change)
        values = analyse(tangent.program, live, inputs, FLOAT64_ROUNDING)
        if values is None:
            return None
        entries = [values[index] for index in tangent.change]
        size, error = norm(x.magnitude for x in entries), norm(x.error for x in entries)
        # 2n products, their sum, and its sum with M's low part are rounded; the low part is left
        # out of the products. That is 2n + 2 times half a unit, and terms of second order.
        units = len(self.names) // 2 + 2
        return ((error + units * unit * size) * (1 + unit) + unit * unit).abs_upper()
