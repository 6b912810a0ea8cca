"""The links of a separation, each made when it is asked for, at its own number of digits.

A link is of Λ, or one for each entry of W. What is known is not run: a link that a proof gives, and
the second where every input is a float64. Equal links are one object, and the part between them is
exactly 0. So where the proof gives ΔJ ≡ 0, or S ≡ 0, all links before float64's factors are exactly
0, and the closed form's too; where ΔJ does not depend on (p, q), Λ₀ is a closed form and Λ₂ = Λ₁.
Where every input is a float64, Λ₁ = Λ₀; after one step Λ₂ = Λ₁, for the first ΔJ is taken at the
initial value.
"""

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.arithmetic.number_system import NumberSystem, UnsupportedError
from verify.errors import InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun
from verify.lockstep import Course, clock
from verify.runs.digits_on_demand import Measured, choose, measure
from verify.runs.estimated import working_digits
from verify.runs.run import AskedRun
from verify.schemes.maps.step_map import StepMap
from verify.structures import AREA, SYMPLECTIC, Structure
from verify.studies.separation.chain import Chain, lacking
from verify.studies.separation.stepper.run import (
    Advance,
    MixedRun,
    Stopped,
    Working,
    marks_of,
    rounded_inputs,
)
from verify.studies.separation.stepper.trail import Kind, Links, links_of
from verify.studies.separation.stepper.way import Size, Way
from verify.studies.separation.ways.determinants import Determinants
from verify.studies.separation.ways.matrices import Matrices

_WAYS: dict[Structure, type[Way]] = {AREA: Determinants, SYMPLECTIC: Matrices}
_MANTISSAS = 2**53  # whole numbers up to here are float64s
_DOUBLINGS = 6
_ATTEMPTS = 4
EachWay = tuple[tuple[Chain, ...], tuple[Chain, ...] | None]


@dataclass(frozen=True)
class Chains:
    """The chains of the plain way and of the closed form, one for Λ, or for each entry of W above
    the diagonal. The closed form has none where some det J ≤ 0.

    `arithmetic` stood for exact arithmetic; `sizes`: of M at the checkpoints, for W.
    """

    plain: tuple[Chain, ...]
    closed_form: tuple[Chain, ...] | None
    sizes: tuple[Size, ...]
    arithmetic: str
    seconds: float


def way_of(hamiltonian: Hamiltonian) -> Way:
    """The way in which its runs are followed."""
    return _WAYS[hamiltonian.structure](len(hamiltonian.coordinates))


def separated_chains(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: dict[str, Fraction],
    steps: int,
    digits: int,
    arithmetic: str = AUTO,
    advance: Advance = lambda _: None,
    keeper: Keeper = NOTHING,
    run: AskedRun | None = None,
) -> Course[Chains]:
    """Of a scheme's run from exact inputs, every part to so many digits where that can be had.

    `arithmetic` stands for exact arithmetic; `auto` takes the fastest that can. `advance` is called
    with the steps just done, of three runs of N steps. `run`, of these steps and checkpoints, is
    taken for the first link. Raises Stopped where Λ, or W, has no value.
    """
    way = way_of(hamiltonian)
    kernel_run = KernelRun(
        hamiltonian, scheme, start, steps, way.observables, 0, keeper, sections=way.points
    )
    links = LinksOnDemand(way, kernel_run, step_map_of(hamiltonian, scheme), arithmetic, digits)
    links.advance = advance
    if run is not None:
        links.take(run)
    plain, closed = yield from links.to_digits(digits)
    working = yield from links.working()
    return Chains(plain, closed, working.sizes, links.arithmetic, links.seconds)


