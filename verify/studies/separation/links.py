"""The links of a separation, each computed when it is needed, at its own number of digits.

There is a link of Λ, or one for each entry of W. A link that a proof gives is not computed by a
run. Equal links are one object, and the part between them is exactly 0:

- if ΔJ ≡ 0, or S ≡ 0, is proved, Λ₀, Λ₁ and Λ₂ are exactly 0, and the closed form's Λ₃ and Λ₄ too;
- if ΔJ does not depend on (p, q), Λ₀ is a closed form and Λ₂ = Λ₁;
- if every input is a float64, Λ₁ = Λ₀;
- after one step Λ₂ = Λ₁, since the only ΔJ is taken at the initial value.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.arithmetic.number_system import NumberSystem, UnsupportedError
from verify.errors import InputError
from verify.execution.keeper import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun
from verify.lockstep import Course, clock
from verify.runs.digits_on_demand import Measurement, choose, measure
from verify.runs.estimates import working_digits
from verify.runs.requested_run import RequestedRun
from verify.schemes.maps.step_map import StepMap
from verify.structures import AREA, SYMPLECTIC, CanonicalForm
from verify.studies.separation.chain import Chain, Kind, Links, lacking, links_of
from verify.studies.separation.determinants import Determinants
from verify.studies.separation.matrix_products import Matrices
from verify.studies.separation.mixed_run import (
    Advance,
    MixedRun,
    Stopped,
    Working,
    clock_is_exact,
    marks_of,
    round_inputs,
)
from verify.studies.separation.way import Size, Way

_WAYS: dict[CanonicalForm, type[Way]] = {AREA: Determinants, SYMPLECTIC: Matrices}
_DOUBLINGS = 6
_ATTEMPTS = 4
EachWay = tuple[tuple[Chain, ...], tuple[Chain, ...] | None]


@dataclass(frozen=True)
class Chains:
    """The chains of the plain way and of the closed form.

    There is one for Λ, or one for each entry of W above the diagonal. `closed_form` is None if some
    det J ≤ 0. `arithmetic`: the system that stood for exact arithmetic; `sizes`: those of M at the
    checkpoints, empty for Λ.
    """

    plain: tuple[Chain, ...]
    closed_form: tuple[Chain, ...] | None
    sizes: tuple[Size, ...]
    arithmetic: str
    seconds: float


def way_for(hamiltonian: Hamiltonian) -> Way:
    """Return the way in which runs of this H are followed."""
    return _WAYS[hamiltonian.structure](len(hamiltonian.coordinates))


def separate_chains(
    hamiltonian: Hamiltonian,
    scheme: str,
    start: dict[str, Fraction],
    steps: int,
    digits: int,
    arithmetic: str = AUTO,
    advance: Advance = lambda _: None,
    keeper: Keeper = NOTHING,
    run: RequestedRun | None = None,
) -> Course[Chains]:
    """Return the chains of a scheme's run from exact inputs, with `digits` digits if possible.

    `arithmetic` stands for exact arithmetic; `auto` takes the fastest that can. `advance` is called
    with the number of steps just done; three runs of N steps are expected. `run`, a requested run
    of the same steps and checkpoints, serves as the first link. Raises Stopped if Λ, or W, has no
    value.
    """
    way = way_for(hamiltonian)
    kernel_run = KernelRun(
        hamiltonian, scheme, start, steps, way.observables, 0, keeper, sections=way.points
    )
    links = LinksOnDemand(way, kernel_run, step_map_of(hamiltonian, scheme), arithmetic, digits)
    links.advance = advance
    if run is not None:
        links.take(run)
    plain, closed_chains = yield from links.to_digits(digits)
    working = yield from links.working()
    return Chains(plain, closed_chains, working.sizes, links.arithmetic, links.seconds)


class LinksOnDemand:
    """The links of all ways to evaluate, and the digits required of each."""

    def __init__(
        self, way: Way, kernel_run: KernelRun, step_map: StepMap, arithmetic: str, digits: int
    ) -> None:
        """Require `digits` digits of every part; `step_map` has the exact parameters."""
        self._start_time = clock()
        digits += way.cancelled
        self.arithmetic = choose(kernel_run, digits) if arithmetic == AUTO else arithmetic
        self.way, self.kernel_run, self.step_map = way, kernel_run, step_map
        self.advance: Advance = lambda _: None
        self.marks = marks_of(kernel_run.steps, way.points)
        self.digits = {"first": digits, "second": digits, "beside": digits + way.products}
        rounded_run = round_inputs(kernel_run)
        self.runs = {"first": kernel_run, "second": rounded_run}
        inputs, of_rounded = ((run.start, run.parameters) for run in self.runs.values())
        self.has_equal_inputs = inputs == of_rounded
        self._proved_links: dict[str, Links | None] = {}
        self._requested_run: RequestedRun | None = None
        self._working: Working | None = None
        self._link_cache: dict[str, Links] = {}

    @property
    def seconds(self) -> float:
        """The seconds since this object was made."""
        return clock() - self._start_time

    def take(self, run: RequestedRun) -> None:
        """Take the first link from this run, as long as its digits suffice."""
        self._requested_run = run
        self.digits["first"] = run.digits

    def prove_link(self, name: str) -> Links | None:
        """Return the `first` or the `second` link by proof, to its digits; None: no proof."""
        if name not in self._proved_links:
            step_map = _map_for_parameters(self.step_map, self.runs[name])
            self._proved_links[name] = self.way.prove_links(
                self.runs[name], step_map, self.digits[name]
            )
        return self._proved_links[name]

    def working(self) -> Course[Working]:
        """Return the links of the run in float64 with exact arithmetic beside it, done once.

        Raises Stopped if float64 leaves its range.
        """
        if self._working is None:
            self._working = yield from self._run_working()
        return self._working

    def _run_working(self) -> Course[Working]:
        """Do that run; if another system fails or its rounding is not counted, in the last one."""
        way, run, digits_needed = self.way, self.kernel_run, self.digits["beside"]
        # After one step, or with a proof, the exact step at float64's states is not needed.
        mixed_run = MixedRun(way, run, self.prove_link("second") is None and run.steps > 1)
        compiles = number_systems.about(self.arithmetic).compiles
        digits = way.digits_beside(run, self.step_map, digits_needed, compiles)
        arithmetic = number_systems.get(self.system(digits), digits)
        last = last_system().make(working_digits(digits_needed, run.steps))
        try:
            beside = arithmetic if arithmetic.rounding else last
            return (yield from mixed_run.step_through(beside, self.advance))
        except UnsupportedError:
            return (yield from mixed_run.step_through(last, self.advance))

    def chains(self) -> Course[EachWay]:
        """Return the chains of the plain way and those of the closed form."""
        # This run is the first: if float64 leaves its range the longer runs are needless.
        working = yield from self.working()
        first = yield from self._link("first")
        second = first if self.has_equal_inputs else (yield from self._link("second"))
        shared_links, parts = [first, second, working.trajectory or second], self.way.parts
        if self.kernel_run.hamiltonian.time_dependent:
            has_exact_clock = clock_is_exact(self.runs["second"])
            shared_links.insert(
                2, second if has_exact_clock or working.clock is None else working.clock
            )
            parts = (parts[0], "clock", *parts[1:])

        def chains(*links: Links) -> tuple[Chain, ...]:
            links_of_entries = zip(*shared_links, *links, strict=True)
            return tuple(Chain(self.marks, entry, parts) for entry in links_of_entries)

        plain = chains(working.factors, working.plain)
        if working.closed_factors is None or working.closed_form is None:
            return plain, None
        return plain, chains(working.closed_factors, working.closed_form)

    def to_digits(self, digits: int) -> Course[EachWay]:
        """Return the chains, with links computed again, a few times, as long as some lack digits.

        The number of digits that differences cancel is known only once the links are computed.
        """
        for attempt in range(_ATTEMPTS):
            plain, closed_form = yield from self.chains()
            short = lacking([*plain, *(closed_form or ())], digits, self.way.hidden)
            if not self.refine(short, attempt):
                break
        return plain, closed_form

    def refine(self, lacking: Sequence[int], attempt: int = 0) -> bool:
        """Require more digits of the links that lack some; return False if none does.

        A part that is still noise lacks the same number again and again: each attempt doubles it.
        """
        first, second, *beside = lacking
        # One run that serves as two links is made once, with the digits of the one that lacks more.
        if self.has_equal_inputs:
            first, second = max(first, second), 0
        extra_digits = {"first": first, "second": second, "beside": max(beside)}
        self.advance = lambda _: None  # progress counts the expected runs only, which are done
        for name, increase in extra_digits.items():
            if increase:
                # `<<` binds less than `+`: (increase + 2) · 2^attempt.
                self.digits[name] += increase + 2 << attempt
                self._link_cache.pop(name, None)
                self._proved_links.pop(name, None)
        if extra_digits["beside"]:
            self._working = None
        return any(extra_digits.values())

    def system(self, digits: int) -> str:
        """Return the arithmetic's name for so many digits: compiling takes longer with more."""
        system = number_systems.about(self.arithmetic)
        return system.name if digits <= system.most_digits else last_system().name

    def _link(self, name: str) -> Course[Links]:
        """Return the `first` or the `second` link, by proof or by a run."""
        return self.prove_link(name) or (yield from self._reference(name))

    def _reference(self, name: str) -> Course[Links]:
        if name not in self._link_cache:
            digits = self.digits[name]
            requested_run = self._requested_run
            kernel_run = self.runs[name]
            if name == "first" and requested_run and digits <= requested_run.digits:
                measurement = yield from requested_run.take_measurement(self._progress())
                if measurement.bounds.status == "finished":
                    self._link_cache[name] = self._links_from_run(
                        requested_run.kernel_run, digits, measurement
                    )
                    return self._link_cache[name]
            system = self.system(digits)
            measurement = yield from measure(kernel_run, system, digits, self._progress())
            self._link_cache[name] = self._links_from_run(kernel_run, digits, measurement)
        return self._link_cache[name]

    def _progress(self) -> Advance:
        """Return a callback for the steps done in one run; steps that it repeats do not count."""
        last = 0

        def progress(done: int) -> None:
            nonlocal last
            self.advance(max(done - last, 0))
            last = max(done, last)

        return progress

    def _links_from_run(
        self, kernel_run: KernelRun, digits: int, measurement: Measurement
    ) -> Links:
        """Return the links of a run to so many digits. Raises Stopped if it cannot give them."""
        bounds, run, observable = measurement.bounds, measurement.outcome, self.way.observable
        if bounds.status != "finished":
            reason = f"in exact arithmetic: {bounds.method}"
            raise Stopped(bounds.status, bounds.failed_step, reason)
        value, bound = bounds.values[observable]
        kind: Kind = "enclosed" if bounds.rigorous else "estimated"
        # A rigorous bound is the run's own, and the last value's is the greatest. An estimate may
        # be that of a run with more digits: the checkpoints must be of a run that agrees with it.
        run_digits = working_digits(digits, kernel_run.steps)
        for _ in range(_DOUBLINGS):
            done = run.done == kernel_run.steps
            if done and abs(run.values[observable] - value) <= bound:
                return links_of(self.way.values(run, value), bound, kind, bounds.method)
            run_digits *= 2
            run = kernel_run.run(last_system().make(run_digits))
        raise Stopped("unresolved", None, f"in exact arithmetic: {bounds.method}")


def last_system() -> NumberSystem:
    """Return the number system that has every range and function."""
    return number_systems.automatic()[-1]


def _map_for_parameters(step_map: StepMap, run: KernelRun) -> StepMap | None:
    """Return the step map for a run's parameters; None if H is not defined for them."""
    values = {n: run.parameters[n] for n in run.hamiltonian.parameters}
    if values == {n: v for n, v in step_map.hamiltonian.values if n in values}:
        return step_map
    try:
        return step_map_of(run.hamiltonian.with_values(values), run.scheme)
    except InputError:
        return None
