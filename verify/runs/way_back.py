"""The way back: N steps forward, turned by ρ, N steps, turned; the distance from the start.

The text `-h` in place of ρ means N steps forward and N steps of −h.

With rigorous bounds of both runs the bound is rigorous: the second run starts in a box that
contains ρ of the exact state, and its certificate has the size of the box as an error of the start.
Without them the whole way is gone in two precisions, and the bound is an estimate.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import flint

from verify import arithmetic as number_systems
from verify import observables as kinds
from verify.algebra.embedding import embed
from verify.algebra.enclosure import Enclosures
from verify.algebra.formula import parse, symbol
from verify.arithmetic.arb import bounds, is_representable, make_ball, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import float64, mpfr
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import Course
from verify.runs.digits_on_demand import choose, measure
from verify.runs.estimates import BoundedValues, digits_of, working_digits
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

BY_STEP = "-h"
_MORE_DIGITS = 15
_TRUE_DIGITS = 25  # of the run that a float64 run is held against
_GUARD_BITS = 64
Bounded = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Reflection:
    """An involution ρ of the coordinates, by formulas; the identity where the steps are turned."""

    names: tuple[str, ...]
    structure: Reversible | Symmetric

    @classmethod
    def read(cls, hamiltonian: Hamiltonian, text: str) -> "Reflection":
        """Return ρ from its formulas. Raises InputError for a bad one."""
        if text == BY_STEP:
            return cls(hamiltonian.coordinates, Symmetric("symmetric", "symmetric"))
        if hamiltonian.time_dependent:
            raise InputError("way_back", text, "is of systems that do not depend on t")
        names = hamiltonian.coordinates
        formulas = tuple(parse(x, names, source="way_back") for x in text.split(","))
        structure = Reversible("reversible", f"reversible by ({text})", formulas)
        if mistake := structure.mistake(names):
            raise InputError("way_back", text, mistake)
        return cls(names, structure)

    @cached_property
    def _enclosures(self) -> Enclosures:
        images = tuple(map(symbol, self.names))
        if isinstance(self.structure, Reversible):
            images = self.structure.reflection
        return Enclosures(*embed(images, self.names))

    def reflect(self, box: Mapping[str, Bounded], bits: int) -> BoundedValues | None:
        """Return ρ of a box, as a box; None if ρ may be undefined in it. The coordinates of a box
        are in their order, by any names."""
        with working_precision(bits):
            pairs = zip(self.names, box.values(), strict=True)
            balls = self._enclosures.enclose_over({n: make_ball(*x) for n, x in pairs})
        if balls is None or not all(map(is_representable, balls)):
            return None
        return dict(zip(box, map(midpoint_and_radius, balls), strict=True))

    def return_run(self, run: KernelRun, box: BoundedValues) -> KernelRun:
        """Return the run back from a box, which ρ has turned."""
        back, h = run.from_box(box), run.start["h"]
        if isinstance(self.structure, Symmetric):
            back.start = back.start | {"h": -h, "t": run.start.get("t", 0) + run.steps * h}
        return back


def ways_back(hamiltonian: Hamiltonian, names: Iterable[str]) -> dict[str, Reflection]:
    """Return the reflections of the ways back among the named observables, by their names."""
    ways = (observable for observable in kinds.select({*names}) if not observable.of_one_run)
    return {x.name: Reflection.read(hamiltonian, x.name.partition(":")[2].strip()) for x in ways}


@dataclass(frozen=True)
class WayBack:
    """The distance with its bound; None if the run did not come back."""

    value: Bounded | None
    rigorous: bool = False


def measure_way_back(
    run: KernelRun, reflection: Reflection, name: str, digits: int, end: BoundedValues | None
) -> Course[WayBack]:
    """Measure the way back of a run in the number system `name`.

    `end`: its last state, where its bounds are rigorous. A float64 run has its own distance, with
    that from the true one as its bound.
    """
    run = run.with_observables(frozenset())
    if name == float64.NAME:
        binary = yield from _go(run, reflection, number_systems.get(name, digits))
        true = yield from _measure(run, reflection, choose(run, _TRUE_DIGITS), _TRUE_DIGITS, None)
        if binary is None or true.value is None:
            return WayBack(None)
        value, bound = true.value
        return WayBack((binary, abs(binary - value) + bound), true.rigorous)
    return (yield from _measure(run, reflection, name, digits, end))


def _measure(
    run: KernelRun, reflection: Reflection, name: str, digits: int, end: BoundedValues | None
) -> Course[WayBack]:
    if not run.certifiable:
        return (yield from _estimate(run, reflection, digits))
    # A box of the size that the first run leaves may grow too wide on the way back.
    for wanted in (digits, 2 * digits, 4 * digits):
        if end is None or wanted > digits:
            forward = (yield from measure(run, name, wanted)).bounds
            end = forward.values if forward.rigorous and forward.values else None
        bits = 4 * wanted + _GUARD_BITS
        turned = reflection.reflect({n: end[n] for n in run.coordinates}, bits) if end else None
        if turned is None:
            break
        back = (yield from measure(reflection.return_run(run, turned), name, digits)).bounds
        last = reflection.reflect(back.values, bits) if back.rigorous and back.values else None
        if last is not None:
            return WayBack(_distance(run, last, bits), rigorous=True)
    return (yield from _estimate(run, reflection, digits))


def _estimate(run: KernelRun, reflection: Reflection, digits: int) -> Course[WayBack]:
    coarse = mpfr.make(working_digits(digits, run.steps))
    fine = mpfr.make(digits_of(coarse) + _MORE_DIGITS)
    first = yield from _go(run, reflection, coarse)
    second = yield from _go(run, reflection, fine)
    if first is None or second is None:
        return WayBack(None)
    return WayBack((second, abs(first - second)))


def _go(run: KernelRun, reflection: Reflection, arithmetic: Arithmetic) -> Course[Fraction | None]:
    """Go there and back in one arithmetic; return the distance of the last numbers."""
    outcome = yield from run.run_in_turn(arithmetic)
    bits = arithmetic.bits + _GUARD_BITS
    box: BoundedValues | None = None
    for back in (True, False):
        if outcome.done < run.steps:
            return None
        box = reflection.reflect(
            {n: (outcome.values[n], Fraction(0)) for n in run.coordinates}, bits
        )
        if box is None:
            return None
        if back:
            exact_box = {n: (x, Fraction(0)) for n, (x, _) in box.items()}
            outcome = yield from reflection.return_run(run, exact_box).run_in_turn(arithmetic)
    return _distance(run, box, bits)[0] if box else None


def _distance(run: KernelRun, box: BoundedValues, bits: int) -> Bounded:
    """Return the Euclidean distance of a box from the start of the run."""
    with working_precision(bits):
        balls = (make_ball(x - run.start[n], error) for n, (x, error) in box.items())
        square = sum((x * x for x in balls), flint.arb(0))
        if square > 0:
            return midpoint_and_radius(square.sqrt())
        return Fraction(0), bounds(square.abs_upper().sqrt())[1]
