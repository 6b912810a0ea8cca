"""Claims about regions that maps carry."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from verify.arithmetic.exact import text
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.errors import NOT_GIVEN, InputError
from verify.execution.study import known_results
from verify.execution.task import Task
from verify.prose import Number, Prose, prose
from verify.scenes.results.regions import FlowImage
from verify.scenes.scene import Scene
from verify.studies.kinds.regions import flow_tasks, maps_of
from verify.studies.regions.task import FlowTask
from verify.verdict import Verdict

HEAD = ("h", "N", "t")


class Image(NamedTuple):
    """The image of a region after N steps of size h, with what was found of it."""

    h: str
    found: FlowImage

    @property
    def cells(self) -> tuple[str, str, str]:
        """Its h, N and t."""
        return self.h, str(self.found.steps), self.found.time

    @property
    def place(self) -> Prose:
        """Which image it is."""
        return prose("h = ", Number(self.h), f", N = {self.found.steps}")

    @property
    def change(self) -> "Ends":
        """The change of its area; 0 where its sign is not known."""
        return around(self.found.area_change, self.found.probe_error)


class Ends(NamedTuple):
    """The least and the greatest that a size may be."""

    low: Fraction
    high: Fraction


class FlowClaim(Claim):
    """Of images by a scheme, or by the `exact flow`, in the scene's `[[flow]]` of these sources."""

    exact = False
    only_here = "a region that is carried is that of its own scene"
    flows: Annotated[tuple[str, ...], Field(min_length=1, max_length=100)]
    """The `source` of each `[[flow]]` of the scene that it speaks of."""

    def scene_of_its_own(
        self, label: str, scene: Scene, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        raise InputError("scene", NOT_GIVEN, "is missing: a [[flow]] of a scene is spoken of")

    def scene_on(self, name: str, scene: Scene, runs: Mapping[str, Any]) -> tuple[str, Scene]:
        """Raises InputError where the scene does not carry a region so, or not by that map."""
        known = {flow.source: flow for flow in scene.flow if flow.source}
        for source in self.flows:
            if source not in known:
                allowed = ", ".join(known) or "none; give a [[flow]] its source"
                problem = f"scene {name} has no such [[flow]]; it has {allowed}"
                raise InputError("flows", source, problem)
            maps = maps_of(scene, known[source])
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
        """The images that it speaks of."""
        return [
            Image(text(task.step_size), image)
            for task in self._flow_tasks(findings.scene(self.scene))
            for image in known_results(FlowImage, [task], findings.results)
        ]


def around(value: str | None, error: str | None) -> Ends:
    """What |value| may be, by its error."""
    size, apart = abs(Fraction(value or 0)), Fraction(error or 0)
    return Ends(max(size - apart, Fraction(0)), size + apart)


def within(ends: Sequence[Ends], allowed: Fraction) -> Verdict:
    """Whether every one of the sizes is at most the allowed one."""
    if any(low > allowed for low, _ in ends):
        return Verdict.REFUTED
    return Verdict.MEASURED if all(high <= allowed for _, high in ends) else Verdict.UNDECIDED
