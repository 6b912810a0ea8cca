"""The states of a run, at every step or thinned: t, p, q, H − H₀, ΔJ, Λ and, where it is more, W.

A float64 run's p, q and Λ are the numbers of that run, whole: it is what is under test. In any
other arithmetic the states of exact arithmetic are wanted: the run is done twice, with 15 more
digits the second time, at a precision that is raised until the two agree to the digits asked for,
and a row holds the digits in which they do. That is an estimate, as in `verify.runs.estimated`.

H − H₀ and ΔJ are those of exact arithmetic at the state in the row, enclosed by balls; where a step
solves equations ΔJ is found with mpfr at twice the digits.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint

from verify import arithmetic as number_systems
from verify.algebra.enclosure import Enclosures
from verify.arithmetic.arb import around, in_reach, middle_and_radius, rational_ball
from verify.arithmetic.exact import known_text, text, whole
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic, UnsupportedError, bits_for
from verify.arithmetic.systems import ball, float64, mpfr
from verify.errors import InputError
from verify.hamiltonians.canonical_field import energy_of
from verify.kernels.chunked_loop import Note, Progress
from verify.kernels.clock import clock_inputs
from verify.kernels.kernel import kernel_for
from verify.kernels.step.computation import step_map_of
from verify.kernels.stepping import KernelRun, Outcome
from verify.runs.digits_on_demand import choose
from verify.runs.estimated import LINEAR, digits_of, spread, working_digits
from verify.runs.start import Start
from verify.scenes.observables import accumulated
from verify.scenes.results.orbit import MOST_POINTS as MOST_POINTS
from verify.scenes.results.orbit import OrbitTable
from verify.scenes.results.run import RunResult

_ATTEMPTS = 6
_MORE_DIGITS = 15
_GUARD = 60  # bits, of what cancels in H − H₀; beyond, twice as many are tried
_BINARY = "p, q and Λ are the numbers of the float64 run, whole"
_AGREED = "the digits in which two runs agree"
_ZERO = Fraction(0)
Box = Mapping[str, tuple[Fraction, Fraction]]  # p and q, each with how far it may be off


@dataclass(frozen=True)
class _States:
    """What is carried, at the steps `at`, with how far it may be off; 0 where it is what it is."""

    at: tuple[int, ...]
    notes: tuple[Note, ...]
    radii: tuple[Note, ...]


def orbit_of(
    result: RunResult, points: int = MOST_POINTS, progress: Progress | None = None
) -> OrbitTable:
    """The states of a run: every step up to `points` of them, then every second, third, …

    `points`: so many states after the initial one at most, 1 … 10,000; the last state is always
    among them. Of a run that left the arithmetic's range: the states up to its last finite one.
    The run is done again, or twice; `progress` is called with the number of steps done. Raises
    InputError where no digits of it can be confirmed.
    """
    whole("points", points, 1, MOST_POINTS)
    orbit = Start.of(result)
    binary = result.arithmetic == float64.NAME
    states = _states(orbit, result.steps, points, 0 if binary else result.digits, progress)
    rows = _Rows(orbit, float64.NUMBER_SYSTEM.digits or 17 if binary else result.digits)
    every = states.at[1] if len(states.at) > 1 else 1
    digits = _BINARY if binary else _AGREED
    shown = {"lambda": ("delta_j", "lambda")}
    observables = tuple(x for name in rows.observed for x in shown.get(name, (name,)))
    names = tuple(orbit.point)
    return OrbitTable(tuple(rows.of(states, binary)), every, digits, names, observables)


# -- the states -----------------------------------------------------------------------------------


def _states(
    orbit: Start, steps: int, points: int, digits: int, progress: Progress | None
) -> _States:
    """The states of the run; in float64 where no digits are asked for."""
    start = orbit.inputs
    nothing_lost = step_map_of(orbit.hamiltonian, orbit.scheme).preserves_area
    asked = frozenset[str]() if nothing_lost else frozenset(accumulated(orbit.hamiltonian))
    while True:
        run = KernelRun(orbit.hamiltonian, orbit.scheme, start, steps, asked, 0, sections=points)
        found = _confirmed(run, digits, progress) if digits else _binary(run, progress)
        own, done, notes, radii = found
        if done == steps or not done:
            break
        steps = done  # it left the range; so that its last finite state is noted as well
    first = orbit.point if digits else _first(own, orbit.point)
    every = -(-steps // points)
    at = (0, *(min(k * every, steps) for k in range(1, len(notes) + 1)))
    nothing = dict.fromkeys((*orbit.point, *accumulated(orbit.hamiltonian)), _ZERO)
    return _States(at, ({**nothing, **first}, *notes), (nothing, *radii))


Found = tuple[Arithmetic, int, tuple[Note, ...], tuple[Note, ...]]


def _binary(run: KernelRun, progress: Progress | None) -> Found:
    own = number_systems.get(float64.NAME, 17)
    outcome = run.run(own, progress=progress)
    return own, outcome.done, outcome.trail, ({},) * len(outcome.trail)


def _first(own: Arithmetic, point: Note) -> Note:
    """The initial state as the arithmetic has it."""
    return {name: Fraction(own.number(x)) for name, x in point.items()}


def _confirmed(run: KernelRun, digits: int, progress: Progress | None) -> Found:
    """The run, and by how much it differs from one with fewer digits."""
    name, wanted = choose(run, digits), working_digits(digits, run.steps)
    for _ in range(_ATTEMPTS):
        own = number_systems.get(name, wanted)
        finer = number_systems.get(name, digits_of(own) + _MORE_DIGITS)
        try:
            first, second = (run.run(each, progress=progress) for each in (own, finer))
        except UnsupportedError:
            name = number_systems.automatic()[-1].name
            continue
        if own.absolute and second.done < run.steps:  # of a limited range
            name = number_systems.automatic()[-1].name
            continue
        apart = _apart(first, second)
        if apart is not None and apart <= Fraction(1, 10**digits):
            return own, second.done, second.trail, tuple(_differences(first, second))
        # Two orbits, and not one with errors: nothing tells how many digits are lost.
        wanted = 2 * wanted if apart is None or apart > LINEAR else wanted + digits
    raise InputError("scheme", run.scheme, f"{_ATTEMPTS} reruns of its orbit did not agree")


def _apart(first: Outcome, second: Outcome) -> Fraction | None:
    """How far the two are apart, relative to the orbit's size; None where they end elsewhere."""
    if first.done != second.done:
        return None
    return spread(first, second) if second.trail else Fraction(0)


