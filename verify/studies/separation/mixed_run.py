"""A float64 run from checkpoint to checkpoint, with high precision beside it.

The values carried become links at every checkpoint. A link of float64 numbers is exact. The way
counts the rounding of a wide link. If it has no bound for one, the link is that of a rerun with 15
more digits; its bound, an estimate, is then twice the greatest difference of the two runs at any
checkpoint, and the part that the last bits may hide.
"""

import copy
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import takewhile
from typing import Any, Literal

from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic, SystemNumber, UnsupportedError
from verify.arithmetic.systems import float64
from verify.execution.keeper import fraction_of, fraction_text
from verify.kernels.last_in_range import last_good
from verify.kernels.notes import LazyNote
from verify.kernels.stepping import KernelRun
from verify.lockstep import Course
from verify.runs.estimates import digits_of
from verify.studies.separation.chain import Entries, Links, exact_links, links_of
from verify.studies.separation.mixed_kernel import CLOCKED_PREFIX, mixed_kernel
from verify.studies.separation.way import MixedKernel, Size, State, SteppedRun, Way

Advance = Callable[[int], None]  # called with the number of steps just done
MORE_DIGITS = 15
COUNTED = "rounding counted"
_LAST_WHOLE_FLOAT = 2**53  # all whole numbers up to here are float64s
RERUN = f"rerun with {MORE_DIGITS} more digits"


class Stopped(Exception):  # noqa: N818 - no error, an answer
    """The end of a run of the chain that has no last value."""

    def __init__(
        self, status: Literal["left range", "unresolved"], step: int | None, reason: str
    ) -> None:
        super().__init__(reason)
        self.status, self.step, self.reason = status, step, reason


