"""The scatter of runs by rounding: how far copies of them part that are pushed a little.

In the plane each copy starts with h, the parameters and the initial value multiplied by 1 + ξ·ε,
|ξ| ≤ 1. After every step p and q are multiplied by 1 + ξ·ε, and so is the count of a clock, since a
program's own clock adds up t ← t + h. The distance of the copies, divided by ε, is the factor of an
arithmetic's unit roundoff. ε is small, since only small errors add up: an angle of 10⁸ is pushed by
10⁸·ε. In half of the copies ξ is drawn anew for each step, as roundings behave; in the others it
stays the same, the worst case of roundings that always fall to one side. A program's operations
differ from ours, but their results are of the size of p and q or smaller.

In n degrees of freedom fewer runs are made: a run is repeated in float64 from points that differ a
little in one coordinate each. Their distance tells how far a rounding at the start is carried; a
later one is taken to be carried no farther than the farthest so far, in any row up to the present
one. A program that computes S, W or Λ from the entries of a Jacobian rounds their products, however
small S, W or Λ is: the columns of these runs are its entries.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from verify.arithmetic.float_context import WIDE
from verify.arithmetic.number_system import UnsupportedError
from verify.arithmetic.systems import float64
from verify.errors import InputError
from verify.flows.extrapolation_of_many import arrays
from verify.kernels.kernel import clock_inputs, kernel_for
from verify.kernels.stepping import KernelRun
from verify.reference.compare.table_agreement import DOUBLE
from verify.runs.run_start import Start
from verify.structures import AREA, SYMPLECTIC

_PUSH = 2.0**-42 if WIDE.prec > 60 else 2.0**-32  # ε; numbers have at least 20 bits below it
_COPIES = 16  # copies of each kind
_ALL_COPIES = 2 * _COPIES + 1  # the one in the middle is not pushed
_MAX_STEPS = 20_000  # steps that are followed; beyond them growth is extrapolated
_LARGE = 1e-3  # relative to a value: larger errors do not just add up, and give no spread
_BLOCK = 64  # steps whose random numbers are drawn at once
_ORBITS_AT_ONCE = 64
_SUMS = {AREA: frozenset({"mse", "lambda"}), SYMPLECTIC: frozenset({"lambda"})}
_COUNT = "step"  # the name of the count of a kernel's clock


@dataclass(frozen=True)
class Spread:
    """The distance by which rounding moves a number, usually and at worst.

    From a scatter it is in units of roundoff, from an allowance absolute.
    """

    usual: float | Fraction
    worst: float | Fraction


Spreads = Mapping[str, Spread]  # the key is the number's column


def run_of(orbit: Start, steps: int = 1, observed: Iterable[str] = ()) -> KernelRun:
    """Return a run of `steps` steps of the orbit, with the observables `observed`.

    Without these it has Λ and, in the plane, the MSE.
    """
    hamiltonian = orbit.hamiltonian
    observables = frozenset(observed) or _SUMS[hamiltonian.structure]
    return KernelRun(hamiltonian, orbit.scheme, orbit.inputs, steps, observables, 0)


class Scatter:
    """The copies of some orbits of one scheme and one H, whose parameters may differ.

    They step together on request; the spreads at the steps `marks` are stored on the way.
    """

    def __init__(self, orbits: Sequence[Start], marks: Sequence[int] = ()) -> None:
        """Raises UnsupportedError for a scheme that solves equations."""
        runs = [run_of(orbit) for orbit in orbits]
        if runs[0].implicit:
            raise UnsupportedError("equations are not solved for many points at once")
        # A fixed seed: verdicts must not change from run to run.
        self._random = np.random.default_rng(0)
        arithmetic = arrays()
        kernel = kernel_for(
            runs[0].hamiltonian, orbits[0].scheme, arithmetic, runs[0].observables, False
        )
        self._names, self._function = kernel.state_names, kernel.function
        self._pushed = ("p", "q", *([_COUNT] if kernel.timed else []))
        self._shape = len(orbits), _ALL_COPIES
        clocks = clock_inputs if kernel.timed else lambda *_: {}
        inputs = [run.inputs(kernel, 0) | clocks(arithmetic, run.start) for run in runs]
        columns = zip(*(run.values() for run in inputs), strict=True)
        self._inputs = [self._off(column) for column in columns]
        self._state = {n: self._off([run.point[n] for run in orbits]) for n in ("p", "q")}
        rest_of_state = zip(self._names[2:], kernel.start, strict=True)
        self._state |= {
            n: np.full(self._shape, WIDE.rational(Fraction(x))) for n, x in rest_of_state
        }
        self._biased = self._draw(())
        self._ahead: list[Any] = []
        self._done, self._marks = 0, frozenset(marks)
        self._spreads_by_step: dict[int, list[Spreads | None]] = {}

    def spreads_at(self, orbit: int, step: int) -> Spreads | None:
        """Return the spreads of an orbit after `step` steps.

        None if its copies have left every range, or are far apart by then. Raises ValueError for an
        earlier step that is no mark.
        """
        if step not in self._spreads_by_step:
            if self._done > min(step, _MAX_STEPS):
                raise ValueError(step)
            with np.errstate(all="ignore"):
                self._go_to(step)
        return self._spreads_by_step[step][orbit]

    def _go_to(self, step: int) -> None:
        while self._done < min(step, _MAX_STEPS):
            if self._done in self._marks and self._done not in self._spreads_by_step:
                self._spreads_by_step[self._done] = self._spreads(self._done)
            self._advance()
        self._spreads_by_step[step] = self._spreads(step)

    def _advance(self) -> None:
        if not self._ahead:
            self._ahead = list(self._draw((_BLOCK,)))
        push = self._ahead.pop()
        # The second half of the copies has the same factors in every step.
        push[..., _COPIES:] = self._biased[..., _COPIES:]
        self._state = self._step(self._state)
        for name, factor in zip(self._pushed, push, strict=True):
            self._state[name] = self._state[name] * factor
        self._done += 1

    def _step(self, state: Mapping[str, Any]) -> dict[str, Any]:
        _, *after = self._function(1, *self._inputs, *(state[n] for n in self._names))
        return dict(zip(self._names, after, strict=True))

    def _draw(self, shape: tuple[int, ...]) -> Any:
        """Draw factors for the numbers of each copy that are perturbed; the middle copy is not."""
        many = (*shape, len(self._pushed), *self._shape)
        factors = self._random.uniform(1 - _PUSH, 1 + _PUSH, many)
        factors[..., _COPIES] = 1
        return factors

    def _off(self, column: Sequence[Fraction]) -> Any:
        exact = np.array([WIDE.rational(x) for x in column])
        return exact[:, None] * self._draw(())[0]

    def _spreads(self, step: int) -> list[Spreads | None]:
        zero = {n: np.zeros(self._shape) for n in ("lam", "mse") if n in self._state}
        after = self._step(self._state | zero)
        values = self._state | ({"delta_j": after["lam"]} if "lam" in after else {})
        distances = {n: self._distances(x) for n, x in values.items()}
        size = np.maximum(*(np.abs(self._state[n][:, _COPIES]) for n in ("p", "q")))
        # Random roundings of the frequency give a phase error that grows as N√N, roundings to one
        # side one that grows as N²: this extrapolates beyond the steps that were run.
        growth = max(1.0, step / _MAX_STEPS)
        spreads: list[Spreads | None] = []
        for k in range(self._shape[0]):
            by_column = {
                ("lambda" if n == "lam" else n): Spread(
                    float(usual[k]) * growth**1.5, float(worst[k]) * growth**2
                )
                for n, (usual, worst) in distances.items()
            }
            finite = all(math.isfinite(y) for x in by_column.values() for y in (x.usual, x.worst))
            far = max(by_column[n].worst for n in ("p", "q")) * _PUSH > _LARGE * float(size[k])
            spreads.append(by_column if finite and not far else None)
        return spreads

    def _distances(self, values: Any) -> tuple[Any, Any]:
        values = np.broadcast_to(values, self._shape)
        apart = np.abs(values - values[:, _COPIES : _COPIES + 1]) / _PUSH
        return apart[:, :_COPIES].max(axis=1), apart.max(axis=1)


# -- in n degrees of freedom -----------------------------------------------------------------------

_OFF = Fraction(1, 2**24)  # of the orbit's size: what is carried has 20 digits of bits beside it
_AT_WORST = 4  # times what is carried, for each step
_BEYOND_SUMS = Fraction(1, 1000)  # of the orbit's size: beyond it errors do not just add up
_OBSERVED = ("symplectic_defect_max", "symplectic_defect", "lambda")
_ZERO = Fraction(0)


@dataclass(frozen=True)
class _Row:
    """A row: the orbit's size up to it, what a rounding of that size at the start has become, by
    column, and the greatest of a Jacobian's entries."""

    size: Fraction
    carried: Mapping[str, Fraction]
    entry: Fraction


