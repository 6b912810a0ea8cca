"""What numbers may be of: a run, and how its columns are read. Ours; and what others may have run.

Each mistake of `reference.mistakes` makes another setting of the reference data's.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.number_system import UnsupportedError
from verify.orbit_points import orbit
from verify.reference_results import OrbitPoint
from verify.tasks import OrbitTask

Known = tuple[Fraction, Fraction]  # a value and its radius


@dataclass(frozen=True)
class Case:
    """A scheme's run for an H whose parameters have values."""

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    q: Fraction
    p: Fraction


@dataclass(frozen=True)
class Setting:
    """A run; row N holds what it is after N + `late` steps, the columns perhaps `swapped`, and p
    perhaps `negated`."""

    case: Case
    late: int = 0
    swapped: bool = False
    negated: bool = False

    def state(self, step: int, digits: int) -> dict[str, Known] | None:
        """p and q as row `step` of such a table has them; None where there is no such state."""
        point = self.point(step, digits)
        if point is None or point.p is None or point.q is None:
            return None
        p, q = ((Fraction(x.value), Fraction(x.radius)) for x in (point.p, point.q))
        if self.negated:
            p = -p[0], p[1]
        return {"p": q, "q": p} if self.swapped else {"p": p, "q": q}

    def point(self, step: int, digits: int) -> OrbitPoint | None:
        """What is known of the run where row `step` is of it."""
        return None if step + self.late < 0 else run_at(self.case, step + self.late, digits)


@lru_cache(maxsize=4096)
def run_at(case: Case, step: int, digits: int) -> OrbitPoint | None:
    """A case after so many steps, to so many digits; None where it cannot be run."""
    given = case.hamiltonian.written
    try:
        task = OrbitTask(
            **given, scheme=case.scheme, q=case.q, p=case.p,
            step_size=case.step_size, steps=(step,), digits=digits,
        )  # fmt: skip
        point = orbit(case.hamiltonian, task).points[0]
    except (InputError, UnsupportedError, ArithmeticError):
        return None
    return point if point.status == "finished" else None
