"""Trails: states along a run, by which the step at which something happens is found.

A trail has the state after every n-th step, n = 1 in short runs and mostly a prime number in long
ones: an orbit that comes back after a few steps would else be seen at the same state again and
again. If something happens between two states of a trail, the stretch between them is run again
from the first of them as a trail with smaller n, until n = 1.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

from sympy import isprime

from verify import arithmetic as number_systems
from verify.arithmetic.exact import fraction, quotient
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.runs.digits_on_demand import worth_compiling

_LEAST_SECTIONS, MOST_SECTIONS = 128, 512  # stretches of a trail that does not keep every step
_USUAL_LENGTH = 64  # steps of a stretch, if these limits allow it
_LEAST_LENGTH = 5  # steps of a stretch
MOST_INTERPRETED = 300_000  # steps in an arithmetic that has no compiler


State = tuple[Fraction, ...]  # p and q; p1 … pn, q1 … qn


@dataclass(frozen=True)
class StabilityRun:
    """The first N steps from a state, p and q or p1 … qn, at t0 if H depends on time."""

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    state: State
    steps: int
    t0: Fraction = Fraction(0)

    @property
    def time(self) -> Fraction:
        """The length N·h of the run."""
        return self.steps * self.step_size

    @property
    def start(self) -> Mapping[str, Fraction]:
        """The initial values, h and t of a kernel's run, by their names."""
        point = dict(zip(self.hamiltonian.coordinates, self.state, strict=True))
        return {**point, "h": self.step_size, "t": self.t0}

    def onwards(self, state: State, step: int, steps: int) -> "StabilityRun":
        """Return the run of so many steps from `state`, which is that after `step` of its steps."""
        t0 = self.t0 + step * self.step_size
        return replace(self, state=state, steps=steps, t0=t0)

    def with_steps(self, steps: int) -> "StabilityRun":
        """Return the run from the same start with another number of steps."""
        return replace(self, steps=steps)


class TrailPoint(NamedTuple):
    """The state after `step` steps, exactly, in gmpy2's rationals."""

    step: int
    state: tuple[Any, ...]


@dataclass(frozen=True)
class RunTrail:
    """States of a run in an arithmetic, at its start and after each stretch.

    `every`: the number of steps of a stretch; the last one may be shorter. `done`: the number of
    steps that stayed in the arithmetic's range. `columns`: the numbers of each coordinate, the
    arithmetic's own or gmpy2's rationals; any two of them are compared exactly, ten times as fast
    as Fractions.
    """

    run: StabilityRun
    arithmetic: Arithmetic
    every: int
    columns: tuple[tuple[Any, ...], ...]
    done: int

    @cached_property
    def points(self) -> tuple[TrailPoint, ...]:
        """The start and the state after each stretch."""
        return tuple(map(self.point, range(len(self.columns[0]))))

    def point(self, index: int) -> TrailPoint:
        """Return the point after so many stretches; −1 for the last one."""
        index %= len(self.columns[0])
        state = tuple(quotient(column[index]) for column in self.columns)
        return TrailPoint(min(index * self.every, self.steps), state)

    @property
    def steps(self) -> int:
        """The number of steps of the run, of which `done` were done."""
        return self.run.steps

    @property
    def is_finished(self) -> bool:
        """True if no step left the arithmetic's range."""
        return self.done == self.steps

    def onwards(self, point: TrailPoint, steps: int) -> "RunTrail":
        """Return a trail of so many steps from one of its points, with shorter stretches."""
        state = tuple(map(fraction, point.state))
        return follow(self.run.onwards(state, point.step, steps), self.arithmetic)


def follow(run: StabilityRun, arithmetic: Arithmetic) -> RunTrail:
    """Follow the run in this arithmetic. Raises UnsupportedError if that lacks a function."""
    arguments = run.hamiltonian, run.scheme, {**run.start}, run.steps, frozenset[str](), 0
    kernel_run = KernelRun(*arguments, sections=_sections(run.steps))
    outcome = kernel_run.run(arithmetic)
    columns, later = [], zip(*outcome.states, strict=True)
    for first in run.state:
        numbers = next(later, ())
        if arithmetic.absolute:  # gmpy2 cannot compare fixed-point numbers
            numbers = tuple(quotient(arithmetic.exact(x)) for x in numbers)
        columns.append((quotient(first), *numbers))
    return RunTrail(run, arithmetic, kernel_run.section, tuple(columns), outcome.done)


@lru_cache(maxsize=256)
def _sections(steps: int) -> int:
    """Return the number of stretches of a trail."""
    if steps <= MOST_SECTIONS:
        return steps
    # A prime number of steps between states does not resonate with a scheme that returns after a
    # few steps.
    target = min(MOST_SECTIONS, max(_LEAST_SECTIONS, steps // _USUAL_LENGTH))
    lengths = ((sections, -(-steps // sections)) for sections in range(target, 0, -1))
    return next((k for k, length in lengths if length >= _LEAST_LENGTH and isprime(length)), target)


def follow_precisely(run: StabilityRun, digits: int) -> RunTrail:
    """Follow the run with so many digits, in a compiled arithmetic if that is worth the time.

    Without a compiler only the first 300 000 steps are done; the trail's `steps` is their number.
    """
    *faster, last = number_systems.automatic()
    for system in faster:
        if worth_compiling(system, run.steps):
            try:
                trail = follow(run, system.make(digits))
            except UnsupportedError:
                continue
            if trail.is_finished:
                return trail
    return follow(run.with_steps(min(run.steps, MOST_INTERPRETED)), last.make(digits))


def find_first_step(trail: RunTrail, happens: Callable[[TrailPoint], bool]) -> int | None:
    """Find the first step after which `happens` is True, at the trail's points, then between them.

    If none is found in a run that leaves the arithmetic's range, it is the step after the last one
    done; else None.
    """
    before = trail.points[0]
    for point in trail.points[1:]:
        if happens(point):
            length = point.step - before.step
            step = _find_first_step_from(trail, before, length, happens) if length > 1 else None
            return point.step if step is None else step
        before = point
    if trail.is_finished:
        return None
    remaining = trail.done - before.step
    step = _find_first_step_from(trail, before, remaining, happens) if remaining else None
    return trail.done + 1 if step is None else step


def _find_first_step_from(
    trail: RunTrail, before: TrailPoint, steps: int, happens: Callable[[TrailPoint], bool]
) -> int | None:
    """Find that step within `steps` steps from the point `before`."""
    step = find_first_step(trail.onwards(before, steps), happens)
    return None if step is None else before.step + step


def find_first_apart(
    trail: RunTrail, other_trail: RunTrail, apart: Callable[[TrailPoint, TrailPoint], bool]
) -> int | None:
    """Find the first step after which two trails of one run are apart; None if there is none.

    It is looked for at the trails' points and then between them.
    """
    offset = 0
    while True:
        pairs = list(zip(trail.points, other_trail.points, strict=False))
        index = next((k for k, pair in enumerate(pairs) if apart(*pair)), None)
        if index is None:
            return None
        if index == 0:
            return offset
        # The runs were together at the state before: both are followed from there, each from its
        # own state, until a stretch is one step.
        (x, y), step = pairs[index - 1], pairs[index][0].step
        length = step - x.step
        if length == 1:
            return offset + step
        offset += x.step
        trail, other_trail = trail.onwards(x, length), other_trail.onwards(y, length)
