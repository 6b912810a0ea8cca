"""The hunter finds a planted worst case, the same one each time."""

import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis.internal.conjecture.data import ConjectureData

from verify import strategies
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS, Placement
from verify.execution.keeper import NOTHING
from verify.exploration import hunting, island_search
from verify.exploration.hunting import Hunt, hunt
from verify.exploration.island_search import neighbours, scene_of, select_by_shape, select_different
from verify.exploration.measures import MEASURES, Measure
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.tasks import HuntTask
from verify.scenes.results.exploration import HuntResult, Worst

POLYNOMIAL = SampleSpace(kinds=("polynomial",), degree=4)


def task(**changes: Any) -> HuntTask:
    own: dict[str, Any] = {
        "drawn": POLYNOMIAL, "seed": 7, "measure": "planted", "island": 0, "count": 200, "steps": 2,
    }  # fmt: skip
    return HuntTask(**own | changes)


# -- a planted worst case -------------------------------------------------------------------------

Plant = Callable[[Callable[[Sample], float | None]], None]


@pytest.fixture
def plant(monkeypatch: pytest.MonkeyPatch) -> Plant:
    def planted(value: Callable[[Sample], float | None]) -> None:
        measure = Measure("planted", lambda sample, _: value(sample))
        monkeypatch.setitem(MEASURES, "planted", measure)

    return planted


def search(task: HuntTask) -> HuntResult:
    return task.compute(NOTHING)


def near(q: str, p: str) -> Callable[[Sample], float]:
    """By far the greatest at one initial value, and ever greater towards it."""

    def value(sample: Sample) -> float:
        far = abs(sample.point["q"] - Fraction(q)) + abs(sample.point["p"] - Fraction(p))
        return -math.log10(far + Fraction(1, 10**9))

    return value


def test_a_planted_worst_scene_is_found(plant: Plant) -> None:
    plant(near("1.37", "-0.74"))  # tenths are drawn: hundredths are found by the local search
    worst = search(task()).worst[0]
    assert worst.value == pytest.approx(9)
    found = Sample.from_scene(scene_of(worst))
    assert found.place == (Fraction("-0.74"), Fraction("1.37"))


