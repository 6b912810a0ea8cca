"""The whole chain Λ₀ … Λ₄ for one step size, and its parts; see
`verify.studies.separation.separate`.

What is known is not run. Where the proof gives ΔJ ≡ 0, Λ₀, Λ₁ and Λ₂ are exactly 0; where ΔJ does
not depend on (p, q), Λ₀ is a closed form and Λ₂ = Λ₁. Where every input is a float64, Λ₁ = Λ₀;
after one step Λ₂ = Λ₁, for the first ΔJ is taken at the initial value. Equal links are one object,
and the part between them is exactly 0.
"""

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify import lockstep
from verify.arithmetic import AUTO
from verify.arithmetic.exact import magnitude
from verify.arithmetic.number_system import NumberSystem, UnsupportedError
from verify.errors import InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun
from verify.runs.digits_on_demand import choose, measure
from verify.runs.estimated import working_digits
from verify.runs.run import proved
from verify.schemes.step_map import StepMap
from verify.studies.separation.working import (
    POINTS,
    Advance,
    Kind,
    Link,
    Stopped,
    Working,
    WorkingRun,
    exact_link,
    marks_of,
    rounded_inputs,
)

PARTS = ("input", "trajectory", "determinant", "product")  # of rounding, in the chain's order
PARTS_IN_TIME = ("input", "clock", "trajectory", "determinant", "product")
_WHOLES = ("lambda_working", "truncation", "total")
QUANTITIES = (*_WHOLES, *PARTS)
_CANCELLED = 20  # digits that the differences between links cancel, float64's and a few more
_ATTEMPTS = 4
_MANTISSAS = 2**53  # whole numbers up to here are float64s
_DOUBLINGS = 6


@dataclass(frozen=True)
class Chain:
    """Λ₀ … Λ₄ of one way to evaluate Λ in float64, at the numbers of steps in `marks`.

    `parts`: of rounding, one between each link and the next.
    """

    marks: tuple[int, ...]
    links: tuple[Link, ...]
    parts: tuple[str, ...] = PARTS

    @property
    def quantities(self) -> tuple[str, ...]:
        """Λ, truncation, rounding, and its parts."""
        return *_WHOLES, *self.parts

    def trail(self, name: str) -> tuple[tuple[Fraction, ...], Fraction]:
        """A quantity of `quantities` at every checkpoint, and a bound of its error at all of them.

        truncation + all parts = lambda_working, exactly.
        """
        first, last = self._between(name)
        if first is None:
            return last.trail, last.bound
        if first is last:
            return (Fraction(0),) * len(self.marks), Fraction(0)
        differences = tuple(b - a for a, b in zip(first.trail, last.trail, strict=True))
        return differences, first.bound + last.bound

    def final(self, name: str) -> tuple[Fraction, Fraction]:
        """A quantity after the last step, and the bound of its error."""
        first, last = self._between(name)
        if first is None:
            return last.trail[-1], last.bound
        if first is last:
            return Fraction(0), Fraction(0)
        return last.trail[-1] - first.trail[-1], first.bound + last.bound

    def _between(self, name: str) -> tuple[Link | None, Link]:
        before, after = self._ends(name)
        return None if before is None else self.links[before], self.links[after]

    def _ends(self, name: str) -> tuple[int | None, int]:
        """Between which links a quantity lies; None: nothing is before it."""
        if name in self.parts:
            k = self.parts.index(name)
            return k, k + 1
        last = len(self.parts)
        return {"lambda_working": (None, last), "truncation": (None, 0), "total": (0, last)}[name]

    def lacking(self, digits: int, least: Fraction = Fraction(0)) -> list[int]:
        """How many digits each link lacks for those wanted of the parts at its ends.

        A part that is not greater than `least` may stay unknown.
        """
        lacking = [0] * len(self.links)
        for name in self.quantities:
            value, bound = self.final(name)
            if not (abs(value) > least and bound):
                continue
            allowed = abs(value) / (4 * Fraction(10) ** digits)
            for k in (end for end in self._ends(name) if end is not None):
                own = self.links[k].bound
                if own > allowed:
                    lacking[k] = max(lacking[k], magnitude(own / allowed) + 1)
        return lacking

    @property
    def kind(self) -> Kind:
        """Enclosed where the bound of every link is proved, else estimated."""
        return "enclosed" if all(x.kind == "enclosed" for x in self.links) else "estimated"

    @property
    def methods(self) -> tuple[str, ...]:
        """How the errors of the links were bounded, the last one's apart, each way once."""
        return tuple(dict.fromkeys(link.method for link in self.links[:-1]))


