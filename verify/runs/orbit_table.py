"""The states of a run, at every step or thinned: t, p, q, H − H₀, ΔJ, Λ, and W in n degrees.

A float64 run is itself under test, so that its p, q and Λ are printed as the run has them. In any
other arithmetic the states stand for those of exact arithmetic. The run is done twice, with 15 more
digits the second time, at a precision that is raised until the two agree to the requested digits;
a row holds the digits in which they agree. That is an estimate, as in `verify.runs.estimates`.

H − H₀ and ΔJ are those of exact arithmetic at the state in the row, enclosed by balls; if a step
solves equations, ΔJ is computed in mpfr at twice the digits.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

import flint

from verify import arithmetic as number_systems
from verify.algebra.enclosure import Enclosures
from verify.arithmetic.arb import is_representable, make_ball, midpoint_and_radius, rational_ball
from verify.arithmetic.exact import known_text, text, whole
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic, UnsupportedError, bits_for
from verify.arithmetic.systems import ball, float64, mpfr
from verify.errors import InputError
from verify.hamiltonians.canonical_field import energy_of
from verify.kernels.chunked_loop import Progress
from verify.kernels.kernel import clock_inputs, kernel_for
from verify.kernels.notes import Note
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs.digits_on_demand import choose
from verify.runs.estimates import LINEAR, digits_of, spread, working_digits
from verify.runs.run_start import Start
from verify.scenes.observables import accumulated_observables
from verify.scenes.results.run import MOST_POINTS as MOST_POINTS
from verify.scenes.results.run import OrbitTable, RunResult

_ATTEMPTS = 6
_MORE_DIGITS = 15
_GUARD_BITS = 60  # bits that may cancel in H − H₀; if more do, the precision is doubled
_BINARY_NOTE = "p, q and Λ are the numbers of the float64 run, whole"
_AGREEMENT_NOTE = "the digits in which two runs agree"
_ZERO = Fraction(0)
Box = Mapping[str, tuple[Fraction, Fraction]]  # each coordinate's value with a bound of its error


@dataclass(frozen=True)
class _States:
    """The values after each of `steps` steps, with the radii of their errors, 0 if exact."""

    steps: tuple[int, ...]
    notes: tuple[Note, ...]
    radii: tuple[Note, ...]


class _RunStates(NamedTuple):
    """The states that a run of `done` steps noted, with the radii of their errors."""

    arithmetic: Arithmetic
    done: int
    notes: tuple[Note, ...]
    radii: tuple[Note, ...]


def orbit_of(
    result: RunResult, points: int = MOST_POINTS, progress: Progress | None = None
) -> OrbitTable:
    """Return the states of a run: at every step, or at every second, third, … if it is long.

    `points`: the limit of the number of states after the initial one, 1 … 10,000; the last state is
    always among them. If the run left the arithmetic's range, the last finite state is the last.
    The run is done again, in float64 once and else at least twice; `progress` is called with the
    number of steps done. Raises InputError if the digits cannot be confirmed.
    """
    whole("points", points, 1, MOST_POINTS)
    start = Start.from_result(result)
    binary = result.arithmetic == float64.NAME
    states = _collect_states(start, result.steps, points, 0 if binary else result.digits, progress)
    rows = _Rows(start, float64.NUMBER_SYSTEM.digits or 17 if binary else result.digits)
    stride = states.steps[1] if len(states.steps) > 1 else 1
    digits = _BINARY_NOTE if binary else _AGREEMENT_NOTE
    columns = {"lambda": ("delta_j", "lambda")}
    observables = tuple(x for name in rows.observables for x in columns.get(name, (name,)))
    names = tuple(start.point)
    lines, has_energy = tuple(rows.format_rows(states, binary)), rows.energy is not None
    return OrbitTable(lines, stride, digits, names, observables, has_energy)


# -- the states -----------------------------------------------------------------------------------


def _collect_states(
    start: Start, steps: int, points: int, digits: int, progress: Progress | None
) -> _States:
    """Return the states of the run to `digits` digits; 0 stands for the run in float64 itself."""
    inputs = start.inputs
    preserves_area = step_map_of(start.hamiltonian, start.scheme).preserves_area
    observables = (
        frozenset[str]()
        if preserves_area
        else frozenset(accumulated_observables(start.hamiltonian))
    )
    while True:
        run = KernelRun(
            start.hamiltonian, start.scheme, inputs, steps, observables, 0, sections=points
        )
        states = (
            _confirm_states(run, digits, progress) if digits else _run_in_float64(run, progress)
        )
        if states.done == steps or not states.done:
            break
        # The run left the range: a run of fewer steps notes its last finite state as well.
        steps = states.done
    first = start.point if digits else _rounded_start(states.arithmetic, start.point)
    # The stride is rounded up, so that at most `points` states are noted.
    stride = -(-steps // points)
    indices = (0, *(min(k * stride, steps) for k in range(1, len(states.notes) + 1)))
    zeros = dict.fromkeys((*start.point, *accumulated_observables(start.hamiltonian)), _ZERO)
    notes, radii = map(run.in_user_names, states.notes), map(run.in_user_names, states.radii)
    return _States(indices, ({**zeros, **first}, *notes), (zeros, *radii))


def _run_in_float64(run: KernelRun, progress: Progress | None) -> _RunStates:
    arithmetic = number_systems.get(float64.NAME, 17)
    outcome = run.run(arithmetic, progress=progress)
    return _RunStates(arithmetic, outcome.done, outcome.trail, ({},) * len(outcome.trail))


def _rounded_start(arithmetic: Arithmetic, point: Note) -> Note:
    """Return the initial state as the arithmetic rounds it."""
    return {name: Fraction(arithmetic.number(x)) for name, x in point.items()}


def _confirm_states(run: KernelRun, digits: int, progress: Progress | None) -> _RunStates:
    """Return the run's states, with their differences from a run with 15 digits fewer."""
    name, precision = choose(run, digits), working_digits(digits, run.steps)
    for _ in range(_ATTEMPTS):
        arithmetic = number_systems.get(name, precision)
        finer = number_systems.get(name, digits_of(arithmetic) + _MORE_DIGITS)
        try:
            first, second = (run.run(system, progress=progress) for system in (arithmetic, finer))
        except UnsupportedError:
            name = number_systems.automatic()[-1].name
            continue
        if arithmetic.absolute and second.done < run.steps:  # the range of fixed point is limited
            name = number_systems.automatic()[-1].name
            continue
        difference = _difference(first, second)
        if difference is not None and difference <= Fraction(1, 10**digits):
            radii = tuple(_differences(first, second))
            return _RunStates(arithmetic, second.done, second.trail, radii)
        # If the runs follow two orbits, nothing tells how many digits are lost.
        precision = (
            2 * precision if difference is None or difference > LINEAR else precision + digits
        )
    raise InputError("scheme", run.scheme, f"{_ATTEMPTS} reruns of its orbit did not agree")


