"""The exact motion from one start, and whether runs keep to it."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify.flows.orbit_search import ExactOrbit
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import shown_of
from verify.runs.run import run as run_of
from verify.studies.stability.exact_motion import exact_motion
from verify.studies.stability.run_motion import RunMotion
from verify.studies.stability.trail import Run, State
from verify.studies.stability.verdict_on_run import Judgement, judge


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
        of, start, name = run.hamiltonian, run.start, run.hamiltonian.structure.of_run
        done = run_of(
            of, run.scheme, q=shown_of(of, start, "q"), p=shown_of(of, start, "p"),
            step_size=run.step_size, steps=run.steps, t0=start["t"], observables=(name,),
        )  # fmt: skip
        return name in done.values and abs(done.values[name]) <= most


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
    def exact(self) -> ExactOrbit:
        return exact_motion(self.hamiltonian, self.state, self.time, self.t0)

    def _motion(self, scheme: str, h: Fraction, steps: int) -> RunMotion:
        run, exact = Run(self.hamiltonian, scheme, h, self.state, steps, self.t0), self.exact
        serves = exact.has_neighbours and exact.kind in ("bounded", "driven")
        return RunMotion(run, exact if serves else None)

    def keeps(self, scheme: str, h: Fraction, steps: int, within: Within) -> bool:
        """Whether the float64 run keeps within the bounds."""
        motion = self._motion(scheme, h, steps)
        trail = motion.float64
        return motion.stays(trail) and within.holds(motion.run, motion.worst(trail))

    def judged(self, scheme: str, h: Fraction, steps: int) -> Judgement:
        """The verdict on the run."""
        return judge(self._motion(scheme, h, steps))


def held(
    hamiltonian: Hamiltonian, point: Mapping[str, Fraction], time: Fraction, t0: Fraction
) -> Held:
    """The motion from a point, given by the names of its coordinates, at t0."""
    state = tuple(point[name] for name in hamiltonian.coordinates)
    return Held(hamiltonian, state, time, t0)