class CarriedRounding:
    """The spreads of one orbit in n degrees of freedom."""

    def __init__(self, orbit: Start) -> None:
        self._orbit = orbit
        self._rows: dict[int, _Row | None] = {}

    def spreads_at(self, step: int) -> Spreads | None:
        """Return the spreads after so many steps; None if rounding may have taken every digit
        of the state, or if that is not known."""
        if step not in self._rows:
            self._rows[step] = self._row(step)
        row, names = self._rows[step], self._orbit.hamiltonian.coordinates
        if row is None:
            return None
        rows = [x for n, x in self._rows.items() if n <= step and x is not None]
        carried = {n: max(x.carried.get(n, _ZERO) for x in rows) for n in (*names, *_OBSERVED)}
        if any(DOUBLE * step * carried[name] > _BEYOND_SUMS * row.size for name in names):
            return None
        near_one = Fraction(4 * self._orbit.hamiltonian.degrees)  # a step's Jacobian
        of_all = max(x.entry for x in rows) ** 2
        products = dict.fromkeys(names, _ZERO) | {
            "symplectic_defect_max": near_one, "symplectic_defect": of_all, "lambda": of_all,
        }  # fmt: skip
        many = 1 + math.isqrt(step)
        return {
            name: Spread(
                many * (carried_size + products[name]),
                _AT_WORST * (step + 1) * carried_size + many**2 * products[name] / 2,
            )
            for name, carried_size in carried.items()
        }

    def _row(self, step: int) -> _Row | None:
        orbit = self._orbit
        start = orbit.point
        if step == 0:
            return _Row(max(map(abs, start.values())), {}, Fraction(1))
        middle = self._after(start, step) if step <= _MAX_STEPS else None
        if middle is None:
            return None
        size = max(abs(x) for name in start for x in (start[name], middle[name]))
        offset = _OFF * (size or 1)
        carried, entry = dict.fromkeys(middle, _ZERO), Fraction(1)
        for name in start:
            shifted = self._after({**start, name: start[name] + offset}, step)
            if shifted is None:
                return None
            # Difference quotients: the Jacobian of N steps, column by column.
            slopes = {n: abs(shifted[n] - middle[n]) / offset for n in middle}
            entry = max(entry, *(slopes[n] for n in start))
            carried = {n: x + slopes[n] * size for n, x in carried.items()}
        return _Row(size, carried, entry)

    def _after(self, point: Mapping[str, Fraction], steps: int) -> dict[str, Fraction] | None:
        """Return the numbers after so many steps from a point; None if they cannot be
        computed."""
        run = run_of(replace(self._orbit, point=point), steps, _OBSERVED)
        try:
            done = run.run(float64.make(17))
        except (InputError, ArithmeticError):
            return None
        return dict(done.values) if done.done == steps else None


