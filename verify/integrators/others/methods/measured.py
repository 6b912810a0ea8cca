"""What is found of a step in floats, by the probe of `verify check-integrator`."""

from dataclasses import replace
from functools import lru_cache

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.check import POINTS
from verify.integrators.degrees.check import measure_step
from verify.integrators.faults import examined
from verify.integrators.measured import of_measured
from verify.integrators.others.methods.integrator import FloatStep
from verify.integrators.probe import Trial, measured
from verify.integrators.results import Finding
from verify.integrators.step import Step, StepError, last_line
from verify.integrators.still_clock import measured_mistakes
from verify.prose import joined, prose, read_prose
from verify.verdict import Verdict

# A library may raise anything, and leave the program too.
FAILURES = (Exception, SystemExit)
_SECONDS = 60.0
_SPAN = 1.9  # times the least step of a stretch its largest must be, for a power to count
# Faults of the map itself; what raises is how it is driven, and says nothing of the method.
_NO_SCHEME = ("frozen", "ignores h", "not a function")


def _undecided(found: Finding, first: float, last: float) -> Finding:
    """Of a power that is seen over a short stretch only, as one may be in passing."""
    said = f"a power of h is seen from h = `{first:.2g}` to `{last:.2g}` only, too short a stretch"
    reason = prose(read_prose(said), "; ", found.reason.partition("; ")[2])
    return replace(
        found, verdict=Verdict.UNDECIDED, reason=reason, convergence_order=None, order_decided=False
    )


@lru_cache(maxsize=256)
def finding(method: FloatStep) -> Finding:
    """Its order, and whether an area defect is seen. UNDECIDED, with the reason, where it cannot be
    measured."""
    hamiltonian = method.exact
    timed = hamiltonian.time_dependent
    order = ("p", "q", "t", "h") if timed else ("p", "q", "h")
    if hamiltonian.degrees > 1:
        return _in_degrees(method, hamiltonian, order)
    try:
        step = Step(method.make(), order=order, left=_SECONDS, moving=timed)
        trial = Trial(step, hamiltonian, [(p, q) for p, q in method.points or POINTS])
        faults, _ = examined(step, trial.points)
        fatal = next((fault for fault in faults if fault.fatal), None)
        if fatal is not None:
            wrong = fatal.name in _NO_SCHEME
            verdict = Verdict.REFUTED if wrong else Verdict.UNDECIDED
            return Finding(verdict, prose(fatal.text), "calls")
        found = measured(trial, "floats", method.ladder)
        told = of_measured(found, trial)
        seen = found.distance
        if seen.power is not None and seen.first < _SPAN * seen.last:
            return _undecided(told, seen.first, seen.last)
        mistakes = measured_mistakes(trial, "floats", told.convergence_order)
        return replace(told, reason=joined("; ", (told.reason, *mistakes)))
    except FAILURES as error:
        said = error.said if isinstance(error, StepError) else last_line(error)
        return Finding(Verdict.UNDECIDED, prose("it cannot be measured: ", said), "calls")


def _in_degrees(method: FloatStep, hamiltonian: Hamiltonian, order: tuple[str, ...]) -> Finding:
    """The same of a step of arrays."""
    try:
        step = Step(method.make(), order=order, left=_SECONDS, foreign=True)
        found = measure_step(step, hamiltonian, method.ladder)
    except FAILURES as error:
        said = error.said if isinstance(error, StepError) else last_line(error)
        return Finding(Verdict.UNDECIDED, prose("it cannot be measured: ", said), "calls")
    seen = found.measured
    return Finding(
        found.verdict,
        found.reason,
        found.how,
        area_preserving=found.symplectic,
        convergence_order=found.convergence_order,
        order_decided=found.order_known,
        largest=seen.largest if seen else None,
        probe_error=seen.probe_error if seen else None,
        notes=found.notes,
    )