def _difference(first: RunOutcome, second: RunOutcome) -> Fraction | None:
    """Return the relative difference of two runs; None if they end at different steps."""
    if first.done != second.done:
        return None
    return spread(first, second) if second.trail else Fraction(0)


def _differences(first: RunOutcome, second: RunOutcome) -> Iterator[Note]:
    for a, b in zip(first.trail, second.trail, strict=True):
        yield {name: abs(a[name] - b[name]) for name in b}


# -- the rows -------------------------------------------------------------------------------------


class _Rows:
    """A writer of the rows of one orbit with `digits` digits."""

    def __init__(self, start: Start, digits: int) -> None:
        self.start, self.digits = start, digits
        self.names = tuple(start.point)
        self.energy: Enclosures | None = None
        if start.hamiltonian.has_energy:
            ring, energy = energy_of(start.hamiltonian)
            self.energy = Enclosures(ring, [energy])
        self.observables = accumulated_observables(start.hamiltonian)
        self.delta_j = _DeltaJ(start, digits) if "lambda" in self.observables else None

    def format_rows(self, states: _States, binary: bool) -> Iterator[tuple[str, ...]]:
        """Yield the rows; if `binary`, the states are printed so that they read back unchanged."""
        z_0 = {name: make_ball(states.notes[0][name], _ZERO) for name in self.names}
        # If H depends on time, H − H₀ takes each state at its own time.
        z_0 |= self._time_input(0)
        for k, note, radii in zip(states.steps, states.notes, states.radii, strict=True):
            pairs = {
                n: (note.get(n, _ZERO), radii.get(n, _ZERO))
                for n in (*self.names, *self.observables)
            }
            texts = {
                n: repr(float(x)) if binary else self._format_value(x, r)
                for n, (x, r) in pairs.items()
            }
            box = {n: pairs[n] for n in self.names}
            energy = [self._energy_error(self.energy, box, z_0, k)] if self.energy else []
            change = [self._text(self.delta_j(box, k))] if self.delta_j else []
            state, observables = (
                [texts[n] for n in names] for names in (self.names, self.observables)
            )
            yield text(self._time_of_step(k)), *state, *energy, *change, *observables

    def _time_of_step(self, k: int) -> Fraction:
        return self.start.t0 + k * self.start.step_size

    def _time_input(self, k: int) -> dict[str, flint.arb]:
        """Return the time of step k as an input, if H depends on time."""
        return (
            {"t": rational_ball(self._time_of_step(k))}
            if self.start.hamiltonian.time_dependent
            else {}
        )

    def _energy_error(
        self, energy: Enclosures, box: Box, start: Mapping[str, flint.arb], k: int
    ) -> str:
        """Format H − H₀ in the box; for an exact state the bits double until it has its digits."""
        if k == 0:
            return "0"
        is_exact = not any(radius for _, radius in box.values())
        bits = 4 * self.digits + _GUARD_BITS
        for _ in range(_ATTEMPTS if is_exact else 1):
            with working_precision(bits):
                point = {name: make_ball(*pair) for name, pair in box.items()} | self._time_input(k)
                enclosures = energy.enclose_over(point), energy.enclose_over(start)
                if enclosures[0] is None or enclosures[1] is None:
                    return ""
                difference = enclosures[0][0] - enclosures[1][0]
            if difference == 0 or difference.rel_accuracy_bits() >= bits_for(self.digits):
                break
            # Digits of H − H₀ cancel where the drift is small: more bits bring them back.
            bits *= 2
        return self._text(difference)

    def _text(self, x: flint.arb | None) -> str:
        return (
            self._format_value(*midpoint_and_radius(x))
            if x is not None and is_representable(x)
            else ""
        )

    def _format_value(self, value: Fraction, radius: Fraction) -> str:
        return known_text(value, radius, self.digits)


