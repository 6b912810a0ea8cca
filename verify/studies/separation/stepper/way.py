"""What a way of following a float64 run has to tell, and what a kernel of it consists of.

In the plane Λ is a product of determinants, in n degrees of freedom W is made of products of
matrices (`verify.studies.separation.ways`). The two differ by definition, and so in floating point:
the rest of a separation is the same for both.
"""

import keyword
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, NamedTuple

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.rounding import Ball, Rounded, analyse, rounding_of
from verify.kernels.step import newton
from verify.kernels.step.computation import Computation
from verify.kernels.step.lowering import Lowering
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs.estimated import working_digits
from verify.scenes.results.separation import AnySeparation
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation.stepper.trail import Entries, Links

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
        """A value of the step's program."""
        return f"{self.prefix}v{index}"

    def output(self, name: str) -> str:
        """One of its outputs, such as `dp`."""
        return self.name(self.step.outputs[name])

    @property
    def slopes(self) -> list[list[str]]:
        """K's entries; "" where one is 0."""
        zero = self.step.program.is_constant
        return [["" if zero(at, 0) else self.name(at) for at in row] for row in self.step.slopes]

    @property
    def entries(self) -> list[int]:
        """All entries of K, of a step that has it."""
        return [at for row in self.step.slopes for at in row]

    def lines(self, roots: Sequence[int]) -> tuple[list[str], list[str]]:
        """The lines before the loop and in it that make these values."""
        bare = _BARE if self.prefix == "f_" else _BARE | set(self.arithmetic.functions)

        def prefixed(line: str) -> str:
            return _NAME.sub(lambda m: m[0] if m[0] in bare else self.prefix + m[0], line)

        before, inside = self._lowering.lines(roots)
        return [prefixed(line) for line in before], [prefixed(line) for line in inside]

    @property
    def constants(self) -> dict[str, Number]:
        """Those of the lines, by their names without the prefix."""
        number, bits = self.arithmetic.number, self.arithmetic.bits
        return {**self._lowering.named_constants(number), **newton.constants(bits, number)}

    @property
    def _lowering(self) -> Lowering:
        program, arithmetic = self.step.program, self.arithmetic
        functions, bits, guard = arithmetic.functions, arithmetic.bits, arithmetic.guard
        return Lowering(program, functions, bits=bits, guard=guard)


class Lines(NamedTuple):
    """What a way adds to the lines of a step.

    `start`: the names that are carried from step to step, with their initial values. `followed`:
    which of `FOLLOWED` they are. `closed`: whether ΔJ, or S, is not constantly 0.
    """

    inside: list[str]
    start: dict[str, int]
    followed: tuple[str, ...]
    closed: bool


@dataclass(frozen=True)
class MixedKernel:
    """`function(steps, f_h, *f_parameters, w_h, *w_parameters, *limits, *state_names)` → (steps
    done, *state_names).

    `state_names` names what goes from step to step, `start` has the initial values but for those
    that are coordinates or ends of the region that they visit. `limits`: of an arithmetic of
    limited range. `wide`: what the wide lines compute at a float64 state. `followed`, `closed` as
    in `Lines`.
    """

    function: Callable[..., tuple[int, *tuple[Number, ...]]]
    state_names: tuple[str, ...]
    start: dict[str, int]
    followed: tuple[str, ...]
    closed: bool
    source: str
    limits: tuple[str, ...]
    wide: Computation

    def inputs(self, rounded: Mapping[str, float]) -> dict[str, float]:
        """h and the parameters by the names that the source has for them, in their order."""
        named = {f"x{k}": rounded[n] for k, n in enumerate(self.wide.parameters)}
        return {"h": rounded["h"], **named}


class Size(NamedTuple):
    """‖M‖² and ‖∧²M‖² in Frobenius' norm: the sum of all squares of entries, and of 2 × 2 minors.

    The second is how M changes areas, and so what a 2-form grows by: Σ σ_i² σ_j² of the singular
    values, i < j, beside the Σ σ_i² of the first.
    """

    norm: Fraction
    areas: Fraction


