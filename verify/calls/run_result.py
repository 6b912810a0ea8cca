"""Results of runs, and reports of them, that can repeat a run to compute more than its values."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Self

from pydantic import PrivateAttr

from verify.scenes.measured_structures import MeasuredStructure
from verify.scenes.results import report as report_models
from verify.scenes.results import run as run_models
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import EnergyDrift, OrbitTable


@dataclass(frozen=True)
class KeptValues:
    """The values of one structure in a run: `at_end` is what has accumulated at its end, `largest`
    the greatest on the way. None if there is no such value."""

    structure: str
    label: str
    at_end: Value | None
    largest: Value | None


class RunResult(run_models.RunResult):
    """The result of a run of N steps of a scheme, in one number system, which can be repeated.

    `values` holds q, p and the requested observables, each with its bound; `status` says how the
    run ended, and `error_kind` whether every bound is rigorous.
    `verify.scenes.results.run.RunResult` describes all fields.
    """

    _measured: tuple[MeasuredStructure, ...] = PrivateAttr(())

    def with_measured(self, measured: tuple[MeasuredStructure, ...]) -> Self:
        """Return the result with these structures in `keeps`."""
        copy = self.model_copy()
        copy._measured = measured
        return copy

    @property
    def keeps(self) -> tuple[KeptValues, ...]:
        """The values of each structure that was asked for, in their order."""
        structures = self._measured
        return tuple(KeptValues(x.structure, x.label, **x.select(self.values)) for x in structures)

    @classmethod
    def from_result(cls, result: run_models.RunResult) -> Self:
        """Return the result as one that can repeat its run."""
        return cls.model_construct(result.model_fields_set, **dict(result))

    @cached_property
    def orbit(self) -> OrbitTable:
        """The states as arrays and exact texts: at every step, or at every k-th of a long run.

        The limit is the `points` of the run, by default 10,000.

        Raises InputError if the run ended without values.
        """
        from verify.runs.orbit_table import orbit_of

        return orbit_of(self, self._points)

    def solution_errors(self, points: int = 200) -> tuple[tuple[Fraction, Value], ...]:
        """Return (t, |z − φ_t(z₀)|) at `points` states at most; φ_t is the exact flow.

        Raises InputError if no exact solution is known.
        """
        from verify.runs.run_errors import solution_errors

        return solution_errors(self, points)

    def energy_drifts(self, order: int = 4, points: int = 1000) -> list[EnergyDrift]:
        """Return H̃ − H̃₀ at `points` states at most, for H and for H̃ with its terms up to h^order.

        The terms are added one by one, each with a drift of its own.

        Raises InputError if the scheme has no H̃ but H.
        """
        from verify.runs.run_errors import energy_drifts

        return energy_drifts(self, order, points)


class RepeatableScene(report_models.SceneResult):
    """A scene's results, whose runs can be repeated."""

    runs: tuple[RunResult, ...]
    series: tuple[RunResult, ...]


class Report(report_models.Report):
    """A report and all its numbers, whose runs can be repeated.

    `verify.scenes.results.report.Report` describes all fields.
    """

    scenes: tuple[RepeatableScene, ...]
