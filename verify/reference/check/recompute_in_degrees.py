"""Values of reference data in n degrees of freedom once more: see `recompute` beside it.

Steps and Jacobians are those of `verify.reference.check.textbook_in_degrees`, in balls. W is taken
from the product of the Jacobians, M, as MᵀΩM − Ω, and det J from the whole matrix: the data were
made with sums along the orbit and with Pfaffians.
"""

from contextlib import suppress
from fractions import Fraction

import flint

from verify.reference.check.difference import Findings, Place
from verify.reference.check.flow_in_degrees import state_at
from verify.reference.check.proof_in_degrees import proof_again
from verify.reference.check.recompute import (
    DOUBLINGS,
    FIRST_BITS,
    MORE_PER_DIGIT,
    TooWideError,
    compare_cell,
)
from verify.reference.check.tape import NotReadError
from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import UnknownSchemeError
from verify.reference.check.textbook_in_degrees import (
    FieldInDegrees,
    Matrix,
    Step,
    Vector,
    defect,
    identity,
    product,
    step_of,
)
from verify.reference.make.models_in_degrees import (
    AFTER_A_STEP,
    DataInDegrees,
    FlowInDegrees,
    RunInDegrees,
    values_in_degrees,
)

_SHARP = 5  # digits beyond those printed to which an exact value must be met
_ESCAPED = 4000  # bits of |z| at which an orbit is said to have left


def recomputed_in_degrees(data: DataInDegrees, file: str, kind: str, index: int) -> Findings:
    """One run, flow or proof of the data again."""
    found = Findings()
    try:
        given = {name: Fraction(value) for name, value in data.parameters.items()}
        known = FieldInDegrees(data.hamiltonian, given, data.degrees)
        if kind == "run":
            _run(known, data.runs[index], file, found)
        elif kind == "flow":
            _flow(known, data.flow[index], file, found)
        else:
            proof_again(known, data, data.proofs[index], Place(found, file))
    except (UnknownSchemeError, NotReadError) as error:
        Place(found, file, f"{kind} no. {index + 1}").is_left_out(error)
    return found


# -- a scheme's orbit -----------------------------------------------------------------------------


def _run(known: FieldInDegrees, run: RunInDegrees, file: str, found: Findings) -> None:
    step = step_of(run.scheme, known)
    bits = FIRST_BITS + MORE_PER_DIGIT * run.digits
    for attempt in range(DOUBLINGS):
        again = Findings()
        with suppress(TooWideError), flint.ctx.workprec(bits << attempt):
            _orbit(known, step, run, Place(again, file))
            found.add(again)
            return
    last = Place(found, file, f"{run.label}, step {run.rows[-1].step}")
    last.is_left_out(f"{bits << (DOUBLINGS - 1)} bits do not tell")


def _orbit(known: FieldInDegrees, step: Step, run: RunInDegrees, file: Place) -> None:
    orbit = _Orbit(known, step, run)
    size = max(abs(x) for name, x in run.start.items() if name != "t")
    for row in run.rows:
        at = file.at(f"{run.label}, step {row.step}")
        if row.status != "finished":
            _not_finished(orbit, row.status, row.failed_step, at)
            return
        orbit.to(row.step)
        at.findings.recomputed += 1
        values = orbit.values()
        for name, cell in values_in_degrees(row, known.degrees).items():
            if name in AFTER_A_STEP and row.step == 0:
                continue
            scale = size if name in known.names else Fraction(1)
            compare_cell(name, cell, values[name], run.digits, scale, at)


def _not_finished(orbit: "_Orbit", status: str, failed_step: int | None, at: Place) -> None:
    """The step that leaves 2^4000; what cannot be told is left out, with all that comes later."""
    if status != "left range" or failed_step is None:
        at.is_left_out("has no values")
        return
    limit = flint.arb(2) ** _ESCAPED
    orbit.to(failed_step - 1)
    if any(abs(x) > limit for x in orbit.z):
        at.differs("failed_step", f"at most {failed_step - 1}", str(failed_step))
        return
    try:
        orbit.to(failed_step)
    except TooWideError:
        at.is_left_out("whether it is defined is not told by balls")
        return
    at.findings.recomputed += 1
    if not any(abs(x) > limit for x in orbit.z):
        at.differs("status", f"defined after {failed_step} steps", status)


class _Orbit:
    """A scheme's orbit in balls, with the Jacobian of all steps and the greatest |entry of S|."""

    def __init__(self, known: FieldInDegrees, step: Step, run: RunInDegrees) -> None:
        self.known, self.step = known, step
        self.h, self._size = flint.arb(number(Fraction(run.step_size))), Fraction(run.step_size)
        start = run.start
        self.z: Vector = [flint.arb(number(start[name])) for name in known.names]
        self._t0 = start.get("t", Fraction(0))
        self.done, self.lam, self.largest = 0, flint.arb(0), flint.arb(0)
        self.matrix: Matrix = identity(len(known.names))

    @property
    def t(self) -> Number:
        """When it is."""
        return flint.arb(number(self._t0 + self.done * self._size))

    def to(self, count: int) -> None:
        """Goes on to the state after so many steps; TooWideError where a ball is not finite."""
        while self.done < count:
            self.z, own = self.step(self.z, self.h, self.t)
            if not all(x.is_finite() for x in self.z):
                raise TooWideError
            self.largest = self.largest.max(_greatest(defect(own)))
            change = flint.arb_mat(own).det() - 1
            self.lam += change + self.lam * change
            self.matrix = product(own, self.matrix)
            self.done += 1

    def values(self) -> dict[str, Number]:
        found = dict(zip(self.known.names, self.z, strict=True))
        found["energy"] = self.known.energy(self.z, self.t)
        found["symplectic_defect_max"] = self.largest
        found["symplectic_defect"] = _greatest(defect(self.matrix))
        return found | {"lambda": self.lam}


def _greatest(form: Matrix) -> Number:
    found = flint.arb(0)
    for x in (x for row in form for x in row):
        found = found.max(abs(x))
    return found


# -- the exact flow -------------------------------------------------------------------------------


def _flow(known: FieldInDegrees, flow: FlowInDegrees, file: str, found: Findings) -> None:
    size = max(abs(x) for name, x in flow.start.items() if name != "t")
    for row in flow.rows:
        at = Place(found, file, f"{flow.label}, step {row.step}")
        if row.status != "finished":
            at.is_left_out("has no values")
            continue
        time = row.step * Fraction(flow.step_size)
        cells = values_in_degrees(row, known.degrees)
        for more in (8, 40, 100):
            digits, again = flow.digits + more, Findings()
            with suppress(TooWideError), flint.ctx.workprec(MORE_PER_DIGIT * digits + FIRST_BITS):
                state = state_at(known, flow.start, time, digits)
                if state is None:
                    at.is_left_out("the solution is not followed there")
                    break
                place, places = Place(again, at.file, at.row), flow.digits + _SHARP
                for name, ball in zip(known.names, state, strict=True):
                    compare_cell(name, cells[name], ball, flow.digits, size, place, places)
                found.add(again)
                found.recomputed += 1
                break
        else:
            at.is_left_out("more digits do not tell")