@dataclass(frozen=True)
class Chains:
    """The chains of the plain way and of the closed form, which has none where some det J ≤ 0.

    `arithmetic` stood for exact arithmetic.
    """

    plain: Chain
    closed_form: Chain | None
    arithmetic: str
    seconds: float


def separated_chains(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: dict[str, Fraction],
    steps: int,
    digits: int,
    arithmetic: str = AUTO,
    advance: Advance = lambda _: None,
    keeper: Keeper = NOTHING,
) -> Chains:
    """Of a scheme's run from exact inputs, every part to so many digits where that can be had.

    `arithmetic` stands for exact arithmetic; `auto` takes the fastest that can. `advance` is called
    with the steps just done, of three runs of N steps. Raises Stopped where Λ has no value.
    """
    kernel_run = KernelRun(hamiltonian, scheme, start, steps, frozenset({"lambda"}), POINTS, keeper)
    step_map = step_map_of(hamiltonian, scheme)
    begun = lockstep.clock()
    if arithmetic == AUTO:
        arithmetic = choose(kernel_run, digits + _CANCELLED)
    links = _Links(kernel_run, step_map, arithmetic, digits + _CANCELLED, advance)
    # How many digits the differences cancel is known once they are made: then what lacks some is
    # made again with more.
    for _ in range(_ATTEMPTS):
        plain, closed = links.chains()
        lacking = [chain.lacking(digits) for chain in (plain, closed) if chain]
        if not links.refine([max(each) for each in zip(*lacking, strict=True)]):
            break
    return Chains(plain, closed, arithmetic, lockstep.clock() - begun)


class _Links:
    """The links of a separation, each made when it is asked for, at its own number of digits."""

    def __init__(
        self,
        kernel_run: KernelRun,
        step_map: StepMap,
        arithmetic: str,
        digits: int,
        advance: Advance,
    ) -> None:
        self.kernel_run, self.arithmetic, self.advance = kernel_run, arithmetic, advance
        self.marks = marks_of(kernel_run.steps)
        self.digits = {"first": digits, "second": digits, "beside": digits}
        self.inputs = rounded_inputs(kernel_run)
        self.rounded = with_inputs(kernel_run, self.inputs)
        self.same = (
            self.rounded.start == kernel_run.start
            and self.rounded.parameters == kernel_run.parameters
        )
        self.proved = _proved(step_map, kernel_run, digits)
        self.constant = _proved(_rounded_map(step_map, self.rounded), self.rounded, digits)
        self.made: dict[str, Link] = {}
        self.working: Working | None = None

    def chains(self) -> tuple[Chain, Chain | None]:
        """The chain of the plain way and that of the closed form."""
        # Before the longer runs: where float64 leaves its range there is nothing to separate.
        working = self.working = self.working or self._beside()
        first = self.proved or self._reference(self.kernel_run, "first")
        second = first if self.same else self.constant or self._reference(self.rounded, "second")
        # Both chains share these: only how Λ is evaluated in float64 differs.
        shared = [first, second]
        if self.kernel_run.hamiltonian.time_dependent:
            known = clock_is_exact(self.rounded)
            shared.append(second if known or working.clock is None else working.clock)
        shared.append(working.trajectory or second)
        parts = PARTS_IN_TIME if len(shared) > 3 else PARTS
        plain = Chain(self.marks, (*shared, working.determinant, working.plain), parts)
        fourth, fifth = working.closed_delta_j, working.closed_form
        if fourth is None or fifth is None:
            return plain, None
        return plain, Chain(self.marks, (*shared, fourth, fifth), parts)

    def refine(self, lacking: Sequence[int]) -> bool:
        """Asks for so many more digits of the links; False where no run lacks any."""
        first, second, *beside = lacking
        # One run that serves as two links is made once, with the digits of the one that lacks more.
        if self.same:
            first, second = max(first, second), 0
        wanted = {
            "first": 0 if self.proved else first,
            "second": 0 if self.constant else second,
            "beside": max(beside),
        }
        self.advance = lambda _: None  # what was foreseen is done
        for name, more in wanted.items():
            if more:
                self.digits[name] += more + 2
                self.made.pop(name, None)
        if wanted["beside"]:
            self.working = None
        return any(wanted.values())

    def _beside(self) -> Working:
        """The float64 run with exact arithmetic beside it, in what can follow it everywhere where
        another cannot, or has no bound of its rounding."""
        run = WorkingRun(
            self.kernel_run, self.inputs, self.constant is None and self.kernel_run.steps > 1
        )
        digits = working_digits(self.digits["beside"], self.kernel_run.steps)
        asked, last = number_systems.get(self._name(digits), digits), last_system().make(digits)
        try:
            return run.step_through(asked if asked.rounding else last, self.advance)
        except UnsupportedError:
            return run.step_through(last, self.advance)

    def _reference(self, kernel_run: KernelRun, name: str) -> Link:
        if name not in self.made:
            digits = self.digits[name]
            self.made[name] = _reference(kernel_run, self._name(digits), digits, self.advance)
        return self.made[name]

    def _name(self, digits: int) -> str:
        """The arithmetic for so many digits: one that compiles takes ever longer to do it."""
        asked = number_systems.about(self.arithmetic)
        return asked.name if digits <= asked.most_digits else last_system().name


