"""Claims about the images of regions under maps."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from verify.arithmetic.exact import text
from verify.claims.base_claim import Claim, Findings
from verify.errors import NOT_GIVEN, InputError
from verify.execution.plan import results_of_tasks
from verify.execution.task import Task
from verify.prose import Number, Prose, prose
from verify.scenes.results.regions import FlowImage
from verify.scenes.scene import Scene
from verify.studies.kinds.regions import FlowTask, flow_tasks, maps_of
from verify.verdict import Verdict

HEAD = ("h", "N", "t")


class Image(NamedTuple):
    """The image of a region after N steps of size h, with the result for it."""

    h: str
    result: FlowImage

    @property
    def cells(self) -> tuple[str, str, str]:
        """Its h, N and t."""
        return self.h, str(self.result.steps), self.result.time

    @property
    def place(self) -> Prose:
        """The step size and the number of steps that identify the image."""
        return prose("h = ", Number(self.h), f", N = {self.result.steps}")

    @property
    def change(self) -> "Ends":
        """The bounds of the |change| of its area; the lower one is 0 if its sign is unknown."""
        return size_bounds(self.result.area_change, self.result.probe_error)


class Ends(NamedTuple):
    """The lower and the upper bound of a size."""

    low: Fraction
    high: Fraction


class FlowClaim(Claim):
    """The base of claims about images by a scheme, or by the `exact flow`, in `[[flow]]`s."""

    exact = False
    obstacle = "a region that is carried is that of its own scene"
    flows: Annotated[tuple[str, ...], Field(min_length=1, max_length=100)]
    """The `source` of each `[[flow]]` of the scene that it speaks of."""

    def separate_scene(
        self, label: str, scene: Scene, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        raise InputError("scene", NOT_GIVEN, "is missing: a [[flow]] of a scene is spoken of")

    def selected_scene(self, name: str, scene: Scene, runs: Mapping[str, Any]) -> tuple[str, Scene]:
        """Raise InputError if the scene has no `[[flow]]` of these sources with that map."""
        sections = {flow.source: flow for flow in scene.flow if flow.source}
        for source in self.flows:
            if source not in sections:
                names = ", ".join(sections) or "none; give a [[flow]] its source"
                problem = f"scene {name} has no such [[flow]]; it has {names}"
                raise InputError("flows", source, problem)
            maps = maps_of(scene, sections[source])
            if self.scheme not in maps:
                raise InputError("scheme", self.scheme, f"is not in {source}: {', '.join(maps)}")
        return name, scene

    def tasks(self, scene: Scene) -> Iterable[Task]:
        return self._flow_tasks(scene)

    def _flow_tasks(self, scene: Scene) -> Iterator[FlowTask]:
        for section in scene.flow:
            if section.source in self.flows:
                yield from (t for t in flow_tasks(scene, section) if t.map == self.scheme)

    def images(self, findings: Findings) -> list[Image]:
        """Return the images that the claim is about."""
        return [
            Image(text(task.step_size), image)
            for task in self._flow_tasks(findings.scene(self.scene))
            for image in results_of_tasks(FlowImage, [task], findings.results)
        ]


def size_bounds(value: str | None, error: str | None) -> Ends:
    """Return bounds of |value| from its error."""
    # The error is a bound of |value|'s own, so that |value| lies within size ± radius, and above 0.
    size, radius = abs(Fraction(value or 0)), Fraction(error or 0)
    return Ends(max(size - radius, Fraction(0)), size + radius)


def judge_sizes(ends: Sequence[Ends], limit: Fraction) -> Verdict:
    """Judge the claim that every size is at most the allowed one."""
    if any(low > limit for low, _ in ends):
        return Verdict.REFUTED
    # An overlap with the allowed size leaves the claim undecided.
    return Verdict.MEASURED if all(high <= limit for _, high in ends) else Verdict.UNDECIDED
