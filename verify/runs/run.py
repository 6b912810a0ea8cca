"""One run: N steps from (q, p) in one arithmetic, each value with its error bound.

How the bounds are got is told in `verify.runs.a_posteriori`, where they are rigorous, and otherwise
in `verify.runs.estimated`; for float64, which is under test, in `verify.runs.float64`.

What a proof already gives is not run: where ΔJ ≡ 0, ΔJ, MSE and Λ are exactly 0; where ΔJ does not
depend on (p, q), Λ = (1 + ΔJ)^N − 1 is enclosed by ball arithmetic.

Whether a run has left where H is defined: a scheme may step over a pole, or beyond it.

Störmer-Verlet of log(q) evaluates 1/q, which is defined for q < 0 as well; no solution goes there.
What is looked at are the states that the run has noted, so that what lies between two of them is
not seen.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

from verify import arithmetic as number_systems
from verify import observables as kinds
from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import in_reach, middle_and_radius
from verify.arithmetic.exact import Exact, positive, rational, text, whole
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.systems import ball, float64
from verify.errors import InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of
from verify.hamiltonians.times_on_the_way import check_times
from verify.kernels.chunked_loop import Progress
from verify.kernels.run_inputs import SECTIONS
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.lockstep import Course, alone
from verify.runs.digits_on_demand import Measured, choose, measure
from verify.runs.estimated import Bounded, Bounds
from verify.runs.float64 import bounded
from verify.runs.start import Start
from verify.scenes.observables import check_observables, observed
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult
from verify.scenes.values import AUTO, MAX_DIGITS, MAX_STEPS
from verify.schemes import canonical
from verify.schemes.maps.step_map import StepMap

_MOST = 64  # states that are looked at


def left_domain(hamiltonian: Hamiltonian, run: KernelRun, outcome: Outcome) -> str:
    """By which step it has, and what then no longer holds; empty where none is seen to."""
    domain, start, count = hamiltonian.domain, run.start, len(outcome.trail)
    if not domain.requirements or not count:
        return ""
    signs = domain.signs(start)
    for k in _looked_at(count):
        done = min(k * run.section, run.steps)
        note = outcome.trail[k - 1]
        state = {name: note[name] for name in hamiltonian.coordinates}
        left = domain.left_since(signs, {**state, "t": start["t"] + done * start["h"]})
        if left:
            return f"by step {done} the orbit has left where H is defined: {', '.join(left)}"
    return ""


def _looked_at(count: int) -> list[int]:
    """The numbers of some notes, the last among them."""
    return sorted({-(-count * k // _MOST) for k in range(1, _MOST + 1)})


class AskedRun:
    """A run as it is asked for: what a proof gives of it, and the steps that give the rest."""

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        *,
        q: Given,
        p: Given,
        step_size: Exact,
        steps: int,
        t0: Exact = 0,
        arithmetic: str = float64.NAME,
        digits: int = 17,
        observables: Sequence[str] | None = None,
        points: int = 0,
        sections: int = SECTIONS,
        shares_kernel: bool = False,
        keeper: Keeper = NOTHING,
    ) -> None:
        """See `run`, which takes the same arguments."""
        scheme = canonical(scheme)
        h = positive(step_size, "step_size")
        self.begun = Start(hamiltonian, scheme, h, point_of(hamiltonian, q, p), rational(t0, "t0"))
        self.steps, self.digits = steps, digits
        self.wanted = observed(hamiltonian, observables)
        check(hamiltonian, steps, digits, self.wanted)
        whole("points", points, 0)
        step_map = step_map_of(hamiltonian, scheme)
        looked_at = {*self.wanted, *(("lambda",) if points else ())}
        self.known = proved(step_map, looked_at, h, steps, digits)
        needed = frozenset(o for o in self.wanted if o not in self.known)
        self.kernel_run = KernelRun(
            hamiltonian,
            scheme,
            self.begun.inputs,
            steps,
            needed | _series_needs(self.known, points),
            points,
            keeper,
            sections,
            shares_kernel,
        )
        self._arithmetic = arithmetic
        self._measured: Measured | None = None

    @cached_property
    def arithmetic(self) -> str:
        """The one that it is done in."""
        asked = self._arithmetic
        return choose(self.kernel_run, self.digits) if asked == AUTO else asked

    def measured(self, progress: Progress | None = None) -> Course[Measured]:
        """All steps, done once; `progress` is called with the number of those done."""
        if self._measured is None:
            self._measured = yield from self._step(progress)
        return self._measured

    def _step(self, progress: Progress | None) -> Course[Measured]:
        begun, run = self.begun, self.kernel_run
        check_times(begun.hamiltonian, begun.t0, begun.step_size, self.steps)
        if self.arithmetic != float64.NAME:
            return (yield from measure(run, self.arithmetic, self.digits, progress))
        first = run.run(number_systems.get(self.arithmetic, self.digits), progress=progress)
        return Measured((yield from bounded(run, first, self.known)), self.arithmetic, first)

    @property
    def done(self) -> bool:
        """Whether its steps were done."""
        return self._measured is not None

    def result(self, progress: Progress | None = None) -> Course[RunResult]:
        """What is told of it."""
        done = yield from self.measured(progress)
        left = left_domain(self.begun.hamiltonian, self.kernel_run, done.outcome)
        return self._told(done, left)

    def proved(self) -> RunResult | None:
        """The observables without any step, and without p and q, where a proof gives all of them;
        of a run that is asked for p and q alone it gives none."""
        if not self.wanted or not set(self.wanted) <= set(self.known):
            return None
        found = Bounds({}, "a proof, and no run", rigorous=True)
        return self._told(Measured(found, ball.NAME, Outcome()))

    def _told(self, done: Measured, left: str = "") -> RunResult:
        """What was found of the run, and what was known of it by a proof."""
        begun, found, known = self.begun, done.bounds, self.known
        most = min(self.digits, number_systems.about(done.arithmetic).digits or self.digits)
        names = (*begun.point, *self.wanted)
        values = {n: Value.of(*found.values[n], most) for n in names if n in found.values}
        if found.status == "finished":
            values |= {n: Value.of(*known[n], self.digits) for n in self.wanted if n in known}
        return RunResult(
            **begun.hamiltonian.texts,
            scheme=begun.scheme,
            arithmetic=done.arithmetic,
            fallback=done.fallback,
            left_domain=left,
            digits=self.digits,
            step_size=text(begun.step_size),
            steps=self.steps,
            q=begun.text("q"),
            p=begun.text("p"),
            t0=text(begun.t0),
            status=found.status,
            failed_step=found.failed_step,
            values=values,
            error_kind="enclosed" if found.rigorous else "estimated",
            error_method=found.method,
            exact=tuple(o for o in self.wanted if o in known),
            series=done.outcome.series,
            seconds=done.outcome.seconds,
        )


def run(
    hamiltonian: Hamiltonian, scheme: str, *, progress: Progress | None = None, **asked: Any
) -> RunResult:
    """Run `steps` steps of `step_size` from (q, p) and report p, q and the observables.

    `q`, `p`: a number each; in n degrees of freedom a list each. `t0`: when it starts, of an H that
    depends on time. `arithmetic`: one of `verify.arithmetic.names()`, or `auto` for the fastest
    with rigorous bounds. `digits`: significant digits wanted (float64 gives what it knows).
    `observables`: where they are left out, those of `verify.scenes.observables` for so many
    degrees. `points`: at most so many points of a thinned series are kept. `sections`: else the
    state is noted so often. `progress` is called with the number of steps done. `keeper` keeps
    checkpoints, from which an interrupted run goes on. `shares_kernel`: see
    `verify.kernels.run_inputs`. Raises InputError for h ≤ 0, N < 1, a parameter without a value,
    unknown names, lists of another length.
    """
    return alone(AskedRun(hamiltonian, scheme, **asked).result(progress))


def check(hamiltonian: Hamiltonian, steps: int, digits: int, observables: Sequence[str]) -> None:
    """Raises InputError for what no run is made of: a parameter without value, out of range."""
    if hamiltonian.symbols:
        name = hamiltonian.symbols[0]
        raise InputError("parameter", name, f"has no value; a run needs one, as {name}=1")
    for name, value, most in (("steps", steps, MAX_STEPS), ("digits", digits, MAX_DIGITS)):
        whole(name, value, 1, most)
    check_observables(hamiltonian, observables)


def _series_needs(known: Mapping[str, object], points: int) -> frozenset[str]:
    return frozenset({"extremes"}) if points and "lambda" not in known else frozenset()


# -- what a proof gives ---------------------------------------------------------------------------


def proved(
    step_map: StepMap, asked: Iterable[str], h: Fraction, steps: int, digits: int
) -> Bounded:
    """Those of the observables with their bounds for which no run is needed."""
    every = {name: kinds.by_name()[name] for name in asked}
    zero = Fraction(0), Fraction(0)
    known = {name: zero for name, each in every.items() if each.vanishes(step_map)}
    constant = {name: each.constant for name, each in every.items() if each.constant}
    if step_map.preserves_area or not constant or step_map.uniform_delta_j is None:
        return known
    bits = int(4 * digits) + 64 + 2 * steps.bit_length()
    delta_j = enclose(step_map.flat.ring, step_map.uniform_delta_j, {"h": h}, bits)
    if delta_j is None:
        return known
    with working_precision(bits):
        found = {name: of(delta_j, steps) for name, of in constant.items()}
        return known | {n: middle_and_radius(x) for n, x in found.items() if x and in_reach(x)}
