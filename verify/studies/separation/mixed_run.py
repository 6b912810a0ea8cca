"""A mixed kernel's run from checkpoint to checkpoint: float64, with exact arithmetic beside it.

A mixed kernel on its way: its states by names, at the stops that are asked for.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import takewhile
from typing import Any, ClassVar, Generic, Literal, TypeVar

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.execution.keeping import fraction_of, fraction_text
from verify.kernels.chunked_loop import last_good
from verify.kernels.rounding import Ball, Rounded
from verify.kernels.stepping import KernelRun
from verify.lockstep import Course
from verify.studies.separation.kernel import AT, Mixed

State = Mapping[str, Any]  # a float or a wide number; its name begins with f or with w


class Carried(Mapping[str, Any]):
    """A kernel's state by its names; a number is made where it is looked at."""

    def __init__(self, at: Mapping[str, int], state: Sequence[Number]) -> None:
        self._at, self.numbers = at, state

    def __getitem__(self, name: str) -> Any:
        return self.numbers[self._at[name]]

    def __iter__(self) -> Iterator[str]:
        return iter(self._at)

    def __len__(self) -> int:
        return len(self._at)


class Stepper:
    """A mixed kernel with all that stays the same from step to step.

    `also`: what must hold of a state in range beside that its float64 numbers are finite.
    """

    def __init__(
        self,
        kernel: Mixed,
        arithmetic: Arithmetic,
        fixed: Sequence[Number],
        also: Callable[[State], bool] = lambda _: True,
    ) -> None:
        self.kernel, self.arithmetic, self.fixed, self.also = kernel, arithmetic, fixed, also
        self._at = {name: k for k, name in enumerate(kernel.state_names)}
        # The sums of logarithms may be undefined while the orbit and the plain way go on.
        self._vital = [n for n in self._at if n[0] == "f" and n not in ("f_sum", "f_rest")]

    def states(
        self, state: State, every: int, stops: int = 1, beyond: int = 0
    ) -> Course[list[State]]:
        """Those at the next stops; fewer where float64 leaves its range on the way.

        `beyond`: so many steps will be asked for after these.
        """
        begun = state.numbers if isinstance(state, Carried) else [state[n] for n in self._at]
        kernel = self.kernel.function
        found = yield from self.arithmetic.states(kernel, every, stops, self.fixed, begun, beyond)
        return list(takewhile(self._finite, (Carried(self._at, x) for x in found)))

    def _finite(self, state: State) -> bool:
        return all(map(math.isfinite, map(state.__getitem__, self._vital))) and self.also(state)


Advance = Callable[[int], None]  # called with the number of steps just done
POINTS = 2048  # checkpoints of a run
MORE_DIGITS = 15
COUNTED = "rounding counted"
RERUN = f"rerun with {MORE_DIGITS} more digits"
K = TypeVar("K", bound=Mixed)


class Stopped(Exception):  # noqa: N818 - no error, an answer
    """A run of the chain that has no last value."""

    def __init__(
        self, status: Literal["left range", "unresolved"], step: int | None, reason: str
    ) -> None:
        super().__init__(reason)
        self.status, self.step, self.reason = status, step, reason


