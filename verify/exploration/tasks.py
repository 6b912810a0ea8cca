"""The tasks of exploration: a stretch of sampled scenes, one scene shrunk, an island of a hunt."""

from typing import Literal

from verify.arithmetic import step_cost
from verify.execution.keeper import Keeper
from verify.execution.task import Task
from verify.exploration.sample_space import SampleSpace
from verify.scenes.results.exploration import ExploreResult, HuntResult, ShrunkResult

_SCENE_COST = 10_000  # the cost of one property on one scene, in the unit of `Task.cost`
_HUNTED_COST = 10 * _SCENE_COST
# About three runs measure a scene: one in many digits, one in float64, one to confirm it.
_RUNS_OF_A_MEASURE = 3


class _OnSamples(Task):
    drawn: SampleSpace
    seed: int


class _OnProperties(_OnSamples):
    """A task on `properties`, names of the catalogue, and `claims`, each as JSON."""

    properties: tuple[str, ...]
    claims: tuple[str, ...]


class ExploreTask(_OnProperties):
    """Check properties on `count` scenes of this seed, from number `first` on."""

    result = ExploreResult
    imports = ("verify.exploration.scenes_of_seed",)
    kind: Literal["explore"] = "explore"
    first: int
    count: int

    @property
    def cost(self) -> int:
        return _SCENE_COST * self.count * (len(self.properties) + len(self.claims))

    def compute(self, keeper: Keeper) -> ExploreResult:
        from verify.exploration.scenes_of_seed import check_properties, properties_of

        properties = properties_of(self.properties, self.claims)
        numbers = range(self.first, self.first + self.count)
        return check_properties(properties, self.drawn, self.seed, numbers)


class ShrinkTask(_OnProperties):
    """Shrink one sampled scene for which a property (the only one here) does not hold."""

    result = ShrunkResult
    imports = ("verify.exploration.scenes_of_seed",)
    kind: Literal["shrink"] = "shrink"
    example: int

    def compute(self, keeper: Keeper) -> ShrunkResult:
        from verify.exploration.scenes_of_seed import properties_of, shrink

        (violated,) = properties_of(self.properties, self.claims)
        return shrink(violated, self.drawn, self.seed, self.example)


class HuntTask(_OnSamples):
    """Search one island for scenes that make a measure as large as can be."""

    result = HuntResult
    imports = ("verify.exploration.island_search",)
    kind: Literal["hunt"] = "hunt"
    measure: str
    island: int
    count: int
    steps: int

    @property
    def cost(self) -> int:
        runs = _RUNS_OF_A_MEASURE * self.steps * step_cost("mpfr")
        return self.count * (_HUNTED_COST + runs)

    def compute(self, keeper: Keeper) -> HuntResult:
        from verify.exploration.island_search import search_island

        return search_island(
            self.measure, self.drawn, self.seed, self.island, count=self.count, steps=self.steps
        )
