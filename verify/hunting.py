"""The worst scenes for a measure: searched with hypothesis's `target`, then refined one by one.

Islands are searched each by itself, with a seed of its own; the worst scenes of all are put
together, one for each shape of H, so that ten of them are not ten times the same.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from hypothesis import HealthCheck, Phase, given, settings, target
from hypothesis import seed as seeded
from hypothesis import strategies as st

from verify import schemes, strategies
from verify.errors import InputError
from verify.example import Example
from verify.execute import Done, Store, execute
from verify.executors import ANYWHERE, Where
from verify.explore_results import HuntResult, Worst
from verify.measures import MEASURES, Measure
from verify.neighbouring_scenes import neighbours
from verify.planned import Plan
from verify.scene import Scene
from verify.scene_text import scene_text
from verify.scene_values import InitialValue
from verify.tasks import Drawn, HuntTask

REACH, STEP_SIZES = Fraction(2), (Fraction(1, 1000), Fraction(1, 10))
_ISLAND = 200  # scenes that one task looks at
_DIRECTED = Fraction(3, 5)  # of them, by hypothesis; the others are neighbours of the worst
_KEPT = 6
_TENTHS = 20


@dataclass(frozen=True)
class Hunt:
    """What is hunted for: `steps` steps each of so many scenes.

    Raises InputError for an unknown measure, fewer than one example, and for what scenes cannot be
    drawn of.
    """

    measure: str
    seed: int
    examples: int
    steps: int = 100
    drawn: Drawn = field(default_factory=Drawn)

    def __post_init__(self) -> None:
        if self.measure not in MEASURES:
            raise InputError("maximise", self.measure, f"unknown; allowed: {', '.join(MEASURES)}")
        if self.examples < 1:
            raise InputError("examples", self.examples, "must be 1 or more")
        if not 2 <= self.steps <= 10**6:
            raise InputError("steps", self.steps, "must be 2 … 1000000")
        _scenes(self.drawn, self.steps)

    def plan(self) -> Plan:
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

    def worst(self, results: Iterable[HuntResult]) -> tuple[Worst, ...]:
        """The worst of all islands, one a shape of H."""
        return _distinct([each for result in results for each in result.worst])


def hunt(
    asked: Hunt, store: Store, *, where: Where = ANYWHERE, done: Done | None = None
) -> tuple[Worst, ...]:
    """The worst scenes found, the worst first."""
    plan = asked.plan()
    results = execute(plan, store, where=where, done=done)
    return asked.worst(r for r in map(results.get, plan.tasks) if isinstance(r, HuntResult))


def search(task: HuntTask) -> HuntResult:
    """One island: the worst scenes among those that it looked at."""
    look = _Look(MEASURES[task.measure])
    directed = max(1, int(task.count * _DIRECTED))
    _directed(task, directed, look)
    _refined(task.count - directed, look)
    return HuntResult(worst=_distinct(look.worst()), examples=task.count)


class _Look:
    """Measures scenes, and remembers them."""

    def __init__(self, measure: Measure) -> None:
        self.measure = measure
        self.seen: dict[str, tuple[float, Scene]] = {}

    def __call__(self, scene: Scene) -> float | None:
        value = self.measure.value(Example.of(scene))
        if value is not None:
            self.seen[scene_text(scene)] = value, scene
        return value

    def worst(self) -> list[Worst]:
        found = [Worst(value=value, scene=text) for text, (value, _) in self.seen.items()]
        return sorted(found, key=_order)


def _order(each: Worst) -> tuple[float, int, str]:
    """The worst first, of equal ones the shortest."""
    return -each.value, len(each.scene), each.scene


def _distinct(found: Sequence[Worst]) -> tuple[Worst, ...]:
    """The worst of each shape of H: its formula with all digits left out."""
    kept: dict[str, Worst] = {}
    for each in sorted(found, key=_order):
        kept.setdefault(_shape(each), each)
    return tuple(kept.values())[:_KEPT]


def _shape(each: Worst) -> str:
    formula = next(line for line in each.scene.splitlines() if line.startswith("hamiltonian"))
    return "".join(c for c in formula if c.isalpha())


def _directed(task: HuntTask, count: int, look: _Look) -> None:
    @seeded(task.seed * 1_000_003 + task.island)
    @settings(
        max_examples=count,
        database=None,
        phases=(Phase.generate, Phase.target),
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(_scenes(task.drawn, task.steps))
    def looked(scene: Scene) -> None:
        value = look(scene)
        if value is not None:
            target(value)

    looked()


def _refined(count: int, look: _Look) -> None:
    """Moves from the worst scene to its worst neighbour, as long as there is a worse one."""
    if not look.seen:
        return
    value, scene = max(look.seen.items(), key=lambda item: (item[1][0], item[0]))[1]
    moved = True
    while moved and count > 0:
        moved = False
        for other in neighbours(scene, reach=REACH, steps=STEP_SIZES):
            if count <= 0:
                break
            if scene_text(other) in look.seen:
                continue
            count -= 1
            found = look(other)
            if found is not None and found > value:
                value, scene, moved = found, other, True
                break


def _scenes(drawn: Drawn, steps: int) -> st.SearchStrategy[Scene]:
    """Ordinary-looking ones: a few terms, initial values in tenths, h from 1/1000 to 1/10."""
    separable = True if any(_separable(name) for name in drawn.schemes) else None
    # All drawn whole numbers are below 100: what hypothesis draws then does not depend on which
    # modules are loaded, whose greater constants it likes to try.
    tenths = st.integers(-_TENTHS, _TENTHS).map(lambda n: Fraction(n, 10))
    return strategies.scenes(
        hamiltonians=strategies.hamiltonians(
            drawn.kinds or strategies.KINDS, degree=drawn.degree, separable=separable, terms=3
        ),
        schemes=strategies.schemes(names=drawn.schemes or ("lie2",)),
        initial_values=st.builds(InitialValue, q=tenths, p=tenths),
        step_sizes=strategies.step_sizes(least=STEP_SIZES[0], most=STEP_SIZES[1]),
        steps=(steps, steps),
    )


def _separable(scheme: str) -> bool:
    return bool(getattr(schemes.get(scheme).generic, "separable", False))
