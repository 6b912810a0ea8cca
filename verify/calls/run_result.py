"""A run's result as `verify.run` gives it, which does the run again for more than its values."""

from fractions import Fraction
from functools import cached_property
from typing import Self

from verify.scenes.results import run as results
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.orbit import OrbitTable
from verify.scenes.results.run import EnergyDrift


class RunResult(results.RunResult):
    __doc__ = results.RunResult.__doc__

    @classmethod
    def of(cls, result: results.RunResult) -> Self:
        """The same result."""
        return cls.model_construct(result.model_fields_set, **dict(result))

    @cached_property
    def orbit(self) -> OrbitTable:
        from verify.runs.orbit import orbit_of

        return orbit_of(self, self._points)

    def solution_errors(self, points: int = 200) -> tuple[tuple[Fraction, Value], ...]:
        from verify.runs.solution_error import solution_errors

        return solution_errors(self, points)

    def energy_drifts(self, order: int = 4, points: int = 1000) -> list[EnergyDrift]:
        from verify.runs.energy_drift import energy_drifts

        return energy_drifts(self, order, points)