class _DeltaJ:
    """ΔJ as a function of states: the Λ of one step of a kernel that begins at Λ = 0."""

    def __init__(self, start: Start, digits: int) -> None:
        step_map = step_map_of(start.hamiltonian, start.scheme)
        self.vanishes, self.names = step_map.preserves_area, tuple(start.point)
        self.arithmetic = mpfr.make(2 * digits) if step_map.implicit else ball.make(digits + 25)
        run = KernelRun(start.hamiltonian, start.scheme, start.inputs, 1, frozenset({"lambda"}), 0)
        self.kernel = kernel_for(run.hamiltonian, run.scheme, self.arithmetic, run.observables)
        arguments = run.inputs(self.kernel, 0)
        if self.kernel.timed:
            arguments |= clock_inputs(self.arithmetic, run.start)
        self.inputs = [self.arithmetic.number(x) for x in arguments.values()]

    def __call__(self, box: Box, k: int) -> flint.arb | None:
        """Return a ball that contains the ΔJ of step k from all states in the box.

        A step that solves equations takes the middle of the box alone, and the radius is 0. None if
        ΔJ may be undefined at a state in the box.
        """
        if self.vanishes:
            return flint.arb(0)
        arithmetic = self.arithmetic
        try:
            with arithmetic.context():
                state = [_convert(arithmetic, *box[name]) for name in self.names]
                state += [arithmetic.number(Fraction(k))] if self.kernel.timed else []
                _, *after = self.kernel.function(1, *self.inputs, *state, arithmetic.number(_ZERO))
                delta_j: Any = after[-1]
                return delta_j if arithmetic.radius else make_ball(arithmetic.exact(delta_j), _ZERO)
        except (ArithmeticError, ValueError):  # a pole, or the log or root of a negative number
            return None


def _convert(arithmetic: Arithmetic, value: Fraction, radius: Fraction) -> object:
    return make_ball(value, radius) if arithmetic.radius else arithmetic.number(value)
