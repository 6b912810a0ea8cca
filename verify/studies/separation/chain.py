"""The whole chain Λ₀ … Λ₄ for one step size, and its parts; see
`verify.studies.separation.separate`.

What is known is not run. Where the proof gives ΔJ ≡ 0, Λ₀, Λ₁ and Λ₂ are exactly 0; where ΔJ does
not depend on (p, q), Λ₀ is a closed form and Λ₂ = Λ₁. Where every input is a float64, Λ₁ = Λ₀;
after one step Λ₂ = Λ₁, for the first ΔJ is taken at the initial value.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.arithmetic.exact import magnitude
from verify.arithmetic.number_system import UnsupportedError
from verify.errors import InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import common_power, step_map_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course
from verify.runs.estimated import working_digits
from verify.runs.run import AskedRun, proved
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation.links import AsLink, LinksOnDemand, last_system
from verify.studies.separation.mixed_run import POINTS, Advance, marks_of
from verify.studies.separation.trail import Trail
from verify.studies.separation.working import Kind, Link, Working, WorkingRun, exact_link

PARTS = ("input", "trajectory", "determinant", "product")  # of rounding, in the chain's order
PARTS_IN_TIME = ("input", "clock", "trajectory", "determinant", "product")
_LAMBDA = ("lambda",)
_WHOLES = ("lambda_working", "truncation", "total")
QUANTITIES = (*_WHOLES, *PARTS)
# Digits that the differences between links cancel: float64's 16, less those by which a long run
# magnifies what is rounded. Where more cancel the link is made again.
CANCELLED = 14


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

    def trail(self, name: str) -> tuple[Trail, Fraction]:
        """A quantity of `quantities` at every checkpoint, and a bound of its error at all of them.

        truncation + all parts = lambda_working, exactly.
        """
        first, last = self._between(name)
        if first is None:
            return last.trail, last.bound
        if first is last:
            return Trail((0,) * len(self.marks), 1), Fraction(0)
        return last.trail - first.trail, first.bound + last.bound

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
    run: AskedRun | None = None,
) -> Course[Chains]:
    """Of a scheme's run from exact inputs, every part to so many digits where that can be had.

    `arithmetic` stands for exact arithmetic; `auto` takes the fastest that can. `advance` is called
    with the steps just done, of three runs of N steps. `run`, of these steps and checkpoints, is
    taken for the first link. Raises Stopped where Λ has no value.
    """
    kernel_run = KernelRun(hamiltonian, scheme, start, steps, frozenset({"lambda"}), POINTS, keeper)
    step_map = step_map_of(hamiltonian, scheme)
    links = _AreaLinks(kernel_run, step_map, arithmetic, digits + CANCELLED, advance)
    if run is not None:
        links.take(run)
    plain, closed = yield from links.to_digits(
        links.chains, lambda found: lacking(filter(None, found), digits)
    )
    return Chains(plain, closed, links.arithmetic, links.seconds)


def lacking(chains: Iterable[Chain], digits: int, least: Fraction = Fraction(0)) -> list[int]:
    """How many digits each link lacks, for the chain in which it lacks most."""
    return [max(each) for each in zip(*(x.lacking(digits, least) for x in chains), strict=True)]


class _AreaLinks(LinksOnDemand[Link, Working[Link]]):
    """The links of Λ."""

    observable = "lambda"

    def __init__(
        self,
        kernel_run: KernelRun,
        step_map: StepMap,
        arithmetic: str,
        digits: int,
        advance: Advance,
    ) -> None:
        super().__init__(kernel_run, arithmetic, digits, advance)
        self._step_map = step_map

    def of_proof(self, name: str) -> Link | None:
        """Λ where ΔJ is a constant."""
        run, step_map = self.kernel_run, self._step_map
        if name == "first":
            return _proved(step_map, run, self.digits[name])
        return _proved(_rounded_map(step_map, self.rounded), self.rounded, self.digits[name])

    def chains(self) -> Course[tuple[Chain, Chain | None]]:
        """The chain of the plain way and that of the closed form."""
        shared = yield from self.shared()
        working = yield from self.working()
        parts = PARTS_IN_TIME if self.kernel_run.hamiltonian.time_dependent else PARTS
        plain = Chain(self.marks, (*shared, working.factors, working.plain), parts)
        fourth, fifth = working.closed_factors, working.closed_form
        if fourth is None or fifth is None:
            return plain, None
        return plain, Chain(self.marks, (*shared, fourth, fifth), parts)

    def beside(self) -> Course[Working[Link]]:
        """In what can follow float64 everywhere where another cannot, or has no bound of its
        rounding."""
        run = WorkingRun(
            self.kernel_run,
            self.inputs,
            self.proved("second") is None and self.kernel_run.steps > 1,
        )
        digits = self._digits_beside()
        asked = number_systems.get(self.system(digits), digits)
        last = last_system().make(working_digits(self.digits["beside"], self.kernel_run.steps))
        try:
            own = asked if asked.rounding else last
            return (yield from run.step_through(own, self.advance))
        except UnsupportedError:
            return (yield from run.step_through(last, self.advance))

    def _digits_beside(self) -> int:
        """After the point: a compiled kernel takes the longer the more there are."""
        wanted, steps = self.digits["beside"], self.kernel_run.steps
        if not number_systems.about(self.arithmetic).compiles:
            return working_digits(wanted, steps)
        # Along given states only the number of roundings grows; a step's are below 10^6 units.
        size = self.kernel_run.start["h"] ** _power_of_area(self._step_map, self.kernel_run.scheme)
        return wanted + max(0, -magnitude(size)) + len(str(steps)) + 6

    def read(self, run: Outcome, last: Fraction, as_link: AsLink) -> Link:
        """Λ at every checkpoint, and `last` at the end."""
        return as_link((*(x["lambda"] for x in run.trail[:-1]), last))


def _power_of_area(step_map: StepMap, scheme: str) -> int:
    """By about which power of h Λ is small: r − 1 where ΔJ has h^r, as far as that is seen."""
    if step_map.preserves_area:
        return 0
    seen = common_power(step_map)
    return seen - 1 if seen else 1 + (get(scheme).order or 0)


def _proved(step_map: StepMap | None, kernel_run: KernelRun, digits: int) -> Link | None:
    """Λ at every checkpoint where a proof gives it, which is where ΔJ is a constant."""
    h, marks, digits = (
        kernel_run.start["h"],
        marks_of(kernel_run.steps),
        digits + len(str(kernel_run.steps)),
    )
    if step_map is None or not proved(step_map, _LAMBDA, h, 1, digits):
        return None
    if step_map.preserves_area:
        return exact_link([Fraction(0)] * len(marks), "ΔJ ≡ 0")
    found = [proved(step_map, _LAMBDA, h, n, digits)["lambda"] for n in marks]
    worst = max(bound for _, bound in found)
    return Link(Trail.of(x for x, _ in found), worst, "enclosed", "ΔJ is constant")


def _rounded_map(exact: StepMap, rounded: KernelRun) -> StepMap | None:
    """The step map for the rounded parameters; None where H is not defined for them."""
    values = {n: rounded.parameters[n] for n in rounded.hamiltonian.parameters}
    if values == {n: v for n, v in exact.hamiltonian.values if n in values}:
        return exact
    try:
        return step_map_of(rounded.hamiltonian.with_values(values), rounded.scheme)
    except InputError:
        return None
