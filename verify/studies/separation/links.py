"""The links of a separation, each made when it is asked for, at its own number of digits.

What one degree of freedom and several have in common: a link is of Λ, or one for each entry of W.

What is known is not run: a link that a proof gives, and the second where every input is a float64.
Equal links are one object, and the part between them is exactly 0.
"""

import copy
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, ClassVar, Generic, TypeVar

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.arithmetic.number_system import NumberSystem
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course, clock
from verify.runs.digits_on_demand import Measured, choose, measure
from verify.runs.estimated import working_digits
from verify.runs.run import AskedRun
from verify.studies.separation.mixed_run import POINTS, Advance, Stopped, marks_of
from verify.studies.separation.trail import Trail
from verify.studies.separation.working import Kind, Link, Working, rounded_inputs

_MANTISSAS = 2**53  # whole numbers up to here are float64s
_DOUBLINGS = 6
_ATTEMPTS = 4
AsLink = Callable[[Sequence[Fraction]], Link]  # of values at the checkpoints


L = TypeVar("L")  # Link, or one for each entry
W = TypeVar("W", bound=Working[Any])
C = TypeVar("C")  # chains


class LinksOnDemand(ABC, Generic[L, W]):
    """The links that all ways to evaluate share, and how many digits each is asked for."""

    observable: ClassVar[str]  # of a run in exact arithmetic's stead
    points: ClassVar[int] = POINTS  # checkpoints

    def __init__(
        self, kernel_run: KernelRun, arithmetic: str, digits: int, advance: Advance
    ) -> None:
        """`auto` takes the fastest arithmetic that can."""
        self._begun = clock()
        self.arithmetic = choose(kernel_run, digits) if arithmetic == AUTO else arithmetic
        self.kernel_run, self.advance = kernel_run, advance
        self.marks = marks_of(kernel_run.steps, self.points)
        self.digits = {"first": digits, "second": digits, "beside": digits}
        self.inputs = rounded_inputs(kernel_run)
        self.rounded = _with_inputs(kernel_run, self.inputs)
        self.same = (
            self.rounded.start == kernel_run.start
            and self.rounded.parameters == kernel_run.parameters
        )
        self._known: dict[str, L | None] = {}
        self._asked: AskedRun | None = None
        self._working: W | None = None
        self._made: dict[str, L] = {}

    @abstractmethod
    def beside(self) -> Course[W]:
        """The run in float64, exact arithmetic beside it; Stopped where it leaves its range."""

    @abstractmethod
    def of_proof(self, name: str) -> L | None:
        """The `first` link or the `second` to its digits, where a proof gives it."""

    @abstractmethod
    def read(self, run: Outcome, last: Fraction, as_link: AsLink) -> L:
        """The link of a run in exact arithmetic's stead, of whose last value `last` is known."""

    @property
    def seconds(self) -> float:
        """Since it was begun."""
        return clock() - self._begun

    def take(self, run: AskedRun) -> None:
        """The first link is what comes of this run, as long as its digits do."""
        self._asked = run
        self.digits["first"] = run.digits

    def proved(self, name: str) -> L | None:
        """The same, made once."""
        if name not in self._known:
            self._known[name] = self.of_proof(name)
        return self._known[name]

    def working(self) -> Course[W]:
        """The same, done once."""
        if self._working is None:
            self._working = yield from self.beside()
        return self._working

    def shared(self) -> Course[list[L]]:
        """The links before those in which ways to evaluate differ."""
        # Before the longer runs: where float64 leaves its range there is nothing to separate.
        working = yield from self.working()
        first = self.proved("first") or (yield from self._reference(self.kernel_run, "first"))
        second = first
        if not self.same:
            second = self.proved("second") or (yield from self._reference(self.rounded, "second"))
        links = [first, second]
        if self.kernel_run.hamiltonian.time_dependent:
            known = _clock_is_exact(self.rounded)
            links.append(second if known or working.clock is None else working.clock)
        return [*links, working.trajectory or second]

    def to_digits(
        self, make: Callable[[], Course[C]], lacking: Callable[[C], Sequence[int]]
    ) -> Course[C]:
        """What is made of the links, which are made again as long as some lack digits of it: how
        many the differences cancel is known once they are there."""
        for attempt in range(_ATTEMPTS):
            found = yield from make()
            if not self.refine(lacking(found), attempt):
                break
        return found

    def refine(self, lacking: Sequence[int], attempt: int = 0) -> bool:
        """Asks for so many more digits of the links; False where none lacks any.

        What is still noise lacks the same again and again: each attempt asks for twice as many.
        """
        first, second, *beside = lacking
        # One run that serves as two links is made once, with the digits of the one that lacks more.
        if self.same:
            first, second = max(first, second), 0
        wanted = {"first": first, "second": second, "beside": max(beside)}
        self.advance = lambda _: None  # what was foreseen is done
        for name, more in wanted.items():
            if more:
                self.digits[name] += more + 2 << attempt
                self._made.pop(name, None)
                self._known.pop(name, None)
        if wanted["beside"]:
            self._working = None
        return any(wanted.values())

    def system(self, digits: int) -> str:
        """The arithmetic for so many digits: one that compiles takes ever longer to do it."""
        asked = number_systems.about(self.arithmetic)
        return asked.name if digits <= asked.most_digits else last_system().name

    def _reference(self, kernel_run: KernelRun, name: str) -> Course[L]:
        if name not in self._made:
            digits, asked = self.digits[name], self._asked
            if name == "first" and asked and digits <= asked.digits:
                measured = yield from asked.measured(self._progress())
                if measured.bounds.status == "finished":
                    self._made[name] = self._in_exact_stead(asked.kernel_run, digits, measured)
                    return self._made[name]
            measured = yield from measure(kernel_run, self.system(digits), digits, self._progress())
            self._made[name] = self._in_exact_stead(kernel_run, digits, measured)
        return self._made[name]

    def _progress(self) -> Advance:
        """Tells of one run, which may begin again, the steps that were not done before."""
        last = 0

        def progress(done: int) -> None:
            nonlocal last
            self.advance(max(done - last, 0))
            last = max(done, last)

        return progress

    def _in_exact_stead(self, kernel_run: KernelRun, digits: int, measured: Measured) -> L:
        """A run to so many digits; Stopped where a run cannot give them."""
        found, run = measured.bounds, measured.outcome
        if found.status != "finished":
            reason = f"in exact arithmetic: {found.method}"
            raise Stopped(found.status, found.failed_step, reason)
        value, bound = found.values[self.observable]
        kind: Kind = "enclosed" if found.rigorous else "estimated"
        # A rigorous bound is the run's own, and the last value's is the greatest. An estimate may
        # be that of a run with more digits; the checkpoints must be those of a run that agrees
        # with it.
        more = working_digits(digits, kernel_run.steps)
        for _ in range(_DOUBLINGS):
            done = run.done == kernel_run.steps
            if done and abs(run.values[self.observable] - value) <= bound:
                return self.read(run, value, lambda x: Link(Trail.of(x), bound, kind, found.method))
            more *= 2
            run = kernel_run.run(last_system().make(more))
        raise Stopped("unresolved", None, f"in exact arithmetic: {found.method}")


def last_system() -> NumberSystem:
    """The number system that has every range and function."""
    return number_systems.automatic()[-1]


def _clock_is_exact(rounded: KernelRun) -> bool:
    """Whether t ← t + h rounds nothing in any step: all times are few multiples of one 2^−k."""
    first, h = rounded.start["t"], rounded.start["h"]
    unit = Fraction(1, max(first.denominator, h.denominator))  # of float64s, powers of 2
    latest = max(abs(first), abs(first + rounded.steps * h))
    return latest / unit <= _MANTISSAS


def _with_inputs(kernel_run: KernelRun, inputs: dict[str, float]) -> KernelRun:
    """The same run from the rounded inputs; parameters that the kernel has inside stay exact."""
    rounded = copy.copy(kernel_run)
    rounded.start = {n: Fraction(inputs[n]) for n in kernel_run.start}
    parameters = {n: Fraction(inputs[n]) for n in kernel_run.hamiltonian.parameters}
    rounded.parameters = {**kernel_run.parameters, **parameters}
    return rounded
