"""The whole chain Λ₀ … Λ₄ for one step size, and its parts; see `verify.separation`.

What is known is not run. Where the proof gives ΔJ ≡ 0, Λ₀, Λ₁ and Λ₂ are exactly 0; where ΔJ does
not depend on (p, q), Λ₀ is a closed form and Λ₂ = Λ₁. Where every input is a float64, Λ₁ = Λ₀;
after one step Λ₂ = Λ₁, for the first ΔJ is taken at the initial value. Equal links are one object,
and the part between them is exactly 0.
"""

import copy
import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from verify import arithmetic as number_systems
from verify.bounds import bounded, working_digits
from verify.errors import InputError
from verify.exact import magnitude
from verify.hamiltonian import Hamiltonian
from verify.runs import proved
from verify.schemes import get
from verify.separation_working import (
    POINTS,
    Kind,
    Link,
    Stopped,
    WorkingRun,
    exact_link,
    rounded_inputs,
)
from verify.separation_working import marks as marks_of
from verify.step_map import StepMap
from verify.stepping import Job

PARTS = ("input", "trajectory", "determinant", "product")  # of rounding, in the chain's order
_ENDS: dict[str, tuple[int | None, int]] = {  # between which links a quantity lies
    "lambda_working": (None, 4),
    "truncation": (None, 0),
    "total": (0, 4),
    **{name: (k, k + 1) for k, name in enumerate(PARTS)},
}
QUANTITIES = tuple(_ENDS)
_CANCELLED = 20  # digits that the differences between links cancel, float64's and a few more
_ATTEMPTS = 3
_DOUBLINGS = 6


@dataclass(frozen=True)
class Chain:
    """Λ₀ … Λ₄ of one way to evaluate Λ in float64, at the numbers of steps in `marks`."""

    marks: tuple[int, ...]
    links: tuple[Link, Link, Link, Link, Link]

    def trail(self, name: str) -> tuple[tuple[Fraction, ...], Fraction]:
        """A quantity of `QUANTITIES` at every checkpoint, and a bound of its error at all of them.

        truncation + input + trajectory + determinant + product = lambda_working, exactly.
        """
        before, after = _ENDS[name]
        last = self.links[after]
        if before is None:
            return last.trail, last.bound
        first = self.links[before]
        if first is last:
            return tuple(Fraction(0) for _ in self.marks), Fraction(0)
        differences = tuple(b - a for a, b in zip(first.trail, last.trail, strict=True))
        return differences, first.bound + last.bound

    def final(self, name: str) -> tuple[Fraction, Fraction]:
        """A quantity after the last step, and the bound of its error."""
        trail, bound = self.trail(name)
        return trail[-1], bound

    @property
    def kind(self) -> Kind:
        return "enclosed" if all(x.kind == "enclosed" for x in self.links) else "estimated"


@dataclass(frozen=True)
class Chains:
    """The chains of the plain way and of the closed form, which has none where some det J ≤ 0."""

    plain: Chain
    closed_form: Chain | None
    seconds: float

    @cached_property
    def methods(self) -> tuple[str, ...]:
        """How the errors of Λ₀, Λ₁, Λ₂ and Λ₃ were bounded."""
        return tuple(link.method for link in self.plain.links[:4])


