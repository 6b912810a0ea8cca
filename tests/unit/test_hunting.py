"""The hunter finds a planted worst case, the same one each time; measures are what they say."""

import json
import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis.internal.conjecture.data import ConjectureData

from tests.unit.made_gallery import at, gallery, shown
from verify import hunting, strategies
from verify.cli_hunt import _command, _keep_scenes
from verify.errors import InputError
from verify.example import Example
from verify.execute import Store
from verify.explore_results import HuntResult, Worst
from verify.gallery import gallery as gallery_of
from verify.gallery import meaningless
from verify.hunting import Found, Hunt, by_shape, hunt, scene_of, search
from verify.measures import MEASURES, Measure, _greatest, digits_lost, growth, rounding_share
from verify.neighbouring_scenes import neighbours
from verify.scene import scene_from
from verify.separation import separate
from verify.tasks import Drawn, HuntTask

POLYNOMIAL = Drawn(kinds=("polynomial",), degree=4)


def task(**changes: Any) -> HuntTask:
    own: dict[str, Any] = {
        "drawn": POLYNOMIAL, "seed": 7, "measure": "planted", "island": 0, "count": 200, "steps": 2,
    }  # fmt: skip
    return HuntTask(**own | changes)


def example(formula: str, q: str, p: str, h: str, steps: int, scheme: str = "lie2") -> Example:
    grid = {"steps": steps, "step_sizes": [h], "initial_values": [{"q": q, "p": p}]}
    return Example.of(scene_from({"hamiltonian": formula, "schemes": [scheme], "grid": grid}, "x"))


# -- a planted worst case -------------------------------------------------------------------------

Plant = Callable[[Callable[[Example], float | None]], None]


@pytest.fixture
def plant(monkeypatch: pytest.MonkeyPatch) -> Plant:
    def planted(value: Callable[[Example], float | None]) -> None:
        measure = Measure("planted", "planted", lambda example, _: value(example))
        monkeypatch.setitem(MEASURES, "planted", measure)

    return planted


def near(q: str, p: str) -> Callable[[Example], float]:
    """By far the greatest at one initial value, and ever greater towards it."""

    def value(example: Example) -> float:
        far = abs(example.q - Fraction(q)) + abs(example.p - Fraction(p))
        return -math.log10(far + Fraction(1, 10**9))

    return value


def test_a_planted_worst_scene_is_found(plant: Plant) -> None:
    plant(near("1.37", "-0.74"))  # tenths are drawn: hundredths are found by the local search
    worst = search(task()).worst[0]
    assert worst.value == pytest.approx(9)
    found = Example.of(scene_of(worst))
    assert (found.q, found.p) == (Fraction("1.37"), Fraction("-0.74"))


