"""The search for the worst scenes for a measure, on islands that are searched independently.

Each island has a seed of its own. The worst scenes of all islands are merged, with one for each
shape of H, so that they are not variants of a single scene.
"""

from dataclasses import dataclass, field
from functools import cached_property

from verify.errors import InputError, unknown_name
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.exploration.different_scenes import select_by_shape, select_different
from verify.exploration.island_search import KEPT, MOST_EXAMPLES, hunted_scenes, sorting_key
from verify.exploration.measures import MEASURES
from verify.exploration.sample_space import SampleSpace, check_scenes
from verify.exploration.tasks import HuntTask
from verify.scenes.results.exploration import HuntResult

_MOST_STEPS = 10**6
_ISLAND = 200  # scenes that one task looks at


@dataclass(frozen=True)
class Hunt:
    """A request to hunt among `examples` scenes of `steps` steps each.

    Raises InputError for an unknown measure, fewer than one example, a seed below 0, and a space
    from which no scenes can be drawn.
    """

    measure: str
    seed: int
    examples: int
    steps: int = 100
    drawn: SampleSpace = field(default_factory=SampleSpace)

    def __post_init__(self) -> None:
        if self.measure not in MEASURES:
            raise unknown_name("maximise", self.measure, MEASURES)
        if self.drawn.degrees > 1 and not MEASURES[self.measure].several:
            names = ", ".join(name for name, x in MEASURES.items() if x.several)
            problem = f"is of one degree of freedom; allowed in more: {names}"
            raise InputError("maximise", self.measure, problem)
        check_scenes(self.seed, self.examples, MOST_EXAMPLES)
        if not 2 <= self.steps <= _MOST_STEPS:
            raise InputError("steps", self.steps, f"must be 2 … {_MOST_STEPS}")
        # Built here for its errors alone: a request that cannot be drawn must not be planned.
        hunted_scenes(self.drawn, self.steps)

    @cached_property
    def plan(self) -> Plan:
        """The tasks, each for an island of at most 200 scenes."""
        plan = Plan()
        for island, first in enumerate(range(0, self.examples, _ISLAND)):
            task = HuntTask(
                drawn=self.drawn,
                seed=self.seed,
                measure=self.measure,
                island=island,
                count=min(_ISLAND, self.examples - first),
                steps=self.steps,
            )
            plan.need(task, f"an island of the hunt for {self.measure}")
        return plan


def hunt(
    request: Hunt, store: Store, *, where: Placement = ANYWHERE, done: OnResult | None = None
) -> HuntResult:
    """Search all islands and return at most six worst scenes that differ from each other.

    Their values are decimal logarithms (see `verify.exploration.measures`), confirmed with twice
    the digits. Islands whose result is in the store are not searched again.
    """
    plan = request.plan
    results = execute(plan, store, where=where, done=done)
    islands = [r for r in map(results.get, plan.tasks) if isinstance(r, HuntResult)]
    # Islands may find the same scene: the best of each shape is taken over all of them.
    together = sorted((each for island in islands for each in island.worst), key=sorting_key)
    examples = sum(island.examples for island in islands)
    return HuntResult(
        worst=tuple(select_different(select_by_shape(together))[:KEPT]), examples=examples
    )