# -- the scatters of a table -----------------------------------------------------------------------


class Scatters:
    """The scatters of a table's orbits, each made when it is first needed, with others of its
    kind; other orbits have one of their own."""

    def __init__(self, orbits: Iterable[Start] = (), marks: Sequence[int] = ()) -> None:
        self._carried_by_orbit: dict[Start, CarriedRounding] = {}
        self._place: dict[Start, tuple[tuple[Start, ...], int]] = {}
        self._marks = marks
        self._scatters: dict[tuple[Start, ...], Scatter] = {}
        self.expect(orbits)

    def expect(self, orbits: Iterable[Start]) -> None:
        """Announce orbits that may be requested, so that new ones of a kind step together."""
        kinds: dict[object, list[Start]] = {}
        for orbit in dict.fromkeys(orbits):
            if orbit not in self._place:
                kinds.setdefault((orbit.hamiltonian.expression, orbit.scheme), []).append(orbit)
        for kind in kinds.values():
            for first in range(0, len(kind), _ORBITS_AT_ONCE):
                together = tuple(kind[first : first + _ORBITS_AT_ONCE])
                self._place |= {orbit: (together, k) for k, orbit in enumerate(together)}

    def spreads_at(self, orbit: Start, step: int) -> Spreads | None:
        """Return the spreads as `Scatter.spreads_at` does, in any order; of no number if the
        scheme solves equations, unless in n degrees of freedom."""
        if not orbit.hamiltonian.planar:
            return self._carried_by_orbit.setdefault(orbit, CarriedRounding(orbit)).spreads_at(step)
        together, k = self._place.get(orbit, ((orbit,), 0))
        try:
            if together not in self._scatters:
                self._scatters[together] = Scatter(together, self._marks)
            return self._scatters[together].spreads_at(k, step)
        except (UnsupportedError, OverflowError):  # OverflowError: of an input that is no double
            return {}
        except ValueError:  # it was passed
            self._place[orbit] = (orbit,), 0
            self._scatters[(orbit,)] = Scatter([orbit], self._marks)
            return self._scatters[(orbit,)].spreads_at(0, step)