def test_without_the_local_search_it_is_not_found(
    plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant(near("1.37", "-0.74"))
    monkeypatch.setattr(hunting, "_refined", lambda _: None)
    assert search(task()).worst[0].value < 2


def test_what_is_out_of_bounds_is_not_found(plant: Plant) -> None:
    plant(near("2.5", "0"))
    worst = search(task()).worst[0]
    assert Example.of(scene_of(worst)).q == 2


def test_a_planted_term_of_h_is_found(plant: Plant) -> None:
    """A needle that no slope leads to: only drawing finds it, and its coefficient is then moved."""

    def value(example: Example) -> float:
        term = {str(t): c for t, c in example.hamiltonian.exact.as_coefficients_dict().items()}
        c = abs(Fraction(str(term.get("p**3", 0))))
        return 5 + float(min(c, Fraction(50))) if c else 0.0

    plant(value)
    worst = search(task()).worst[0]
    assert 5 + 4 <= worst.value <= 5 + 7, "doubled as long as it is an ordinary coefficient"


def test_a_value_that_another_precision_does_not_confirm_is_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def value(example: Example, digits: int) -> float:
        return float(example.q) + (digits > 40) * (example.q > 0)

    monkeypatch.setitem(MEASURES, "planted", Measure("planted", "", value))
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
        seen: list[Example] = []
        plant(lambda example, seen=seen: seen.append(example) or 0.0)  # type: ignore[misc]
        found = search(task(count=count))
        assert found.examples <= count
        assert len(seen) <= count + len(found.worst), "each of the worst once more"


def test_all_scenes_that_are_looked_at_are_within_the_bounds(plant: Plant) -> None:
    seen: list[Example] = []
    plant(lambda example: seen.append(example) or float(sum(map(abs, example.start.values()))))  # type: ignore[func-returns-value]
    search(task())
    least, most = hunting.STEP_SIZES
    assert len(seen) > 150
    assert all(max(abs(x.q), abs(x.p)) <= hunting.REACH for x in seen)
    assert all(least <= x.step_size <= most for x in seen)
    reached = {abs(x.q) for x in seen} & {abs(x.p) for x in seen}
    assert hunting.REACH in reached, "the bounds themselves are looked at"


def test_neighbours_keep_to_the_bounds_of_coefficients() -> None:
    start = scene_of(Worst(value=0.0, scene=_text("7*p**2 + q**2/7 + q/(2*p**2 + 2)")))
    bounds = {"reach": Fraction(2), "steps": hunting.STEP_SIZES}
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
    found = by_shape([Worst(value=0.0, scene=_text(f)) for f in formulas])
    kept = [each.scene.split('"')[1] for each in found]
    assert kept == [formulas[i] for i in (0, 2, 3, 4, 6, 8)]


def test_islands_look_at_other_scenes(plant: Plant) -> None:
    seen: list[set[str]] = []
    for island in (0, 1, 0):
        own: set[str] = set()
        plant(lambda x, own=own: own.add(str(x.scene)) or 0.0)  # type: ignore[misc]
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


@pytest.mark.parametrize("drawn", [Drawn(), Drawn(degree=64), Drawn(schemes=("stormer-verlet",))])
def test_nothing_that_is_drawn_depends_on_what_is_loaded(
    drawn: Drawn, plant: Plant, ranges: set[tuple[int | None, int | None]]
) -> None:
    plant(lambda _: 0.0)
    search(task(drawn=drawn, steps=100_000))
    assert len(ranges) > 5
    assert list(beyond(ranges)) == []


def test_the_check_sees_larger_coefficients(ranges: set[tuple[int | None, int | None]]) -> None:
    @settings(max_examples=50, database=None)
    @given(strategies.hamiltonians(size=9))
    def drawn(_: object) -> None: ...

    drawn()
    assert (0, 161) in beyond(ranges)


def test_one_worker_and_two_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hunting, "_ISLAND", 8)
    asked = Hunt(measure="growth", seed=5, examples=16, steps=2, drawn=POLYNOMIAL)
    assert len(asked.plan().tasks) == 2
    alone, two = (hunt(asked, Store(None), workers=n) for n in (1, 2))
    assert alone == two
    assert alone.worst
    other = Hunt(measure="growth", seed=6, examples=16, steps=2, drawn=POLYNOMIAL)
    assert hunt(other, Store(None), workers=1) != alone


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"measure": "beauty"}, "maximise=beauty: unknown; allowed: rounding-share, digits-lost"),
        ({"examples": 0}, "examples=0: must be 1 … 10000000"),
        ({"examples": 10**12}, "examples=1000000000000: must be"),
        ({"seed": -1}, "seed=-1: must be 0 or more"),
        ({"steps": 1}, "steps=1: must be 2 … 1000000"),
        ({"drawn": Drawn(kinds=("round",))}, "kinds=round: unknown"),
        ({"drawn": Drawn(schemes=("nothing",))}, "nothing"),
        ({"drawn": Drawn(degree=0)}, "degree=0"),
    ],
)
def test_a_bad_argument_is_named(changes: dict[str, Any], said: str) -> None:
    good: dict[str, Any] = {"measure": "growth", "seed": 1, "examples": 10}
    Hunt(**good)
    with pytest.raises(InputError) as error:
        Hunt(**good | changes)
    assert said in str(error.value)


# -- measures -------------------------------------------------------------------------------------


def test_growth_of_the_oscillator_is_its_closed_form() -> None:
    """lie2 on (p² + ω²q²)/2: det J = 1 + (ωh)⁴/4."""
    found = growth(example("p**2/2 + 9*q**2/2", "1", "0", "0.1", 50))
    expected = math.log10(math.expm1(50 * math.log1p(0.3**4 / 4)))
    assert found == pytest.approx(expected, abs=1e-12)
    assert growth(example("p**2/2 + q**2/2", "1", "0", "0.1", 50, "symplectic-euler")) is None


def test_rounding_share_is_that_of_a_separation() -> None:
    asked = example("p**2/2 - cos(q)", "1", "0.5", "0.001", 200)
    largest = separate(
        asked.hamiltonian, "lie2", q="1", p="0.5", step_size="0.001", steps=200
    ).plain.largest  # type: ignore[union-attr]
    expected = math.log10(float(largest["total"]) / float(largest["truncation"]))
    assert rounding_share(asked) == pytest.approx(expected, abs=1e-4)
    same = example("p**2/2 - cos(q)", "1", "0.5", "0.001", 200, "symplectic-euler")
    assert rounding_share(same) is None, "no truncation to be a share of"


def test_what_is_below_its_own_error_bound_is_not_hunted() -> None:
    trail = (Fraction(1, 10**30), Fraction(0))
    assert _greatest(trail, Fraction(1, 10**29)) == 0
    assert _greatest(trail, Fraction(1, 10**32)) == Fraction(1, 10**30)