def marks_of(steps: int, points: int) -> tuple[int, ...]:
    """Return the numbers of steps at the checkpoints, at most `points`, evenly spaced.

    They are those that a run of so many sections records; the last section may be shorter.
    """
    section = -(-steps // points)
    return tuple(min(k, steps) for k in range(section, steps + section, section))


def rounded_inputs(run: KernelRun) -> dict[str, float]:
    """Return the start and the kernel's parameters as float64; Stopped if one is too large."""
    rationals = {**run.start, **{n: run.parameters[n] for n in run.hamiltonian.parameters}}
    number = float64.make(17).number
    rounded: dict[str, float] = {name: number(value) for name, value in rationals.items()}
    for name, value in rounded.items():
        if not math.isfinite(value):
            raise Stopped("left range", 1, f"{name} is beyond the range of float64")
    return rounded


def round_inputs(kernel_run: KernelRun) -> KernelRun:
    """Return the run from the rounded inputs; parameters inside the kernel stay exact."""
    rounded_run, inputs = copy.copy(kernel_run), rounded_inputs(kernel_run)
    rounded_run.start = {n: Fraction(inputs[n]) for n in kernel_run.start}
    parameters = {n: Fraction(inputs[n]) for n in kernel_run.hamiltonian.parameters}
    rounded_run.parameters = {**kernel_run.parameters, **parameters}
    return rounded_run


def clock_is_exact(run: KernelRun) -> bool:
    """Return True if t ← t + h rounds nothing: all times are at most 2^53 times one 2^−k."""
    first, h = run.start["t"], run.start["h"]
    # Both are float64s: their denominators are powers of 2.
    unit = Fraction(1, max(first.denominator, h.denominator))
    latest = max(abs(first), abs(first + run.steps * h))
    return latest / unit <= _LAST_WHOLE_FLOAT


@dataclass(frozen=True)
class Working:
    """The links that one run of the mixed kernel gives; None if one was not followed.

    `factors`: with float64's determinant, or Jacobian, of each step; `closed_factors`: with
    float64's ΔJ, or S. `closed_factors` and `closed_form` are None if some 1 + ΔJ ≤ 0, which has no
    logarithm. `sizes`: those of the product of Jacobians at every checkpoint; empty for Λ.
    """

    clock: Links | None
    trajectory: Links | None
    factors: Links
    plain: Links
    closed_factors: Links | None
    closed_form: Links | None
    sizes: tuple[Size, ...]


class MixedRun:
    """A run in float64, with high precision beside it; `follow` as in `mixed_kernel`.

    `inputs`: h, the coordinates and the kernel's parameters, as the float64 numbers that they are
    rounded to.
    """

    def __init__(self, way: Way, run: KernelRun, follow: bool) -> None:
        self.way, self.run, self.follow = way, run, follow
        self.inputs = rounded_inputs(run)
        self.marks = marks_of(run.steps, way.points)

    def step_through(self, arithmetic: Arithmetic, advance: Advance) -> Course[Working]:
        """Do all steps and return the links; raises Stopped if float64 leaves its range."""
        way, run = self.way, (yield from self.step_all(arithmetic, advance))
        kernel, bounds, finer_run = run.kernel, way.bounds(run), run
        if any(bounds.get(name) is None for name in kernel.followed):
            finer = number_systems.get(arithmetic.name, digits_of(arithmetic) + MORE_DIGITS)
            finer_run = yield from self.step_all(finer, lambda _: None)
        links: dict[str, Links] = {}
        for name in kernel.followed:
            bound, values = bounds.get(name), self._read(run, name)
            if bound is not None:
                links[name] = links_of(values, bound, "enclosed", COUNTED)
                continue
            fine = self._read(finer_run, name)
            pairs = zip(values, fine, strict=True)
            difference = max(abs(x - y) for a, b in pairs for x, y in zip(a, b, strict=True))
            # The finer run has the smaller error, so that twice the difference bounds it, except
            # for digits that both runs have lost alike.
            bound = 2 * difference + way.hidden_size(
                replace(finer_run, arithmetic=arithmetic), name
            )
            links[name] = links_of(fine, bound, "estimated", RERUN)
        sizes = (way.size(state, arithmetic) for state in run.states)
        return Working(
            links.get("clock"),
            links.get("trajectory"),
            links["factors"],
            _float64_links(map(way.plain, run.states)),
            *self._closed_form_links(run, links),
            tuple(size for size in sizes if size),
        )

    def _read(self, run: SteppedRun, name: str) -> list[Entries]:
        return [self.way.read(state, name, run.arithmetic) for state in run.states]

    def _closed_form_links(
        self, run: SteppedRun, links: Mapping[str, Links]
    ) -> tuple[Links | None, Links | None]:
        """Return the links of the closed form."""
        if not run.kernel.closed:
            nothing = (Fraction(0),) * len(links["factors"])
            return (exact_links([nothing] * len(run.states), self.way.vanishes),) * 2
        values = list(map(self.way.closed_form, run.states))
        if not all(math.isfinite(x) for entries in values for x in entries):
            return None, None
        return links["closed"], _float64_links(values)

    def step_all(self, arithmetic: Arithmetic, advance: Advance) -> Course[SteppedRun]:
        """Do all steps with this arithmetic beside float64."""
        run, way, inputs = self.run, self.way, self.inputs
        kernel = mixed_kernel(way, run.hamiltonian, run.scheme, arithmetic, self.follow)
        narrow = list(kernel.inputs(inputs).values())
        wide = [arithmetic.number(Fraction(x)) for x in narrow]
        constants = [*narrow, *wide, *way.limits(kernel, arithmetic, inputs)]
        # Checkpoints are reused only for the same source, inputs and arithmetic.
        label = f"beside {arithmetic.name} {arithmetic.bits} {inputs} {kernel.source}"
        states = self._load_states(label, arithmetic)
        state = states[-1] if states else self._first_state(kernel, arithmetic)
        done = self.marks[len(states) - 1] if states else 0
        # The sums of logarithms may be undefined while the orbit and the plain way go on.
        vital = [n for n in kernel.state_names if n[0] == "f" and n not in ("f_sum", "f_rest")]
        index_of = {name: k for k, name in enumerate(kernel.state_names)}

        def in_range(state: State) -> bool:
            return all(math.isfinite(state[name]) for name in vital) and way.in_range(state)

        def states_after(every: int, stops: int = 1) -> Course[list[State]]:
            """Return the states at the next stops; fewer if float64 leaves its range."""
            numbers = state.state if isinstance(state, LazyNote) else [state[n] for n in index_of]
            steps_beyond = run.steps - done - every * stops
            after = yield from arithmetic.states(
                kernel.function, every, stops, constants, numbers, steps_beyond
            )
            notes = (
                LazyNote(kernel.state_names, lambda n, x, _: x[index_of[n]], x, 0) for x in after
            )
            return list(takewhile(in_range, notes))

        arithmetic.expect(kernel.function, run.steps - done)
        while done < run.steps:
            every, stops = self._ahead(done, len(states), arithmetic.chunk)
            after = yield from states_after(every, stops)
            for state in after:
                done += every
                advance(every)
                if done == self.marks[len(states)]:
                    states.append(state)
                self._save_states(label, states, arithmetic)
            # A kernel of limited range stops where either side leaves it; only an arithmetic of
            # every range can tell which.
            if len(after) < stops and arithmetic.absolute:
                raise UnsupportedError(f"the orbit leaves the range of {arithmetic.name}")
            if len(after) < stops:
                # Bisection between the last checkpoint and the stop gives the exact step at which
                # float64 fails.
                done += yield from last_good(every, states_after)
                raise Stopped("left range", done + 1, "float64 leaves its range")
        return SteppedRun(kernel, arithmetic, inputs, run.steps, states)

    def _ahead(self, done: int, index: int, chunk: int) -> tuple[int, int]:
        """Return the steps to the next stop and the number of stops, at marks or between them."""
        remaining, section = self.marks[index] - done, self.marks[0]
        if remaining == section <= chunk:
            return section, min(chunk, self.run.steps - done) // section
        return min(chunk, remaining), 1

    def _first_state(self, kernel: MixedKernel, arithmetic: Arithmetic) -> State:
        state: dict[str, Any] = {}
        for name in kernel.state_names:
            if name in kernel.start:
                value = Fraction(kernel.start[name])
            else:  # a coordinate or t, or an end of the interval of its values so far
                bare = name.removeprefix(CLOCKED_PREFIX).removeprefix("f_")
                value = Fraction(self.inputs[bare.removesuffix("_low").removesuffix("_high")])
            state[name] = _number(arithmetic, name, value)
        return state

    def _save_states(self, label: str, states: Sequence[State], arithmetic: Arithmetic) -> None:
        """Save the checkpoints so far, if the keeper is due to save."""
        if self.run.keeper.due(label):
            texts = [
                {n: fraction_text(as_rational(x, arithmetic)) for n, x in s.items()} for s in states
            ]
            self.run.keeper.save(label, {"found": texts})

    def _load_states(self, label: str, arithmetic: Arithmetic) -> list[State]:
        """Return the checkpoints that an interrupted run has left."""
        checkpoints = self.run.keeper.load(label) or {"found": []}
        return [
            {n: _number(arithmetic, n, fraction_of(x)) for n, x in state.items()}
            for state in checkpoints["found"]
        ]


def _number(arithmetic: Arithmetic, name: str, value: Fraction) -> SystemNumber:
    """Return the value of a name as a float64, if it begins with f, or as a wide number."""
    return float(value) if name[0] == "f" else arithmetic.number(value)


def as_rational(x: SystemNumber, arithmetic: Arithmetic) -> Fraction:
    """Return the rational that a float64 or a wide number is."""
    return Fraction(x) if isinstance(x, float) else arithmetic.exact(x)


def _float64_links(values: Iterable[tuple[float, ...]]) -> Links:
    return exact_links([tuple(map(Fraction, entries)) for entries in values], "a float64")
