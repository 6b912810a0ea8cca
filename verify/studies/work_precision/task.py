"""The task of error against run time."""

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, ClassVar, Literal

from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.start import point_of
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.scenes.values import Coordinates, Number, StepSize
from verify.studies.work_precision.peer_interface import InitialValueProblem

if TYPE_CHECKING:
    from verify.studies.work_precision.errors import Errors

_POINT_COST = 80_000_000  # of a point of error against run time: some tenths of a second


class WorkPrecisionTask(HamiltonianTask):
    """Error against run time of schemes over step sizes, of number systems, and of peers.

    `peers`: names of those that are drawn; `peers_left_out`: the others, each with the reason.
    """

    alone: ClassVar[bool] = True
    imports = ("verify.studies.work_precision.errors",)
    result = WorkPrecisionResult
    kind: Literal["work_precision"] = "work_precision"
    schemes: tuple[str, ...]
    time: Number
    t0: Number = Fraction(0)
    step_sizes: tuple[StepSize, ...]
    q: Coordinates
    p: Coordinates
    repeats: int
    number_systems: tuple[str, ...]
    digits: tuple[int, ...]
    number_systems_scheme: str
    number_systems_step_size: StepSize
    peers: tuple[str, ...]
    peers_left_out: tuple[tuple[str, str], ...]

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        return _POINT_COST * len(self.schemes) * len(self.step_sizes)

    def prepare(self, advance: Callable[[int], None] = lambda _: None) -> "Errors":
        """Return the errors of the schemes, without timing; `advance` as in `measure`."""
        from verify.studies.work_precision.errors import find_errors

        return find_errors(self._problem, self.schemes, self.step_sizes, advance)

    def compute(self, keeper: Keeper) -> WorkPrecisionResult:
        """Return the measured points as a result; the errors may be prepared."""
        return self.measure(lambda _: None, keeper.prepared)

    def measure(
        self, advance: Callable[[int], None], errors: "Errors | None" = None
    ) -> WorkPrecisionResult:
        """Do `compute`; `advance` is called with the number of points just done."""
        from verify.studies.work_precision.measure import work_precision

        scheme_errors = errors or self.prepare(advance)
        arguments = self.other_fields("q", "p", "time", "t0")
        return work_precision(self._problem, **arguments, errors=scheme_errors, advance=advance)

    @property
    def _problem(self) -> InitialValueProblem:
        exact = self.exact_hamiltonian()
        return InitialValueProblem(exact, point_of(exact, self.q, self.p), self.time, self.t0)
