"""A drawn scene as properties use it: H, scheme, step size, start, t₀ and N."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import inf
from typing import Any, NamedTuple, Self

from verify import arithmetic as number_systems
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.flows.extrapolation import NumericalFlow
from verify.functions.function import CIRCLE
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of, start_texts
from verify.kernels.run_inputs import DEFAULT_SECTIONS
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import Potential, potential_of
from verify.proof.proof_for_one_h import Proof
from verify.scenes.scene import Scene
from verify.scenes.values import start_arguments
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures import AREA, SYMPLECTIC


class TermLimits(NamedTuple):
    """The greatest numbers of terms for which each computation still takes only a moment.

    `proof`: a proof; `kernels`: writing a kernel; `points`: evaluating the map at a few points;
    `step`: a single step. `unproved`: True if kernels are written even if the map is too long for a
    proof; `runs`: True if claims on runs are tested.
    """

    proof: int
    kernels: int
    points: int
    step: float
    unproved: bool
    runs: bool


# In the plane the terms of the map are counted, in n degrees of freedom those of its slopes: see
# `Sample.terms`.
_TERM_LIMITS = {
    AREA: TermLimits(40, 20, 150, inf, unproved=False, runs=True),
    SYMPLECTIC: TermLimits(30, 60, 250, 250, unproved=True, runs=False),
}
_MAX_SERIES_ORDER = 4  # of a scheme in n degrees of freedom, whose series a proof computes
# The kinds of generators whose series have few terms.
_KINDS_WITH_SHORT_SERIES = {"variable", CIRCLE.odd, CIRCLE.even}


@dataclass(frozen=True)
class Sample:
    """A drawn scene; its map and its proof are computed once for all properties.

    `place`: the coordinates at the start, in their order.
    """

    hamiltonian: Hamiltonian
    scheme: Scheme
    step_size: Fraction
    steps: int
    t0: Fraction
    scene: Scene
    place: tuple[Fraction, ...]

    @classmethod
    def from_scene(cls, scene: Scene) -> Self:
        """Take the first scheme, step size and initial value of a scene that has a [grid].

        Raises InputError for a scene without [grid], or with a start that does not fit its H.
        """
        if scene.grid is None:
            raise InputError("scene", scene.name, "has no [grid], which gives step and start")
        if scene.field is not None:
            raise InputError("scene", scene.name, "has no H, of which all properties are")
        h, start = scene.grid.step_sizes[0], scene.grid.initial_values[0]
        hamiltonian = scene.exact_hamiltonian()
        return cls(
            hamiltonian=hamiltonian,
            scheme=get(scene.schemes[0]),
            step_size=h,
            steps=scene.grid.steps_for(h),
            t0=scene.t0,
            scene=scene,
            place=tuple(point_of(hamiltonian, **start_arguments(start, of_field=False)).values()),
        )

    def with_place(self, place: Iterable[Fraction]) -> Self:
        """Return the sample with another start, whose coordinates are given in their order."""
        return replace(self, place=tuple(place))

    @property
    def point(self) -> dict[str, Fraction]:
        """The coordinates at the start, by name."""
        return dict(zip(self.hamiltonian.coordinates, self.place, strict=True))

    @cached_property
    def step_map(self) -> StepMap:
        """The map of one step for this H, to be used only where the sample is `brief`."""
        return self.scheme.step_map(self.hamiltonian)

    @cached_property
    def proof(self) -> Proof:
        """The proof about the map: its orders, and the leading coefficient of its defect."""
        return prove(self.step_map, self.scheme)

    @cached_property
    def potential(self) -> Potential | None:
        """The potential of the leading coefficient of ΔJ; None in n degrees of freedom."""
        # Linear algebra over monomials looks for G in the plane alone.
        return potential_of(self.proof, self.scheme) if self.hamiltonian.planar else None

    # -- how long it is ---------------------------------------------------------------------------

    @property
    def limits(self) -> TermLimits:
        """The limits of terms for its number of degrees of freedom."""
        return _TERM_LIMITS[self.hamiltonian.structure]

    @cached_property
    def terms(self) -> float:
        """The number of terms of its map, or in n degrees of freedom of its slopes.

        For a Taylor series in n degrees of freedom the terms of all powers are counted, one power
        after the other; it is infinite as soon as they are too many.
        """
        if self.hamiltonian.planar:
            return self.step_map.terms
        field, generic = self.field, self.scheme.every_h
        total: float = sum(map(len, field.slopes))
        if not isinstance(generic, TaylorSeries):
            return total
        # The limit is tested before each power: a power of many terms alone may take minutes.
        for n in range(2, generic.eta + 1):
            if total > self.limits.points:
                return inf
            total += sum(map(len, field.power(n)))
        return total

    @cached_property
    def ordinary(self) -> bool:
        """True if its map is short enough to be proved in a moment.

        Properties that need a proof apply to these samples alone, so that among thousands of drawn
        scenes not one takes minutes: lie6 of a trigonometric H has a thousand terms, and a
        composition's series for a rational H as many denominators.
        """
        scheme = self.scheme
        if self.terms > self.limits.proof:
            return False
        if not self.hamiltonian.planar:
            # The series of other functions have many terms, which make proofs long.
            short = (
                self.step_map.symplectic_by_conditions or self._kinds <= _KINDS_WITH_SHORT_SERIES
            )
            return short and scheme.order <= _MAX_SERIES_ORDER
        if self.polynomial or scheme.order <= 2 or isinstance(scheme.every_h, TaylorSeries):
            return True
        return scheme.needs_separable and not self._kinds & {"inverse", "root"}

    @property
    def in_closed_form(self) -> bool:
        """True if its map is ordinary and solves no equations."""
        return self.ordinary and not self.step_map.implicit

    @property
    def short(self) -> bool:
        """True if its kernels are written in a moment."""
        return self.terms <= self.limits.kernels and (self.limits.unproved or self.ordinary)

    @property
    def brief(self) -> bool:
        """True if its map is evaluated at a few points in a moment."""
        return self.terms <= self.limits.points

    @property
    def light(self) -> bool:
        """True if a single step is computed: in the plane always, however long the map is."""
        return self.limits.step == inf or self.terms <= self.limits.step

    @property
    def field(self) -> CanonicalField:
        """The canonical field of H, with its derivatives by the coordinates."""
        return canonical_field(self.hamiltonian)[0]

    def flow(self, digits: int) -> NumericalFlow:
        """Return the exact flow, with that number of digits."""
        return NumericalFlow(self.field, digits)

    @property
    def slopes(self) -> tuple[Ring, Sequence[Poly]]:
        """The derivatives of the coordinates by t, in their order, and their ring."""
        return self.field.ring, self.field.slopes

    @property
    def polynomial(self) -> bool:
        """True if H is a polynomial."""
        return self._kinds <= {"variable"}

    @cached_property
    def _kinds(self) -> set[str]:
        """The kinds of the generators in the slopes."""
        ring, slopes = self.slopes
        return {g.kind for g in ring.generators_in(*slopes)}

    # -- which properties look at it --------------------------------------------------------------

    @property
    def turn(self) -> int:
        """A number by which slow properties select the samples that they test."""
        # Any function of the sample will do; a random number will not, as failures must repeat.
        p, q = self.place[0], self.place[self.hamiltonian.degrees]
        return 7 * self.steps + abs(p.numerator) + q.denominator

    def is_turn(self, one_in: int, after: int = 0) -> bool:
        """Return True for one sample in `one_in`, those that a slow property tests.

        `after`: the remainder; properties with different ones test different samples.
        """
        return self.turn % one_in == after

    # -- its run ----------------------------------------------------------------------------------

    @property
    def kernel_inputs(self) -> tuple[Hamiltonian, str, dict[str, Fraction], int]:
        """The first arguments of a `KernelRun` and a `Separation`."""
        return self.hamiltonian, self.scheme.name, self.start, self.steps

    def run(
        self, number_system: str, digits: int, *observables: str, sections: int = DEFAULT_SECTIONS
    ) -> RunOutcome:
        """Run it in a kernel, with a trail of that number of sections."""
        run = KernelRun(*self.kernel_inputs, frozenset(observables), 0, sections=sections)
        return run.run(number_systems.get(number_system, digits))

    @property
    def run_arguments(self) -> dict[str, Any]:
        """The arguments of `run` and `separate`, except H and the scheme."""
        arguments = start_texts(self.hamiltonian, self.point, self.t0)
        return arguments | {"step_size": self.step_size, "steps": self.steps}

    @property
    def depends_on_time(self) -> bool:
        """True if H depends on t."""
        return self.hamiltonian.time_dependent

    @property
    def start(self) -> dict[str, Fraction]:
        """The coordinates and h by name, with t if H depends on it, for runs and enclosures."""
        values = {**self.point, "h": self.step_size}
        return values | {"t": self.t0} if self.depends_on_time else values
