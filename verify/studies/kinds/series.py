"""Thinned series of single runs, for plots over time."""

from collections.abc import Iterator

from verify.arithmetic.exact import text
from verify.execution.plan import Plan, Results, Study, results_of_tasks, scene_name, toml_section
from verify.runs.task import RunTask
from verify.scenes.results.run import RunResult
from verify.scenes.run_sections import PlottedSeries
from verify.scenes.scene import Scene
from verify.scenes.values import start_arguments
from verify.schemes.field_splitting import separate_parts
from verify.studies.kinds.grid import observables_of


def series_task(scene: Scene, scheme: str, series: PlottedSeries) -> RunTask:
    """Return the run of a `[[series]]`."""
    begin = start_arguments(series.initial_value, of_field=scene.field is not None)
    return RunTask.from_object(
        series, **scene.hamiltonian_fields(), **begin, scheme=scheme, steps=series.count,
        t0=scene.t0, observables=observables_of(scene, None),
    )  # fmt: skip


def _need(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    for series in scene.series:
        title, h = separate_parts(scheme)[0], text(series.step_size)
        description = f"{scene_name(scene)}: series of {title} at h = {h}"
        task = series_task(scene, scheme, series)
        if preserves and "energy_error_max" not in (task.observables or ()):
            plan.leave_out(description, "ΔJ ≡ 0 is proved: it is a line at 0")
        else:
            plan.need(task, f"{description}, for its plot")


def _runs(scene: Scene, results: Results) -> Iterator[RunResult]:
    """Yield the series that were run, each with the source that the scene names."""
    for scheme in scene.schemes:
        for series in scene.series:
            for run in results_of_tasks(RunResult, [series_task(scene, scheme, series)], results):
                yield run.model_copy(update={"source": series.source})


_SECTION = toml_section(4, "trajectories and plots over time", "[[series]]")
STUDY = Study(
    5,
    (_SECTION,),
    need_of_scheme=_need,
    results_for_scene=lambda scene, results: {"series": tuple(_runs(scene, results))},
    takes_field=True,
)