def test_digits_lost_is_the_error_of_a_float64_loop() -> None:
    """Euler's step on the oscillator, whose floating-point operations have one order only."""
    h, exact, floats = Fraction(1, 20), (Fraction(1), Fraction(1, 2)), (1.0, 0.5)
    size = Fraction(1)
    for k in range(400):
        (q, p), (fq, fp) = exact, floats
        exact, floats = (q + h * p, p - h * q), (fq + 0.05 * fp, fp - 0.05 * fq)
        size = max(size, *map(abs, exact)) if (k + 1) % 25 == 0 else size  # 16 checkpoints
    error = max(abs(Fraction(f) - e) for f, e in zip(floats, exact, strict=True))
    found = digits_lost(example("p**2/2 + q**2/2", "1", "0.5", "0.05", 400, "euler"))
    assert found == pytest.approx(math.log10(error / size * 2**53), abs=1e-9)


def test_passing_the_origin_loses_no_digits() -> None:
    """q' = 1 from −1.1: q comes to 0 after 11 steps, where a relative error would be infinite."""
    found = digits_lost(example("p", "-1.1", "0", "0.1", 11))
    assert found is not None
    assert found < 1


def test_an_orbit_that_goes_far_has_no_measure() -> None:
    far = example("p*q", "2", "1", "0.1", 100)
    assert [each.value(far, 40) for each in MEASURES.values()] == [None] * 3


# -- what is shown --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("series", "first", "over"),
    [
        ([(5, "1e-6", "1e-16"), (9, "1e-9", "1e-15")], None, None),
        ([(5, "1e-12", "1e-16"), (9, "1e-12", "1e-11")], 9, None),
        ([(5, "1e-16", "1e-15"), (9, "1e-11", "1e-15"), (12, "-1e-10", "1e-14")], 5, 9),
        ([(5, "1e-6", "0"), (9, "0", "1e-16")], None, None),  # Λ passes through 0
        ([(5, "0", "0"), (9, "0", "0")], None, None),  # nothing, or of no known digit
        ([(5, "0", "0"), (9, "1e-6", "1e-12")], None, None),
        ([(5, "0", "-1e-16")], 5, None),  # all of it is rounding
    ],
)
def test_where_lambda_is_meaningless(
    series: list[tuple[int, str, str]], first: int | None, over: int | None
) -> None:
    found = meaningless([at(*each) for each in series])
    assert (found.first, found.over) == (first, over)


def test_a_run_that_does_not_end_is_shown_by_the_hunts_own() -> None:
    asked = Hunt(measure="growth", seed=1, examples=1, steps=20)
    text = _text("p**2/2 + 9*q**2/2").replace("steps = 2", "steps = 20")
    far = _text("p*q**2").replace("steps = 2", "steps = 20")
    found = Found((Worst(value=1.0, scene=text), Worst(value=0.5, scene=far)), 2)
    kept, lost = gallery_of(asked, found, Store(None), workers=1).scenes
    assert (kept.separation.steps, kept.longer) == (2000, None)
    assert (lost.separation.steps, lost.separation.status) == (20, "finished")
    assert lost.longer is not None
    assert (lost.longer.steps, lost.longer.status) == (2000, "left range")
    assert lost.orbit[0] == ("1.00000e-01", "1.00000e-01")
    assert "separate = true" in kept.scene, "its own report shows what the gallery shows"


def test_the_command_makes_the_same_hunt_again() -> None:
    drawn = Drawn(kinds=("polynomial",), degree=4, schemes=("lie1", "p_next = p; q_next = q"))
    asked = Hunt(measure="growth", seed=3, examples=10, steps=50)
    assert _command(asked) == ("verify explore --maximise growth --examples 10 --seed 3 --steps 50")
    object.__setattr__(asked, "drawn", drawn)
    assert _command(asked).endswith(
        "--steps 50 --scheme lie1 --scheme 'p_next = p; q_next = q' --kind polynomial --degree 4"
    )


def test_scenes_of_an_earlier_hunt_do_not_stay(tmp_path: Path) -> None:
    for name in ("worst-1.toml", "worst-2.toml", "worst-12.toml", "worst-of-mine.toml"):
        (tmp_path / name).write_text("old")
    _keep_scenes(gallery(shown()), tmp_path)
    left = {file.name: file.read_text() for file in tmp_path.iterdir()}
    assert set(left) == {"worst-1.toml", "worst-of-mine.toml"}
    assert left["worst-1.toml"] == shown().scene


def test_results_are_the_same_after_a_round_trip() -> None:
    made = gallery(shown())
    assert type(made).model_validate_json(made.model_dump_json()) == made
    found = HuntResult(worst=(Worst(value=-1.5, scene="x"),), examples=3)
    assert HuntResult.model_validate(json.loads(found.model_dump_json())) == found
