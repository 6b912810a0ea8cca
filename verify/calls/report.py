"""A report as `verify.Report` reads it, whose runs can be done again."""

from verify.calls.run_result import RunResult
from verify.scenes.results import report as results


class SceneResult(results.SceneResult):
    """A scene's results, whose runs can be done again."""

    runs: tuple[RunResult, ...]
    series: tuple[RunResult, ...]


class Report(results.Report):
    """A report and all its numbers, whose runs can be done again; see the class that it is of."""

    scenes: tuple[SceneResult, ...]
