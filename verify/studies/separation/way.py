"""The interface of a way to follow a float64 run, and the parts of its kernel.

There are two ways. In the plane Λ is a product of determinants, less 1
(`verify.studies.separation.determinants`); in n degrees of freedom W = MᵀΩM − Ω is computed from
products of matrices (`verify.studies.separation.matrix_products`). They differ by definition, and
so in floating point; the rest of a separation is the same for both.
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

FOLLOWED = ("clock", "trajectory", "factors", "closed")  # the values that wide numbers may carry
_NAME = re.compile(r"[A-Za-z_]\w*")
# Words of a kernel's lines that take no prefix; an implicit step has a `for … in range` of its own.
_BARE = {*keyword.kwlist, "abs", "range"}
_SIDES = ("low", "high")
State = Mapping[str, Any]  # a float or a wide number; its name begins with f or with w


@dataclass(frozen=True)
class Side:
    """A step in float64 or in wide numbers; its names in a kernel's source begin with `prefix`."""

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
        """The names of the entries of K = J − 1; "" for an entry that is constantly 0."""
        zero = self.step.program.is_constant
        return [
            ["" if zero(index, 0) else self.name(index) for index in row]
            for row in self.step.slopes
        ]

    @property
    def entries(self) -> list[int]:
        """The indices of all entries of K; empty if the step has no K."""
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

    `inside`: the lines in the loop. `start`: the names that are carried from step to step, with
    their initial values. `followed`: the names of `FOLLOWED` that are among them. `closed`: True
    unless ΔJ, or S, is constantly 0.
    """

    inside: list[str]
    start: dict[str, int]
    followed: tuple[str, ...]
    closed: bool


@dataclass(frozen=True)
class MixedKernel:
    """A kernel that steps in float64 and in wide numbers beside it.

    `function(steps, f_h, *f_parameters, w_h, *w_parameters, *limits, *state_names)` returns (steps
    done, *state_names). `state_names` are carried from step to step; `start` has the initial values
    of all but the coordinates, t and the ends of the intervals that they visit. `limits`: further
    arguments for an arithmetic of limited range. `wide`: the computation of the wide lines at a
    float64 state. `followed`, `closed` as in `KernelLines`.
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
    """The sums of squares of M's entries, ‖M‖², and of its 2 × 2 minors, ‖∧²M‖².

    With M's singular values σ_i they are Σ σ_i² and Σ σ_i² σ_j², i < j. The second measures how
    much M changes areas, and so how much a 2-form grows.
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
        """Return balls of the wide program's inputs over all float64 states of the run.

        `cut` bounds the difference of a wide input from its float64.
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
        """Return the wide program's values there, with their errors; None if one is undefined."""
        program, rounding = self.kernel.wide.program, rounding_of(self.arithmetic)
        values = analyse(program, program.live(roots), self.inputs_over_region(cut), rounding)
        return None if values is None else [values[index] for index in roots]


@dataclass(frozen=True)
class Way(ABC):
    """A way to evaluate the last links in float64, and to follow them in wide numbers beside it.

    - `count`: the number of coordinates;
    - `result`: the model of the result;
    - `observable`: the quantity that a run in place of exact arithmetic measures, `observables` all
      that it carries, and `points` the number of its checkpoints;
    - `parts`: the rounding parts in the chain's order;
    - `cancelled`: the digits that differences of links cancel; `products`: those that computing W
      from a product of matrices cancels beside them;
    - `hidden`: a part is taken for noise that many digits below the last required one; None: never;
    - `vanishes`: the identity by which the closed form is exactly 0, in words.
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
        """Return the computation of a step in float64, or, `exactly`, of ΔJ or K in wide numbers.

        Raises UnsupportedError if the arithmetic cannot do it.
        """

    @abstractmethod
    def lines(self, narrow: Side, wide: Side | None, clocked: Side | None) -> KernelLines:
        """Return the lines that the way adds.

        `wide`: the step in wide numbers at float64's states, if it is followed; `clocked`: that of
        the wide state at float64's times.
        """

    def limits(
        self, kernel: MixedKernel, arithmetic: Arithmetic, inputs: Mapping[str, float]
    ) -> list[SystemNumber]:
        """Return the limits that the kernel compares its state with."""
        return []

    # -- reading a state ----------------------------------------------------------------------

    @abstractmethod
    def read(self, state: State, name: str, arithmetic: Arithmetic) -> Entries:
        """Return Λ, or W's entries, of the wide numbers of this name, one of `FOLLOWED`."""

    @abstractmethod
    def plain(self, state: State) -> tuple[float, ...]:
        """Return Λ, or W's entries, that float64 computes in the plain way."""

    @abstractmethod
    def closed_form(self, state: State) -> tuple[float, ...]:
        """Return Λ, or W's entries, that float64 computes by the closed form."""

    def in_range(self, state: State) -> bool:
        """Return True if the way's own values of a state with finite float64 numbers are finite."""
        return True

    def size(self, state: State, arithmetic: Arithmetic) -> Size | None:
        """Return the size of the product of Jacobians; None in the plane."""
        return None

    # -- bounds of errors ---------------------------------------------------------------------

    @abstractmethod
    def bounds(self, run: SteppedRun) -> Mapping[str, Fraction | None]:
        """Return a rigorous bound of each name that was followed; None where there is none."""

    @abstractmethod
    def hidden_size(self, run: SteppedRun, name: str) -> Fraction:
        """Return an error in the last bits that two compared runs may have in common."""

    # -- runs in place of exact arithmetic ----------------------------------------------------

    @abstractmethod
    def prove_links(self, run: KernelRun, step_map: StepMap | None, digits: int) -> Links | None:
        """Return the links that a proof gives; `step_map`: that for the run's parameters."""

    @abstractmethod
    def values(self, run: RunOutcome, last: Fraction) -> list[Entries]:
        """Return a run's values at its checkpoints; `last`: a more accurate one for the last."""

    def digits_beside(
        self, run: KernelRun, step_map: StepMap, link_digits: int, compiled: bool
    ) -> int:
        """Return the digits of the wide numbers for `link_digits` digits of the links."""
        return working_digits(link_digits, run.steps)
