"""The exact motion from one start, and whether runs keep to it: the same questions in the plane and
in n degrees of freedom.

The greatest frequency along an exact motion: that of the linearised flow where it is stiffest.

In the plane ω² is the greatest det Hess H on the orbit; in n degrees of freedom ω is the greatest
imaginary part of an eigenvalue of the field's Jacobian, in float64, at the places at which the
motion was looked at.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from verify.arithmetic.systems import mpfr
from verify.flows.functions import functions_at
from verify.flows.orbit import ExactOrbit, exact_orbit
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.run import run as run_of
from verify.studies.stability.exact_motion import ExactMotion, exact_motion
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import Run, State
from verify.studies.stability.verdict_in_degrees import MotionInDegrees, judge_in_degrees
from verify.studies.stability.verdict_on_run import Judgement, judge

_DIGITS = 20
_NOISE = 1e-6  # of the matrix's size: a double eigenvalue 0 is found so far from it, and more


def frequency(orbit: ExactOrbit) -> Fraction:
    """The greatest ω on the orbit, to some 20 digits; 0 where nothing oscillates."""
    if orbit.stiffness <= 0:
        return Fraction(0)
    arithmetic = mpfr.make(_DIGITS)
    with arithmetic.context():
        omega = arithmetic.functions["sqrt"](arithmetic.number(orbit.stiffness))
    return arithmetic.exact(omega)


def frequency_in_degrees(hamiltonian: Hamiltonian, motion: ExactMotion) -> Fraction:
    """The same in n degrees of freedom, to some three digits; 0 where nothing oscillates."""
    import numpy as np

    field, _ = canonical_field(hamiltonian)
    size, ring = len(field.names), field.ring
    names = (*field.names, "t") if field.timed else field.names
    entries = [(ring, ring.diff(slope, name)) for slope in field.slopes for name in field.names]
    arithmetic = mpfr.make(_DIGITS)
    at = functions_at(arithmetic, entries, names)
    greatest = 0.0
    for time, state in zip(motion.times, motion.states, strict=True):
        given = (*state, time) if field.timed else state
        with arithmetic.context():
            found = at(*map(arithmetic.number, given))
        jacobian = np.array([float(arithmetic.exact(x)) for x in found]).reshape(size, size)
        turning = float(np.abs(np.linalg.eigvals(jacobian).imag).max())
        if turning > _NOISE * float(np.abs(jacobian).max()):
            greatest = max(greatest, turning)
    return Fraction(greatest)


@dataclass(frozen=True)
class Within:
    """What a run must not exceed, beside the exact motion's bounds: |H − H(z₀)| in parts of the
    orbit's energy scale, and the greatest |entry| of W, which in the plane is |Λ|."""

    energy_error: Fraction | None = None
    symplectic_defect: Fraction | None = None

    def holds(self, run: Run, energy_error: Fraction | None) -> bool:
        """Of a run whose energy error is so great at most."""
        most = self.energy_error
        if most is not None and (energy_error is None or energy_error > most):
            return False
        return self.symplectic_defect is None or self._keeps_the_form(run, self.symplectic_defect)

    def _keeps_the_form(self, run: Run, most: Fraction) -> bool:
        of, start, planar = run.hamiltonian, run.start, run.hamiltonian.planar
        p, q = ([start[x] for x in of.coordinates if x[0] == letter] for letter in "pq")
        name = "lambda" if planar else "symplectic_defect"
        done = run_of(
            of, run.scheme, q=q[0] if planar else q, p=p[0] if planar else p,
            step_size=run.step_size, steps=run.steps, t0=start["t"], observables=(name,),
        )  # fmt: skip
        return name in done.values and abs(done.values[name]) <= most


AnyMotion = RunMotion | MotionInDegrees


def verdict(motion: AnyMotion) -> Judgement:
    """That on one run."""
    return judge(motion) if isinstance(motion, RunMotion) else judge_in_degrees(motion)


@dataclass(frozen=True)
class Held:
    """The exact motion from one state for some time, and what is asked of runs from there.

    In n degrees of freedom a bounded motion is followed once, over the whole time, for all runs.
    """

    hamiltonian: Hamiltonian
    state: State
    time: Fraction
    t0: Fraction

    @property
    def exact(self) -> ExactOrbit | ExactMotion:
        if self.hamiltonian.planar:
            return exact_orbit(self.hamiltonian, *self.state, self.time, self.t0)
        return exact_motion(self.hamiltonian, self.state, self.time, self.t0)

    @cached_property
    def frequency(self) -> Fraction:
        """The greatest ω; 0 where nothing oscillates."""
        exact = self.exact
        if isinstance(exact, ExactMotion):
            return frequency_in_degrees(self.hamiltonian, exact)
        return frequency(exact)

    def _motion(self, scheme: str, h: Fraction, steps: int) -> AnyMotion:
        run = Run(self.hamiltonian, scheme, h, self.state, steps, self.t0)
        if self.hamiltonian.planar:
            return RunMotion(run)
        exact = self.exact
        if isinstance(exact, ExactMotion) and exact.kind in ("bounded", "driven"):
            return MotionInDegrees(run, exact)
        return MotionInDegrees(run)

    def keeps(self, scheme: str, h: Fraction, steps: int, within: Within) -> bool:
        """Whether the float64 run keeps within the bounds."""
        motion = self._motion(scheme, h, steps)
        trail = motion.float64
        return motion.stays(trail) and within.holds(motion.run, motion.worst(trail))

    def judged(self, scheme: str, h: Fraction, steps: int) -> Judgement:
        """The verdict on the run."""
        return verdict(self._motion(scheme, h, steps))


def held(
    hamiltonian: Hamiltonian, point: Mapping[str, Fraction], time: Fraction, t0: Fraction
) -> Held:
    """The motion from a point, given by the names of its coordinates, at t0."""
    state = tuple(point[name] for name in hamiltonian.coordinates)
    return Held(hamiltonian, state, time, t0)
