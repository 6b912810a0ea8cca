"""The worst scenes for a measure, over islands that are searched each by itself.

Each island has a seed of its own; the worst scenes of all are put together, one for each shape of
H, so that ten of them are not ten times the same.
"""

from dataclasses import dataclass, field
from functools import cached_property

from verify.errors import InputError, unknown
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.exploration.different_scenes import by_shape, different
from verify.exploration.island_search import KEPT, MOST_EXAMPLES, by_value, hunted_scenes
from verify.exploration.measures import MEASURES
from verify.exploration.sample_space import SampleSpace, check_scenes
from verify.exploration.tasks import HuntTask
from verify.scenes.results.exploration import HuntResult

_MOST_STEPS = 10**6
_ISLAND = 200  # scenes that one task looks at


@dataclass(frozen=True)
class Hunt:
    """What is hunted for: `steps` steps each of so many scenes.

    Raises InputError for an unknown measure, fewer than one example, a seed below 0, and for what
    scenes cannot be drawn of.
    """

    measure: str
    seed: int
    examples: int
    steps: int = 100
    drawn: SampleSpace = field(default_factory=SampleSpace)

    def __post_init__(self) -> None:
        if self.measure not in MEASURES:
            raise unknown("maximise", self.measure, MEASURES)
        if self.drawn.degrees > 1 and not MEASURES[self.measure].several:
            allowed = ", ".join(name for name, x in MEASURES.items() if x.several)
            problem = f"is of one degree of freedom; allowed in more: {allowed}"
            raise InputError("maximise", self.measure, problem)
        check_scenes(self.seed, self.examples, MOST_EXAMPLES)
        if not 2 <= self.steps <= _MOST_STEPS:
            raise InputError("steps", self.steps, f"must be 2 … {_MOST_STEPS}")
        hunted_scenes(self.drawn, self.steps)

    @cached_property
    def plan(self) -> Plan:
        """The tasks, each of an island of 200 scenes at most."""
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
    asked: Hunt, store: Store, *, where: Placement = ANYWHERE, done: OnResult | None = None
) -> HuntResult:
    """The worst scenes found on all islands, six at most, each different from the others.

    Their values are decimal logarithms (see `verify.exploration.measures`), confirmed with twice
    the digits. What the store has of the islands is not searched again.
    """
    plan = asked.plan
    results = execute(plan, store, where=where, done=done)
    islands = [r for r in map(results.get, plan.tasks) if isinstance(r, HuntResult)]
    together = sorted((each for island in islands for each in island.worst), key=by_value)
    examples = sum(island.examples for island in islands)
    return HuntResult(worst=tuple(different(by_shape(together))[:KEPT]), examples=examples)
