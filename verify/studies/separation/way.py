"""The interface of a way to follow a float64 run, and the parts of its kernel.

In the plane Λ is a product of determinants, in n degrees of freedom W is made of products of
matrices (`verify.studies.separation.determinants`, `verify.studies.separation.matrix_products`).
The two differ by definition, and so in floating point: the rest of a separation is the same for
both.
"""

import keyword
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, NamedTuple

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.number_system import Arithmetic, SystemNumber
from verify.kernels.rounding import Ball, RoundedValue, analyse, rounding_of
from verify.kernels.step.computation import Computation
from verify.kernels.step.lowering import Lowering, newton_constants
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs.estimates import working_digits
from verify.scenes.results.separation import AnySeparation
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation.chain import Entries, Links

FOLLOWED = ("clock", "trajectory", "factors", "closed")  # what may be carried in wide numbers
_NAME = re.compile(r"[A-Za-z_]\w*")
_BARE = {*keyword.kwlist, "abs", "range"}  # where equations are solved there is a loop in the loop
_SIDES = ("low", "high")
State = Mapping[str, Any]  # a float or a wide number; its name begins with f or with w


@dataclass(frozen=True)
class Side:
    """A step in float64, or in wide numbers; in the source its names begin with `prefix`."""

    step: Computation
    arithmetic: Arithmetic
    prefix: str

    def name(self, index: int) -> str:
        """Return the name of a value of the step's program."""
        return f"{self.prefix}v{index}"

    def output(self, name: str) -> str:
        """Return the name of one of its outputs, such as `dp`."""
        return self.name(self.step.outputs[name])

    @property
    def slopes(self) -> list[list[str]]:
        """The names of K's entries; "" where one is 0."""
        zero = self.step.program.is_constant
        return [
            ["" if zero(index, 0) else self.name(index) for index in row]
            for row in self.step.slopes
        ]

    @property
    def entries(self) -> list[int]:
        """The indices of all entries of K, of a step that has it."""
        return [index for row in self.step.slopes for index in row]

    def lines(self, roots: Sequence[int]) -> tuple[list[str], list[str]]:
        """Return the lines before the loop and in it that compute these values."""
        bare = _BARE if self.prefix == "f_" else _BARE | set(self.arithmetic.functions)

        def add_prefix(line: str) -> str:
            return _NAME.sub(lambda m: m[0] if m[0] in bare else self.prefix + m[0], line)

        before, inside = self._lowering.lines(roots)
        return [add_prefix(line) for line in before], [add_prefix(line) for line in inside]

    @property
    def constants(self) -> dict[str, SystemNumber]:
        """The constants of the lines, by their names without the prefix."""
        number, bits = self.arithmetic.number, self.arithmetic.bits
        return {**self._lowering.named_constants(number), **newton_constants(bits, number)}

    @property
    def _lowering(self) -> Lowering:
        program, arithmetic = self.step.program, self.arithmetic
        functions, bits, guard = arithmetic.functions, arithmetic.bits, arithmetic.guard
        return Lowering(program, functions, bits=bits, guard=guard)


class KernelLines(NamedTuple):
    """The lines that a way adds to those of a step.

    `start`: the names that are carried from step to step, with their initial values. `followed`:
    which of `FOLLOWED` they are. `closed`: True unless ΔJ, or S, is constantly 0.
    """

    inside: list[str]
    start: dict[str, int]
    followed: tuple[str, ...]
    closed: bool


@dataclass(frozen=True)
class MixedKernel:
    """A kernel that steps in float64 and in wide numbers beside it.

    `function(steps, f_h, *f_parameters, w_h, *w_parameters, *limits, *state_names)` returns (steps
    done, *state_names). `state_names` are carried from step to step; `start` has their initial
    values, except of coordinates and of the ends of the region that they visit. `limits`: of an
    arithmetic of limited range. `wide`: what the wide lines compute at a float64 state. `followed`,
    `closed` as in `Lines`.
    """

    function: Callable[..., tuple[int, *tuple[SystemNumber, ...]]]
    state_names: tuple[str, ...]
    start: dict[str, int]
    followed: tuple[str, ...]
    closed: bool
    source: str
    limits: tuple[str, ...]
    wide: Computation

    def inputs(self, rounded: Mapping[str, float]) -> dict[str, float]:
        """Return h and the parameters by the names that the source has for them, in their order."""
        parameters = {f"x{k}": rounded[n] for k, n in enumerate(self.wide.parameters)}
        return {"h": rounded["h"], **parameters}


class Size(NamedTuple):
    """The sizes ‖M‖² and ‖∧²M‖² in the Frobenius norm: sums of squares of entries and 2 × 2 minors.

    The second measures how M changes areas, by which a 2-form grows: it is Σ σ_i² σ_j² of the
    singular values, i < j, and the first is Σ σ_i².
    """

    norm: Fraction
    areas: Fraction