@dataclass(frozen=True)
class Stepped:
    """So many steps from rounded `inputs`, and what the kernel carried at every checkpoint."""

    kernel: MixedKernel
    arithmetic: Arithmetic
    inputs: Mapping[str, float]
    steps: int
    states: Sequence[State]

    @property
    def last(self) -> State:
        """What it carried in the end."""
        return self.states[-1]

    def visited(self, cut: Ball) -> dict[str, Rounded]:
        """What the wide program is evaluated at, over the region that the float64 states visited,
        each number within `cut` of its float64."""
        last = self.last
        region = {n: rational_ball(Fraction(x)) for n, x in self.kernel.inputs(self.inputs).items()}
        for name in (n.removesuffix("_low") for n in last if n.endswith("_low")):
            low, high = (rational_ball(Fraction(last[f"{name}_{side}"])) for side in _SIDES)
            region[name.removeprefix("f_")] = low.union(high)
        if "f_t" in last:
            first, end = (rational_ball(Fraction(x)) for x in (self.inputs["t"], last["f_t"]))
            region["t"] = first.union(end)
        return {name: Rounded(x, cut) for name, x in region.items()}

    def analysed(self, roots: Sequence[int], cut: Ball) -> list[Rounded] | None:
        """The wide program's values there, and their errors; None where one is not defined."""
        program, rounding = self.kernel.wide.program, rounding_of(self.arithmetic)
        values = analyse(program, program.live(roots), self.visited(cut), rounding)
        return None if values is None else [values[at] for at in roots]


@dataclass(frozen=True)
class Way(ABC):
    """How the last links are evaluated in float64, and followed exactly beside it.

    `count`: of coordinates. `result`: the model of what is told. `observable`, of `observables`:
    what a run in exact arithmetic's stead has. `points`: its checkpoints. `parts`: of rounding, in
    the chain's order. `cancelled`: digits that differences between links cancel, and `products`
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
        """What float64 computes in a step, or what is computed `exactly` at its states: ΔJ, or K.
        UnsupportedError where that cannot be."""

    @abstractmethod
    def lines(self, narrow: Side, wide: Side | None, clocked: Side | None) -> Lines:
        """What is carried; `wide` where it is carried exactly too, `clocked` at float64's times."""

    def limits(
        self, kernel: MixedKernel, arithmetic: Arithmetic, inputs: Mapping[str, float]
    ) -> list[Number]:
        """What the kernel compares its state with."""
        return []

    # -- what is read of a state --------------------------------------------------------------

    @abstractmethod
    def read(self, state: State, name: str, arithmetic: Arithmetic) -> Entries:
        """Λ, or W's entries, as exactly as it was followed; `name` is one of `FOLLOWED`."""

    @abstractmethod
    def plain(self, state: State) -> tuple[float, ...]:
        """The same as float64 finds it in the plain way."""

    @abstractmethod
    def closed_form(self, state: State) -> tuple[float, ...]:
        """The same as float64 finds it by the closed form."""

    def in_range(self, state: State) -> bool:
        """What must hold of a state beside that its float64 numbers are finite."""
        return True

    def size(self, state: State, arithmetic: Arithmetic) -> Size | None:
        """How large the product of Jacobians is, of W."""
        return None

    # -- how far it is known ------------------------------------------------------------------

    @abstractmethod
    def bounds(self, run: Stepped) -> Mapping[str, Fraction | None]:
        """A rigorous bound of all that was followed, or None where there is none."""

    @abstractmethod
    def hides(self, run: Stepped, name: str) -> Fraction:
        """What the last bits may hide from two runs that are held against each other."""

    # -- runs in exact arithmetic's stead -----------------------------------------------------

    @abstractmethod
    def proved(self, run: KernelRun, exact: StepMap | None, digits: int) -> Links | None:
        """The links that a proof gives without a run; `exact`: the map for the run's parameters."""

    @abstractmethod
    def values(self, run: Outcome, last: Fraction) -> list[Entries]:
        """What a run has at its checkpoints; `last` is known of its last observable."""

    def digits_beside(self, run: KernelRun, exact: StepMap, wanted: int, compiled: bool) -> int:
        """The digits beside float64 for so many of the links."""
        return working_digits(wanted, run.steps)