class LinksOnDemand:
    """The links of all ways to evaluate, and how many digits each is asked for."""

    def __init__(
        self, way: Way, kernel_run: KernelRun, step_map: StepMap, arithmetic: str, digits: int
    ) -> None:
        """`step_map`: for the exact parameters. `digits` are wanted of every part. `auto` takes the
        fastest arithmetic that can."""
        self._begun = clock()
        digits += way.cancelled
        self.arithmetic = choose(kernel_run, digits) if arithmetic == AUTO else arithmetic
        self.way, self.kernel_run, self.step_map = way, kernel_run, step_map
        self.advance: Advance = lambda _: None
        self.marks = marks_of(kernel_run.steps, way.points)
        self.digits = {"first": digits, "second": digits, "beside": digits + way.products}
        rounded = _with_rounded_inputs(kernel_run)
        self.runs = {"first": kernel_run, "second": rounded}
        inputs, of_rounded = ((run.start, run.parameters) for run in self.runs.values())
        self.same = inputs == of_rounded
        self._proved: dict[str, Links | None] = {}
        self._asked: AskedRun | None = None
        self._working: Working | None = None
        self._made: dict[str, Links] = {}

    @property
    def seconds(self) -> float:
        """Since it was begun."""
        return clock() - self._begun

    def take(self, run: AskedRun) -> None:
        """The first link is what comes of this run, as long as its digits do."""
        self._asked = run
        self.digits["first"] = run.digits

    def proved(self, name: str) -> Links | None:
        """The `first` link or the `second` to its digits, where a proof gives it; made once."""
        if name not in self._proved:
            exact = _map_for_parameters(self.step_map, self.runs[name])
            self._proved[name] = self.way.proved(self.runs[name], exact, self.digits[name])
        return self._proved[name]

    def working(self) -> Course[Working]:
        """The run in float64, exact arithmetic beside it, done once; Stopped where it leaves its
        range."""
        if self._working is None:
            self._working = yield from self._beside()
        return self._working

    def _beside(self) -> Course[Working]:
        """In what can follow float64 everywhere where another cannot, or has no bound of its
        rounding."""
        way, run, wanted = self.way, self.kernel_run, self.digits["beside"]
        mixed = MixedRun(way, run, self.proved("second") is None and run.steps > 1)
        compiled = number_systems.about(self.arithmetic).compiles
        digits = way.digits_beside(run, self.step_map, wanted, compiled)
        asked = number_systems.get(self.system(digits), digits)
        last = last_system().make(working_digits(wanted, run.steps))
        try:
            return (yield from mixed.step_through(asked if asked.rounding else last, self.advance))
        except UnsupportedError:
            return (yield from mixed.step_through(last, self.advance))

    def chains(self) -> Course[EachWay]:
        """The chains of the plain way and those of the closed form."""
        # Before the longer runs: where float64 leaves its range there is nothing to separate.
        working = yield from self.working()
        first = yield from self._link("first")
        second = first if self.same else (yield from self._link("second"))
        shared, parts = [first, second, working.trajectory or second], self.way.parts
        if self.kernel_run.hamiltonian.time_dependent:
            exact = _clock_is_exact(self.runs["second"])
            shared.insert(2, second if exact or working.clock is None else working.clock)
            parts = (parts[0], "clock", *parts[1:])

        def chains(*links: Links) -> tuple[Chain, ...]:
            each = zip(*shared, *links, strict=True)
            return tuple(Chain(self.marks, entry, parts) for entry in each)

        plain = chains(working.factors, working.plain)
        if working.closed_factors is None or working.closed_form is None:
            return plain, None
        return plain, chains(working.closed_factors, working.closed_form)

    def to_digits(self, digits: int) -> Course[EachWay]:
        """The chains, whose links are made again as long as some lack digits: how many the
        differences cancel is known once they are there."""
        for attempt in range(_ATTEMPTS):
            plain, closed = yield from self.chains()
            short = lacking([*plain, *(closed or ())], digits, self.way.hidden)
            if not self.refine(short, attempt):
                break
        return plain, closed

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
                self._proved.pop(name, None)
        if wanted["beside"]:
            self._working = None
        return any(wanted.values())

    def system(self, digits: int) -> str:
        """The arithmetic for so many digits: one that compiles takes ever longer to do it."""
        asked = number_systems.about(self.arithmetic)
        return asked.name if digits <= asked.most_digits else last_system().name

    def _link(self, name: str) -> Course[Links]:
        """The `first` or the `second`, as a proof gives it, or a run."""
        return self.proved(name) or (yield from self._reference(name))

    def _reference(self, name: str) -> Course[Links]:
        if name not in self._made:
            digits, asked, kernel_run = self.digits[name], self._asked, self.runs[name]
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

    def _in_exact_stead(self, kernel_run: KernelRun, digits: int, measured: Measured) -> Links:
        """A run to so many digits; Stopped where a run cannot give them."""
        bounds, run, observable = measured.bounds, measured.outcome, self.way.observable
        if bounds.status != "finished":
            reason = f"in exact arithmetic: {bounds.method}"
            raise Stopped(bounds.status, bounds.failed_step, reason)
        value, bound = bounds.values[observable]
        kind: Kind = "enclosed" if bounds.rigorous else "estimated"
        # A rigorous bound is the run's own, and the last value's is the greatest. An estimate may
        # be that of a run with more digits; the checkpoints must be those of a run that agrees
        # with it.
        more = working_digits(digits, kernel_run.steps)
        for _ in range(_DOUBLINGS):
            done = run.done == kernel_run.steps
            if done and abs(run.values[observable] - value) <= bound:
                return links_of(self.way.values(run, value), bound, kind, bounds.method)
            more *= 2
            run = kernel_run.run(last_system().make(more))
        raise Stopped("unresolved", None, f"in exact arithmetic: {bounds.method}")


def last_system() -> NumberSystem:
    """The number system that has every range and function."""
    return number_systems.automatic()[-1]


def _clock_is_exact(rounded: KernelRun) -> bool:
    """Whether t ← t + h rounds nothing in any step: all times are few multiples of one 2^−k."""
    first, h = rounded.start["t"], rounded.start["h"]
    unit = Fraction(1, max(first.denominator, h.denominator))  # of float64s, powers of 2
    latest = max(abs(first), abs(first + rounded.steps * h))
    return latest / unit <= _MANTISSAS


def _with_rounded_inputs(kernel_run: KernelRun) -> KernelRun:
    """The same run from the rounded inputs; parameters that the kernel has inside stay exact."""
    rounded, inputs = copy.copy(kernel_run), rounded_inputs(kernel_run)
    rounded.start = {n: Fraction(inputs[n]) for n in kernel_run.start}
    parameters = {n: Fraction(inputs[n]) for n in kernel_run.hamiltonian.parameters}
    rounded.parameters = {**kernel_run.parameters, **parameters}
    return rounded


def _map_for_parameters(exact: StepMap, run: KernelRun) -> StepMap | None:
    """The step map for a run's parameters; None where H is not defined for them."""
    values = {n: run.parameters[n] for n in run.hamiltonian.parameters}
    if values == {n: v for n, v in exact.hamiltonian.values if n in values}:
        return exact
    try:
        return step_map_of(run.hamiltonian.with_values(values), run.scheme)
    except InputError:
        return None
