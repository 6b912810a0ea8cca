"""A report as `verify.Report` reads it, whose runs can be done again."""

from verify.calls.run_result import RunResult
from verify.scenes.results import report as results


class SceneResult(results.SceneResult):
    __doc__ = results.SceneResult.__doc__
    runs: tuple[RunResult, ...]
    series: tuple[RunResult, ...]


class Report(results.Report):
    __doc__ = results.Report.__doc__
    scenes: tuple[SceneResult, ...]