def _differences(first: Outcome, second: Outcome) -> Iterator[Note]:
    for a, b in zip(first.trail, second.trail, strict=True):
        yield {name: abs(a[name] - b[name]) for name in b}


# -- the rows -------------------------------------------------------------------------------------


class _Rows:
    """Writes the rows of one orbit with so many digits."""

    def __init__(self, orbit: Start, digits: int) -> None:
        self.orbit, self.digits = orbit, digits
        self.names = tuple(orbit.point)
        ring, energy = energy_of(orbit.hamiltonian)
        self.energy = Enclosures(ring, [energy])
        self.observed = accumulated(orbit.hamiltonian)
        self.delta_j = _DeltaJ(orbit, digits) if "lambda" in self.observed else None

    def of(self, states: _States, binary: bool) -> Iterator[tuple[str, ...]]:
        """The rows; in `binary` a number is written so that it is read back to the same double."""
        z_0 = {name: around(states.notes[0][name], _ZERO) for name in self.names}
        z_0 |= self._time(0)
        for k, note, radii in zip(states.at, states.notes, states.radii, strict=True):
            pairs = {
                n: (note.get(n, _ZERO), radii.get(n, _ZERO)) for n in (*self.names, *self.observed)
            }
            shown = {
                n: repr(float(x)) if binary else self._known(x, r) for n, (x, r) in pairs.items()
            }
            box = {n: pairs[n] for n in self.names}
            energy = self._energy_error(box, z_0, k) if k else "0"
            change = [self._text(self.delta_j(box, k))] if self.delta_j else []
            state, others = ([shown[n] for n in names] for names in (self.names, self.observed))
            yield text(self._at(k)), *state, energy, *change, *others

    def _at(self, k: int) -> Fraction:
        return self.orbit.t0 + k * self.orbit.step_size

    def _time(self, k: int) -> dict[str, flint.arb]:
        """The time of step k, for an H that depends on it."""
        return {"t": rational_ball(self._at(k))} if self.orbit.hamiltonian.time_dependent else {}

    def _energy_error(self, box: Box, start: Mapping[str, flint.arb], k: int) -> str:
        """H − H₀ in the box, with more bits as long as they give digits that are missing."""
        exact = not any(radius for _, radius in box.values())
        bits = 4 * self.digits + _GUARD
        for _ in range(_ATTEMPTS if exact else 1):
            with working_precision(bits):
                at = {name: around(*pair) for name, pair in box.items()} | self._time(k)
                both = self.energy.over(at), self.energy.over(start)
                if both[0] is None or both[1] is None:
                    return ""
                found = both[0][0] - both[1][0]
            if found == 0 or found.rel_accuracy_bits() >= bits_for(self.digits):
                break
            bits *= 2
        return self._text(found)

    def _text(self, x: flint.arb | None) -> str:
        return self._known(*middle_and_radius(x)) if x is not None and in_reach(x) else ""

    def _known(self, value: Fraction, radius: Fraction) -> str:
        return known_text(value, radius, self.digits)


class _DeltaJ:
    """ΔJ at states, by one step of a kernel from Λ = 0: Λ is ΔJ after it."""

    def __init__(self, orbit: Start, digits: int) -> None:
        step_map = step_map_of(orbit.hamiltonian, orbit.scheme)
        self.vanishes, self.names = step_map.preserves_area, tuple(orbit.point)
        self.own = mpfr.make(2 * digits) if step_map.implicit else ball.make(digits + 25)
        run = KernelRun(orbit.hamiltonian, orbit.scheme, orbit.inputs, 1, frozenset({"lambda"}), 0)
        self.kernel = kernel_for(run.hamiltonian, run.scheme, self.own, run.observables)
        given = run.inputs(self.kernel, 0)
        if self.kernel.timed:
            given |= clock_inputs(self.own, run.start)
        self.inputs = [self.own.number(x) for x in given.values()]

    def __call__(self, box: Box, k: int) -> flint.arb | None:
        """A ball with the ΔJ of step k from all states in the box; None where one may not be
        defined."""
        if self.vanishes:
            return flint.arb(0)
        own = self.own
        try:
            with own.context():
                state = [_in(own, *box[name]) for name in self.names]
                state += [own.number(Fraction(k))] if self.kernel.timed else []
                _, *after = self.kernel.function(1, *self.inputs, *state, own.number(_ZERO))
                found: Any = after[-1]
                return found if own.radius else around(own.exact(found), _ZERO)
        except (ArithmeticError, ValueError):  # a pole, the log or root of a negative
            return None


def _in(own: Arithmetic, value: Fraction, radius: Fraction) -> object:
    return around(value, radius) if own.radius else own.number(value)