def last_system() -> NumberSystem:
    """The number system that has every range and function."""
    return number_systems.automatic()[-1]


def clock_is_exact(rounded: KernelRun) -> bool:
    """Whether t ← t + h rounds nothing in any step: all times are few multiples of one 2^−k."""
    first, h = rounded.start["t"], rounded.start["h"]
    unit = Fraction(1, max(first.denominator, h.denominator))  # of float64s, powers of 2
    latest = max(abs(first), abs(first + rounded.steps * h))
    return latest / unit <= _MANTISSAS


def _proved(step_map: StepMap | None, kernel_run: KernelRun, digits: int) -> Link | None:
    """Λ at every checkpoint where a proof gives it, which is where ΔJ is a constant."""
    h, marks, digits = (
        kernel_run.start["h"],
        marks_of(kernel_run.steps),
        digits + len(str(kernel_run.steps)),
    )
    if step_map is None or "lambda" not in proved(step_map, h, 1, digits):
        return None
    if step_map.preserves_area:
        return exact_link([Fraction(0)] * len(marks), "ΔJ ≡ 0")
    found = [proved(step_map, h, n, digits)["lambda"] for n in marks]
    worst = max(bound for _, bound in found)
    return Link(tuple(x for x, _ in found), worst, "enclosed", "ΔJ is constant")


def with_inputs(kernel_run: KernelRun, inputs: dict[str, float]) -> KernelRun:
    """The same run from the rounded inputs; parameters that the kernel has inside stay exact."""
    rounded = copy.copy(kernel_run)
    rounded.start = {n: Fraction(inputs[n]) for n in kernel_run.start}
    parameters = {n: Fraction(inputs[n]) for n in kernel_run.hamiltonian.parameters}
    rounded.parameters = {**kernel_run.parameters, **parameters}
    return rounded


def _rounded_map(exact: StepMap, rounded: KernelRun) -> StepMap | None:
    """The step map for the rounded parameters; None where H is not defined for them."""
    values = {n: rounded.parameters[n] for n in rounded.hamiltonian.parameters}
    if values == {n: v for n, v in exact.hamiltonian.values if n in values}:
        return exact
    try:
        return step_map_of(rounded.hamiltonian.with_values(values), rounded.scheme)
    except InputError:
        return None


def _reference(kernel_run: KernelRun, arithmetic: str, digits: int, advance: Advance) -> Link:
    """Λ in exact arithmetic's stead, to so many digits; Stopped where a run cannot give it."""
    last = 0

    def progress(done: int) -> None:
        nonlocal last
        advance(max(done - last, 0))
        last = max(done, last)

    measured = measure(kernel_run, arithmetic, digits, progress)
    found, run = measured.bounds, measured.outcome
    if found.status != "finished":
        reason = f"in exact arithmetic: {found.method}"
        raise Stopped(found.status, found.failed_step, reason)
    value, bound = found.values["lambda"]
    # A rigorous bound is the run's own, and the last value's is the greatest. An estimate may be
    # that of a run with more digits; the checkpoints must be those of a run that agrees with it.
    more = working_digits(digits, kernel_run.steps)
    for _ in range(_DOUBLINGS):
        if run.done == kernel_run.steps and abs(run.values["lambda"] - value) <= bound:
            trail = (*(x["lambda"] for x in run.trail[:-1]), value)
            kind: Kind = "enclosed" if found.rigorous else "estimated"
            return Link(trail, bound, kind, found.method)
        more *= 2
        run = kernel_run.run(last_system().make(more))
    raise Stopped("unresolved", None, f"in exact arithmetic: {found.method}")