def marks_of(steps: int, points: int = POINTS) -> tuple[int, ...]:
    """The numbers of steps at the checkpoints, as a run of so many sections notes them."""
    section = -(-steps // points)
    return tuple(min(k, steps) for k in range(section, steps + section, section))


class MixedRun(ABC, Generic[K]):
    """The float64 run of a run, with exact arithmetic beside it; `follow` as in the kernel.

    `inputs`: h, the coordinates and the kernel's parameters, as the float64 numbers that they are
    rounded to.
    """

    points: ClassVar[int] = POINTS

    def __init__(self, run: KernelRun, inputs: dict[str, float], follow: bool) -> None:
        self.run, self.inputs, self.follow = run, inputs, follow
        self.marks = marks_of(run.steps, self.points)

    @abstractmethod
    def _kernel(self, arithmetic: Arithmetic) -> K:
        """The kernel with this arithmetic beside float64."""

    def _limits(self, kernel: K, arithmetic: Arithmetic) -> list[Number]:
        """What the kernel compares its state with."""
        return []

    def _in_range(self, state: State) -> bool:
        """What must hold of a state beside that its float64 numbers are finite."""
        return True

    def _states(self, kernel: K, arithmetic: Arithmetic, advance: Advance) -> Course[list[State]]:
        """What the kernel carries, at every checkpoint."""
        given = [self.inputs[n] for n in ("h", *kernel.parameters)]
        wide = [arithmetic.number(Fraction(x)) for x in given]
        fixed = [*given, *wide, *self._limits(kernel, arithmetic)]
        label = f"beside {arithmetic.name} {arithmetic.bits} {self.inputs} {kernel.source}"
        states = self._kept(label, arithmetic)
        stepper = Stepper(kernel, arithmetic, fixed, self._in_range)
        state = states[-1] if states else self._first_state(kernel, arithmetic)
        done = self.marks[len(states) - 1] if states else 0
        arithmetic.expect(kernel.function, self.run.steps - done)
        while done < self.run.steps:
            every, stops = self._ahead(done, len(states), arithmetic.chunk)
            beyond = self.run.steps - done - every * stops
            after = yield from stepper.states(state, every, stops, beyond)
            for state in after:
                done += every
                advance(every)
                if done == self.marks[len(states)]:
                    states.append(state)
                self._keep(label, states, arithmetic)
            if len(after) < stops and arithmetic.absolute:
                raise UnsupportedError(f"the orbit leaves the range of {arithmetic.name}")
            if len(after) < stops:
                done += yield from last_good(every, partial(stepper.states, state))
                raise Stopped("left range", done + 1, "float64 leaves its range")
        return states

    def _ahead(self, done: int, at: int, chunk: int) -> tuple[int, int]:
        """So many steps to the next stop and so many stops: marks, or on the way to the next."""
        left, section = self.marks[at] - done, self.marks[0]
        if left == section <= chunk:
            return section, min(chunk, self.run.steps - done) // section
        return min(chunk, left), 1

    def _first_state(self, kernel: K, arithmetic: Arithmetic) -> State:
        state: dict[str, Any] = {}
        for name in kernel.state_names:
            if name in kernel.start:
                value = Fraction(kernel.start[name])
            else:  # of a coordinate or t, or an end of the region that it visits
                bare = name.removeprefix(AT).removeprefix("f_")
                value = Fraction(self.inputs[bare.removesuffix("_low").removesuffix("_high")])
            state[name] = _number(arithmetic, name, value)
        return state

    def _keep(self, label: str, states: Sequence[State], arithmetic: Arithmetic) -> None:
        """Writes the checkpoints so far, where that is due."""
        if self.run.keeper.due(label):
            texts = [
                {n: fraction_text(as_rational(x, arithmetic)) for n, x in s.items()} for s in states
            ]
            self.run.keeper.save(label, {"found": texts})

    def _kept(self, label: str, arithmetic: Arithmetic) -> list[State]:
        """The checkpoints that an interrupted run has left."""
        kept = self.run.keeper.load(label) or {"found": []}
        return [
            {n: _number(arithmetic, n, fraction_of(x)) for n, x in state.items()}
            for state in kept["found"]
        ]


def named_inputs(kernel: Mixed, inputs: Mapping[str, float]) -> dict[str, float]:
    """h and the parameters by the names that the source has for them."""
    named = {f"x{k}": inputs[n] for k, n in enumerate(kernel.parameters)}
    return {"h": inputs["h"], **named}


def visited(
    kernel: Mixed, inputs: Mapping[str, float], last: State, cut: Ball
) -> dict[str, Rounded]:
    """What a wide program is evaluated at, over the region that the float64 states visited, each
    number within `cut` of its float64. `last`: what the kernel carried in the end."""
    region = {n: rational_ball(Fraction(x)) for n, x in named_inputs(kernel, inputs).items()}
    for name in (n.removesuffix("_low") for n in last if n.endswith("_low")):
        low, high = (rational_ball(Fraction(last[f"{name}_{side}"])) for side in ("low", "high"))
        region[name.removeprefix("f_")] = low.union(high)
    if "f_t" in last:
        first, end = (rational_ball(Fraction(x)) for x in (inputs["t"], last["f_t"]))
        region["t"] = first.union(end)
    return {name: Rounded(x, cut) for name, x in region.items()}


def _number(arithmetic: Arithmetic, name: str, value: Fraction) -> Number:
    """What a name that begins with f or with w holds: a float64 or a wide number."""
    return float(value) if name[0] == "f" else arithmetic.number(value)


def as_rational(x: Number, arithmetic: Arithmetic) -> Fraction:
    """The rational that a float64 or a wide number is."""
    return Fraction(x) if isinstance(x, float) else arithmetic.exact(x)