def test_without_the_local_search_it_is_not_found(
    plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant(near("1.37", "-0.74"))
    monkeypatch.setattr(island_search, "_refine", lambda _: None)
    assert search(task()).worst[0].value < 2


def test_what_is_out_of_bounds_is_not_found(plant: Plant) -> None:
    plant(near("2.5", "0"))
    worst = search(task()).worst[0]
    assert Sample.from_scene(scene_of(worst)).point["q"] == 2


@pytest.mark.left_to_ci
def test_a_planted_term_of_h_is_found(plant: Plant) -> None:
    """A needle that no slope leads to: only drawing finds it, and its coefficient is then moved."""

    def value(sample: Sample) -> float:
        term = {str(t): c for t, c in sample.hamiltonian.exact.as_coefficients_dict().items()}
        c = abs(Fraction(str(term.get("p**3", 0))))
        return 5 + float(min(c, Fraction(50))) if c else 0.0

    plant(value)
    worst = search(task(count=250, seed=8)).worst[0]
    assert 5 + 4 <= worst.value <= 5 + 7, "doubled as long as it is an ordinary coefficient"


def test_a_value_that_another_precision_does_not_confirm_is_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def value(sample: Sample, digits: int) -> float:
        q = sample.point["q"]
        return float(q) + (digits > 40) * (q > 0)

    monkeypatch.setitem(MEASURES, "planted", Measure("planted", value))
    found = search(task(count=40)).worst
    assert found
    assert all(each.value <= 0 for each in found)


def test_no_scene_with_a_value_is_an_empty_find(plant: Plant) -> None:
    plant(lambda _: None)
    found = search(task(count=20))
    assert found.worst == ()
    assert 0 < found.examples <= 20


# -- bounds, shapes, islands ----------------------------------------------------------------------


def test_no_more_scenes_are_measured_than_asked_for(plant: Plant) -> None:
    for count in (1, 2, 30):
        seen: list[Sample] = []
        plant(lambda sample, seen=seen: seen.append(sample) or 0.0)  # type: ignore[misc]
        found = search(task(count=count))
        assert found.examples <= count
        assert len(seen) <= count + len(found.worst), "each of the worst once more"


def test_all_scenes_that_are_looked_at_are_within_the_bounds(plant: Plant) -> None:
    seen: list[Sample] = []
    plant(lambda sample: seen.append(sample) or float(sum(map(abs, sample.start.values()))))  # type: ignore[func-returns-value]
    search(task())
    least, most = island_search.STEP_SIZES
    assert len(seen) > 150
    assert all(max(map(abs, x.place)) <= island_search.REACH for x in seen)
    assert all(least <= x.step_size <= most for x in seen)
    reached = {abs(x.point["q"]) for x in seen} & {abs(x.point["p"]) for x in seen}
    assert island_search.REACH in reached, "the bounds themselves are looked at"


def test_neighbours_keep_to_the_bounds_of_coefficients() -> None:
    start = scene_of(Worst(value=0.0, scene=_text("7*p**2 + q**2/7 + q/(2*p**2 + 2)")))
    bounds = {"reach": Fraction(2), "steps": island_search.STEP_SIZES}
    kept = list(neighbours(start, **bounds, coefficients=(Fraction(1, 7), Fraction(7))))
    wide = list(neighbours(start, **bounds, coefficients=(Fraction(1, 99), Fraction(99))))
    assert "14*p**2" not in " ".join(str(x.hamiltonian) for x in kept)
    assert "14*p**2" in " ".join(str(x.hamiltonian) for x in wide)
    assert len({str(x) for x in kept}) == len(kept)


def _text(formula: str) -> str:
    return (
        f'hamiltonian = "{formula}"\nschemes = ["lie2"]\n[grid]\nsteps = 2\n'
        'step_sizes = ["0.1"]\ninitial_values = [{ q = "0.1", p = "0.1" }]\n'
    )


def test_one_of_each_shape_is_kept() -> None:
    formulas = ["p**2/2 + q**2/2", "3*q**2 - p**2", "p**2/2 + q**4", "p*q", "q/(p**2 + 6)",
                "2*q/(3*p**2 + 12)", "cos(2*q)", "cos(3*q)", "sin(q)"]  # fmt: skip
    found = select_by_shape([Worst(value=0.0, scene=_text(f)) for f in formulas])
    kept = [each.scene.split('"')[1] for each in found]
    assert kept == [formulas[i] for i in (0, 2, 3, 4, 6, 8)]


def test_a_scene_that_is_another_one_again_is_not_kept() -> None:
    worst = _text("p**2/2 + q**2/2")
    again = _text("p**2/2 + q**2/2 + p*q").replace('q = "0.1"', 'q = "0.3"')
    found = [
        (5.80, worst, True),
        (5.79, again, False),  # more terms, about as bad
        (5.75, _text("p**4 + cos(q)"), False),  # another H from the same start
        (5.75, _text("p**4 + cos(q)").replace('q = "0.1"', 'q = "0.2"'), True),
        (5.74, worst.replace("lie2", "euler"), True),  # another scheme
        (5.1, again, True),  # less bad
    ]
    kept = select_different([Worst(value=value, scene=scene) for value, scene, _ in found])
    assert [each.scene for each in kept] == [scene for _, scene, stays in found if stays]


def test_islands_look_at_other_scenes(plant: Plant) -> None:
    seen: list[set[str]] = []
    for island in (0, 1, 0):
        own: set[str] = set()
        plant(lambda x, own=own: own.add(str(x.scene)) or float(x.point["q"] + x.point["p"] / 9))  # type: ignore[misc]
        search(task(island=island, count=60))
        seen.append(own)
    assert seen[0] == seen[2], "the same island looks at the same ones"
    assert len(seen[0] & seen[1]) < len(seen[0]) / 3


# -- the same each time ---------------------------------------------------------------------------


@pytest.fixture
def ranges(monkeypatch: pytest.MonkeyPatch) -> set[tuple[int | None, int | None]]:
    """The ranges that whole numbers are drawn from."""
    seen: set[tuple[int | None, int | None]] = set()
    real = ConjectureData.draw_integer

    def noted(
        self: Any, min_value: int | None = None, max_value: int | None = None, **given: Any
    ) -> int:
        seen.add((min_value, max_value))
        return real(self, min_value, max_value, **given)

    monkeypatch.setattr(ConjectureData, "draw_integer", noted)
    return seen


def beyond(ranges: set[tuple[int | None, int | None]]) -> Iterator[tuple[int | None, int | None]]:
    """Those from which a constant of some loaded module may be taken: it has three digits."""
    yield from (r for r in ranges if r[0] is None or r[1] is None or r[0] < -99 or r[1] > 99)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "drawn", [SampleSpace(), SampleSpace(degree=64), SampleSpace(schemes=("stormer-verlet",))]
)
def test_nothing_that_is_drawn_depends_on_what_is_loaded(
    drawn: SampleSpace, plant: Plant, ranges: set[tuple[int | None, int | None]]
) -> None:
    plant(lambda _: 0.0)
    search(task(drawn=drawn, steps=100_000, count=100))
    assert len(ranges) > 5
    assert list(beyond(ranges)) == []


def test_the_check_sees_larger_coefficients(ranges: set[tuple[int | None, int | None]]) -> None:
    @settings(max_examples=50, database=None)
    @given(strategies.hamiltonians(size=9))
    def drawn(_: object) -> None: ...

    drawn()
    assert (0, 161) in beyond(ranges)


def test_one_worker_and_two_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hunting, "_SCENES_OF_ISLAND", 8)
    asked = Hunt(measure="growth", seed=5, examples=16, steps=2, drawn=POLYNOMIAL)
    assert len(asked.plan.tasks) == 2
    alone, two = (hunt(asked, Store(None), where=Placement(n)) for n in (1, 2))
    assert alone == two
    assert alone.worst
    other = Hunt(measure="growth", seed=6, examples=16, steps=2, drawn=POLYNOMIAL)
    assert hunt(other, Store(None), where=THIS_PROCESS) != alone


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"measure": "beauty"}, "maximise=beauty: unknown; allowed: rounding-share, digits-lost"),
        ({"examples": 0}, "examples=0: must be 1 … 10000000"),
        ({"examples": 10**12}, "examples=1000000000000: must be"),
        ({"seed": -1}, "seed=-1: must be 0 or more"),
        ({"steps": 1}, "steps=1: must be 2 … 1000000"),
        ({"drawn": SampleSpace(kinds=("round",))}, "kinds=round: unknown"),
        ({"drawn": SampleSpace(schemes=("nothing",))}, "nothing"),
        ({"drawn": SampleSpace(degree=0)}, "degree=0"),
    ],
)
def test_a_bad_argument_is_named(changes: dict[str, Any], said: str) -> None:
    good: dict[str, Any] = {"measure": "growth", "seed": 1, "examples": 10}
    Hunt(**good)
    with pytest.raises(InputError) as error:
        Hunt(**good | changes)
    assert said in str(error.value)