@dataclass(frozen=True)
class SteppedRun:
    """A run of so many steps from rounded `inputs`, with the kernel's state at every checkpoint."""

    kernel: MixedKernel
    arithmetic: Arithmetic
    inputs: Mapping[str, float]
    steps: int
    states: Sequence[State]

    @property
    def last(self) -> State:
        """The state after the last step."""
        return self.states[-1]

    def inputs_over_region(self, cut: Ball) -> dict[str, RoundedValue]:
        """Return the wide program's inputs, over the region that the float64 states visited.

        Each number is within `cut` of its float64.
        """
        last = self.last
        region = {n: rational_ball(Fraction(x)) for n, x in self.kernel.inputs(self.inputs).items()}
        for name in (n.removesuffix("_low") for n in last if n.endswith("_low")):
            low, high = (rational_ball(Fraction(last[f"{name}_{side}"])) for side in _SIDES)
            region[name.removeprefix("f_")] = low.union(high)
        if "f_t" in last:
            first, end = (rational_ball(Fraction(x)) for x in (self.inputs["t"], last["f_t"]))
            region["t"] = first.union(end)
        return {name: RoundedValue(x, cut) for name, x in region.items()}

    def analyse_values(self, roots: Sequence[int], cut: Ball) -> list[RoundedValue] | None:
        """Return the wide program's values there, with errors; None if one is not defined."""
        program, rounding = self.kernel.wide.program, rounding_of(self.arithmetic)
        values = analyse(program, program.live(roots), self.inputs_over_region(cut), rounding)
        return None if values is None else [values[index] for index in roots]


@dataclass(frozen=True)
class Way(ABC):
    """A way to evaluate the last links in float64, and to follow them exactly beside it.

    `count`: of coordinates. `result`: the model of the result. `observable`, of `observables`: the
    quantity of a run in place of exact arithmetic. `points`: its checkpoints. `parts`: of rounding,
    in the chain's order. `cancelled`: digits that differences between links cancel, and `products`
    those that reading a product does beside them. `hidden`: so many digits further below the
    greatest quantity a part is taken for noise, if ever. `vanishes`: in words, why the closed form
    is exactly 0 where it is.
    """

    count: int
    result: ClassVar[type[AnySeparation]]
    observable: ClassVar[str]
    observables: ClassVar[frozenset[str]]
    points: ClassVar[int]
    parts: ClassVar[tuple[str, ...]]
    cancelled: ClassVar[int]
    products: ClassVar[int] = 0
    hidden: ClassVar[int | None] = None
    vanishes: ClassVar[str]

    @abstractmethod
    def step(self, step_map: StepMap, arithmetic: Arithmetic, exactly: bool) -> Computation:
        """Return float64's computation of a step, or, `exactly`, that of ΔJ or K at its states.

        Raises UnsupportedError if the arithmetic cannot do it.
        """

    @abstractmethod
    def lines(self, narrow: Side, wide: Side | None, clocked: Side | None) -> KernelLines:
        """Return the lines carried; `wide`: exactly too, `clocked`: at float64's times."""

    def limits(
        self, kernel: MixedKernel, arithmetic: Arithmetic, inputs: Mapping[str, float]
    ) -> list[SystemNumber]:
        """Return the limits that the kernel compares its state with."""
        return []

    # -- reading a state ----------------------------------------------------------------------

    @abstractmethod
    def read(self, state: State, name: str, arithmetic: Arithmetic) -> Entries:
        """Return Λ, or W's entries, as exactly as it was followed; `name` is one of `FOLLOWED`."""

    @abstractmethod
    def plain(self, state: State) -> tuple[float, ...]:
        """Return the same as float64 finds it in the plain way."""

    @abstractmethod
    def closed_form(self, state: State) -> tuple[float, ...]:
        """Return the same as float64 finds it by the closed form."""

    def in_range(self, state: State) -> bool:
        """Return True if a state whose float64 numbers are finite is in range."""
        return True

    def size(self, state: State, arithmetic: Arithmetic) -> Size | None:
        """Return the size of the product of Jacobians, where W is followed."""
        return None

    # -- bounds of errors ---------------------------------------------------------------------

    @abstractmethod
    def bounds(self, run: SteppedRun) -> Mapping[str, Fraction | None]:
        """Return a rigorous bound of everything that was followed, or None if there is none."""

    @abstractmethod
    def hidden_size(self, run: SteppedRun, name: str) -> Fraction:
        """Return the error that the last bits may hide from two runs that are compared."""

    # -- runs in place of exact arithmetic ----------------------------------------------------

    @abstractmethod
    def prove_links(self, run: KernelRun, step_map: StepMap | None, digits: int) -> Links | None:
        """Return the links that a proof gives; `step_map`: that for the run's parameters."""

    @abstractmethod
    def values(self, run: RunOutcome, last: Fraction) -> list[Entries]:
        """Return a run's values at its checkpoints; `last` is the better value of the last one."""

    def digits_beside(
        self, run: KernelRun, step_map: StepMap, link_digits: int, compiled: bool
    ) -> int:
        """Return the digits beside float64 for so many of the links."""
        return working_digits(link_digits, run.steps)