class Separation:
    """What is separated: a scheme's run of `steps` steps from exact inputs."""

    def __init__(
        self, hamiltonian: Hamiltonian, scheme: str, start: dict[str, Fraction], steps: int
    ) -> None:
        self.job = Job(hamiltonian, scheme, start, steps, frozenset({"lambda"}), POINTS)
        self.map = get(scheme).step_map(hamiltonian)
        self.marks = marks_of(steps)

    def chains(
        self, arithmetic: str, digits: int, advance: Callable[[int], None] = lambda _: None
    ) -> Chains:
        """Every part to so many digits where that can be had; raises Stopped where Λ has no value.

        `arithmetic` stands for exact arithmetic. `advance` is called with the steps just done, of
        three runs of N steps.
        """
        wanted, begun = digits + _CANCELLED, time.perf_counter()
        for _ in range(_ATTEMPTS):
            plain, closed = self._links(arithmetic, wanted, advance)
            missing = max(_missing(chain, digits) for chain in (plain, closed) if chain)
            if missing <= 0:
                break
            wanted, advance = wanted + missing + 5, lambda _: None
        return Chains(plain, closed, time.perf_counter() - begun)

    def _links(
        self, arithmetic: str, digits: int, advance: Callable[[int], None]
    ) -> tuple[Chain, Chain | None]:
        inputs = rounded_inputs(self.job)
        rounded = _rounded(self.job, inputs)
        same = rounded.start == self.job.start and rounded.parameters == self.job.parameters
        constant = self._proved(_rounded_map(self.map, rounded), rounded.start["h"], digits)
        exact = self._proved(self.map, self.job.start["h"], digits)

        own = number_systems.get(arithmetic, working_digits(digits, self.job.steps))
        follow = constant is None and self.job.steps > 1
        # Before the longer runs: where float64 leaves its range there is nothing to separate.
        working = WorkingRun(self.job, inputs, follow).go(own, advance)
        first = exact or _reference(self.job, arithmetic, digits, advance)
        second = first if same else constant or _reference(rounded, arithmetic, digits, advance)
        third = working.trajectory or second
        plain = Chain(self.marks, (first, second, third, working.determinant, working.plain))
        fourth, fifth = working.closed_delta_j, working.closed_form
        if fourth is None or fifth is None:
            return plain, None
        return plain, Chain(self.marks, (first, second, third, fourth, fifth))

    def _proved(self, step_map: StepMap | None, h: Fraction, digits: int) -> Link | None:
        """Λ at every checkpoint where a proof gives it, which is where ΔJ is a constant."""
        if step_map is None or "lambda" not in proved(step_map, h, 1, digits):
            return None
        if step_map.preserves_area:
            return exact_link([Fraction(0)] * len(self.marks), "ΔJ ≡ 0")
        found = [proved(step_map, h, n, digits)["lambda"] for n in self.marks]
        worst = max(bound for _, bound in found)
        return Link(tuple(x for x, _ in found), worst, "enclosed", "ΔJ is constant")


def _rounded(job: Job, inputs: dict[str, float]) -> Job:
    """The same job from the rounded inputs; parameters that the kernel has inside stay exact."""
    rounded = copy.copy(job)
    rounded.start = {n: Fraction(inputs[n]) for n in job.start}
    parameters = {n: Fraction(inputs[n]) for n in job.generic.parameters}
    rounded.parameters = {**job.parameters, **parameters}
    return rounded


def _rounded_map(exact: StepMap, rounded: Job) -> StepMap | None:
    """The step map for the rounded parameters; None where H is not defined for them."""
    values = {n: rounded.parameters[n] for n in rounded.generic.parameters}
    if values == {n: v for n, v in exact.hamiltonian.values if n in values}:
        return exact
    try:
        return get(rounded.scheme).step_map(rounded.generic.with_values(values))
    except InputError:
        return None


def _reference(job: Job, arithmetic: str, digits: int, advance: Callable[[int], None]) -> Link:
    """Λ in exact arithmetic's stead, to so many digits; Stopped where a run cannot give it."""
    own = number_systems.get(arithmetic, working_digits(digits, job.steps))
    last = 0

    def progress(done: int) -> None:
        nonlocal last
        advance(max(done - last, 0))
        last = max(done, last)

    for _ in range(_DOUBLINGS):
        first = job.go(own, progress=progress)
        found = bounded(job, own, first, digits, {})
        if found.status != "finished":
            reason = f"in exact arithmetic: {found.method}"
            raise Stopped(found.status, found.failed_step, reason)
        value, bound = found.values["lambda"]
        # The bound is the last value's; the run's checkpoints share it where it has that value.
        if first.done == job.steps and abs(first.values["lambda"] - value) <= bound:
            trail = (*(x["lambda"] for x in first.trail[:-1]), value)
            return Link(trail, bound, "estimated", found.method)
        own = number_systems.get(arithmetic, 2 * (own.bits * 30103 // 100000))
    raise Stopped("unresolved", None, f"in exact arithmetic: {found.method}")


def _missing(chain: Chain, digits: int) -> int:
    """How many of the digits asked for some part lacks; a part of 0 may stay unknown."""
    lacks = 0
    for name in QUANTITIES:
        value, bound = chain.final(name)
        if value and bound:
            lacks = max(lacks, digits - (magnitude(value) - magnitude(2 * bound)))
    return lacks
