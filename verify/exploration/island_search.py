"""The search on one island of a hunt, an independent part of it with its own seed.

First hypothesis draws scenes, with the measure as its `target`. Then a local search moves from the
worst ones to neighbours, scenes that differ slightly in a single number. The result has one scene
for each shape of H, the form of its terms without their numbers, so that it has no variants of one
scene. Each of them is measured again, with twice the digits.
"""

import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from fractions import Fraction
from itertools import chain

import sympy
from hypothesis import HealthCheck, Phase, given, settings, target
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.errors import Unsatisfiable

from verify import strategies
from verify.algebra.expressions.formula_text import to_text
from verify.errors import InputError
from verify.exploration.measures import DIGITS, MEASURES, Measure
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes_of_seed import hamiltonians_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.exploration import HuntResult, Worst
from verify.scenes.scene import Scene, scene_from, scene_text
from verify.scenes.toml_file import toml_data
from verify.strategies.exact_numbers import starts

_FACTORS = (Fraction(1, 2), Fraction(4, 5), Fraction(5, 4), Fraction(2))
_MOVES = tuple(sign * Fraction(1, 10**k) for k in (1, 2) for sign in (1, -1))
_DECIMAL_PLACES = 3  # of a coefficient or a step size
# The limits of a neighbour's |coordinates| at the start, step sizes and |coefficients|.
REACH, STEP_SIZES = Fraction(2), (Fraction(1, 1000), Fraction(1, 10))
_STEP_SIZES_IN_THOUSANDTHS = (100, 50, 20, 10, 5, 2, 1, 80, 60, 40, 30, 25, 15, 8, 6, 4, 3)
MAX_INTEGER = 7  # the greatest numerator, or denominator, of a drawn coefficient
COEFFICIENTS = Fraction(1, MAX_INTEGER), Fraction(MAX_INTEGER)
MOST_EXAMPLES = 10**7  # in a hunt, so that no two islands of two seeds draw the same scenes
SCENES_IN_RESULT = 6  # at most, of a hunt
_DIRECTED_SHARE = Fraction(3, 5)  # of the scenes, drawn by hypothesis; the others are neighbours
_MAX_START_IN_TENTHS = 20
_CONFIRMATION_TOLERANCE = 0.01  # the change of lg of a measure with twice the digits
_NUMBERS_BUT_EXPONENTS = re.compile(r"(?<![*\w]{2})(?<!\w)[0-9]+")
_EQUAL_VALUE_TOLERANCE = 0.1  # in lg of a measure: a factor of about 5/4


# -- similar scenes ------------------------------------------------------------------------


def scene_of(worst: Worst) -> Scene:
    """Parse the scene from its text."""
    return scene_from(toml_data(worst.scene, "scene"), "scene")


def select_by_shape(scenes: Iterable[Worst]) -> list[Worst]:
    """Return the first scene of each shape of H, in the given order."""
    first_of_shape: dict[str, Worst] = {}
    for worst in scenes:
        first_of_shape.setdefault(shape_of(worst), worst)
    return list(first_of_shape.values())


def shape_of(worst: Worst) -> str:
    """Return the terms of H without coefficients, and with all numbers but exponents as n."""
    return " + ".join(sorted(_terms(worst)))


def select_different(scenes: Iterable[Worst]) -> list[Worst]:
    """Return the scenes in the given order, without those that are similar to an earlier one.

    Two scenes are similar if their values are about equal, they have the same scheme, and they have
    the same start, or the terms of one H include those of the other.
    """
    selected: list[Worst] = []
    for worst in scenes:
        if not any(_are_similar(worst, other) for other in selected):
            selected.append(worst)
    return selected


def _are_similar(a: Worst, b: Worst) -> bool:
    if abs(a.value - b.value) > _EQUAL_VALUE_TOLERANCE:
        return False
    one, other = (Sample.from_scene(scene_of(each)) for each in (a, b))
    if one.scheme.name != other.scheme.name:
        return False
    of_one, of_other = _terms(a), _terms(b)
    same_start = one.run_arguments == other.run_arguments
    return same_start or of_one <= of_other or of_other <= of_one


def _terms(worst: Worst) -> set[str]:
    terms = sympy.Add.make_args(scene_of(worst).exact_hamiltonian().exact)
    # The content of a term is its rational factor; what remains is the term's shape.
    primitive = (term.as_content_primitive()[1].as_coeff_Mul()[1] for term in terms)
    return {_NUMBERS_BUT_EXPONENTS.sub("n", str(term)) for term in primitive}


# -- neighbours -----------------------------------------------------------------------------------


def neighbours(
    scene: Scene,
    *,
    reach: Fraction,
    steps: tuple[Fraction, Fraction],
    coefficients: tuple[Fraction, Fraction],
) -> Iterator[Scene]:
    """Yield each scene once that differs in an initial value, the step size or a coefficient of H.

    Initial values stay within `reach`, step sizes within `steps`, and the |coefficients| of H
    within `coefficients`; without this last limit a search would only make H ever larger.
    """
    sample = Sample.from_scene(scene)
    formula = scene.hamiltonian or ""
    place = sample.place
    h = sample.step_size
    n = len(sample.place)

    order = (*range(n // 2, n), *range(n // 2))  # q, then p
    moved_places = [
        (*place[:k], place[k] + move, *place[k + 1 :]) for move in _MOVES for k in order
    ]
    sizes = [min(max(_round(h * factor), steps[0]), steps[1]) for factor in _FACTORS]
    candidates = chain(
        ((formula, place, size) for size in sizes),
        ((formula, moved, h) for moved in moved_places if max(map(abs, moved)) <= reach),
        ((changed, place, h) for changed in _changed_formulas(sample.hamiltonian, coefficients)),
    )
    yielded = {(formula, place, h)}
    for candidate in candidates:
        if candidate not in yielded:
            yielded.add(candidate)
            with suppress(InputError):  # H may be undefined at the new start
                yield _build_scene(sample, *candidate)


def _build_scene(sample: Sample, formula: str, place: Iterable[Fraction], h: Fraction) -> Scene:
    arguments = sample.with_place(place).run_arguments
    start = {name: arguments[name] for name in ("q", "p")}
    grid = {"steps": sample.steps, "step_sizes": [h], "initial_values": [start]}
    whole = {"hamiltonian": formula, "t0": sample.t0, "schemes": sample.scene.schemes, "grid": grid}
    return scene_from(whole, "neighbour")


def _changed_formulas(hamiltonian: Hamiltonian, bounds: tuple[Fraction, Fraction]) -> Iterator[str]:
    """Yield the formulas of H with one coefficient changed."""
    lowest, highest = bounds
    terms = sympy.Add.make_args(hamiltonian.exact)
    for k, term in enumerate(terms):
        content, primitive = term.as_content_primitive()  # 1/(2*p**2 + 2) has a factor of ½
        sign, shape = primitive.as_coeff_Mul()
        coefficient = content * sign
        if not coefficient.is_Rational or shape.is_number:
            continue
        for factor in (*_FACTORS, Fraction(-1)):
            value = _round(Fraction(int(coefficient.p), int(coefficient.q)) * factor)
            if lowest <= abs(value) <= highest:
                changed_term = sympy.Rational(value) * shape
                yield to_text(sympy.Add(*terms[:k], changed_term, *terms[k + 1 :]))


def _round(x: Fraction) -> Fraction:
    """Round to a few decimals, so that the scene stays readable."""
    return round(x, _DECIMAL_PLACES)


# -- the search -----------------------------------------------------------------------------------


def search_island(
    measure: str, space: SampleSpace, seed: int, island: int, *, count: int, steps: int
) -> HuntResult:
    """Return the worst scenes among the `count` that the island measures, of `steps` steps each."""
    measured_scenes = MeasuredScenes(MEASURES[measure], count)
    # Seeds of two islands differ, also for different seeds of the hunt: see MOST_EXAMPLES.
    chance = seed * MOST_EXAMPLES + island
    _search_directed(
        measured_scenes, hunted_scenes(space, steps), chance, max(1, int(count * _DIRECTED_SHARE))
    )
    _refine(measured_scenes)
    return HuntResult(
        worst=tuple(_confirm_worst(measured_scenes)), examples=len(measured_scenes.values)
    )


class MeasuredScenes:
    """The measured scenes of an island, at most `limit`, with their values."""

    def __init__(self, measure: Measure, limit: int) -> None:
        self.measure, self.limit = measure, limit
        self.values: dict[str, float | None] = {}

    def __call__(self, scene: Scene) -> float | None:
        """Measure a scene; None also if the limit of scenes is reached."""
        # The text identifies a scene, so that a scene drawn twice is measured once.
        text = scene_text(scene)
        if text not in self.values and self.has_room:
            self.values[text] = self.measure.evaluate(Sample.from_scene(scene), DIGITS)
        return self.values.get(text)

    @property
    def has_room(self) -> bool:
        """True if one more scene may be measured."""
        return len(self.values) < self.limit

    def worst(self) -> list[Worst]:
        """Return all scenes that have a value, the worst first."""
        pairs = ((text, value) for text, value in self.values.items() if value is not None)
        return sorted((Worst(value=value, scene=text) for text, value in pairs), key=sorting_key)


def sorting_key(worst: Worst) -> tuple[float, int, str]:
    """Return the key that sorts the worst scene first, and of equally bad ones the shortest."""
    return -worst.value, len(worst.scene), worst.scene


def _confirm_worst(measured_scenes: MeasuredScenes) -> Iterator[Worst]:
    """Yield the worst scene of each shape whose value is confirmed with twice the digits."""
    shapes: set[str] = set()
    for worst in measured_scenes.worst():
        shape = shape_of(worst)
        if len(shapes) == SCENES_IN_RESULT:
            return
        if shape in shapes:
            continue
        confirmed_value = measured_scenes.measure.evaluate(
            Sample.from_scene(scene_of(worst)), 2 * DIGITS
        )
        # A value that changes with more digits consists of rounding errors.
        if (
            confirmed_value is not None
            and abs(confirmed_value - worst.value) <= _CONFIRMATION_TOLERANCE
        ):
            shapes.add(shape)
            yield Worst(value=confirmed_value, scene=worst.scene)


def _search_directed(
    measured_scenes: MeasuredScenes, scenes: st.SearchStrategy[Scene], chance: int, count: int
) -> None:
    """Measure `count` scenes drawn by hypothesis, which targets those with large values."""

    @seeded(chance)
    @settings(
        max_examples=count,
        database=None,
        phases=(Phase.generate, Phase.target),
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(scenes)
    def look_at(scene: Scene) -> None:
        value = measured_scenes(scene)
        if value is not None:
            target(value)

    # If hypothesis rejects every draw, no scene is measured.
    with suppress(Unsatisfiable):
        look_at()


def _refine(measured_scenes: MeasuredScenes) -> None:
    """Climb from the worst scene of each shape in turn, as long as scenes may be measured."""
    for begin in select_by_shape(measured_scenes.worst()):
        if not measured_scenes.has_room:
            return
        _climb(begin, measured_scenes)


def _climb(begin: Worst, measured_scenes: MeasuredScenes) -> None:
    """Move to the first neighbour that is worse, as long as there is one."""
    value, scene, has_moved = begin.value, scene_of(begin), True
    while has_moved:
        has_moved = False
        for moved in neighbours(scene, reach=REACH, steps=STEP_SIZES, coefficients=COEFFICIENTS):
            if not measured_scenes.has_room:
                return
            measured_value = measured_scenes(moved)
            if measured_value is not None and measured_value > value:
                value, scene, has_moved = measured_value, moved, True
                break


def hunted_scenes(drawn: SampleSpace, steps: int) -> st.SearchStrategy[Scene]:
    """Return a strategy for plain scenes: few terms, starts in tenths, h from 1/1000 to 1/10."""
    # All drawn integers are below 100: hypothesis also tries larger constants of the loaded
    # modules, so that the scenes would depend on which modules are loaded. A coefficient with its
    # sign is drawn as an integer below 2·MAX_INTEGER².
    tenths = st.integers(-_MAX_START_IN_TENTHS, _MAX_START_IN_TENTHS).map(lambda n: Fraction(n, 10))
    return strategies.scenes(
        hamiltonians=hamiltonians_of(drawn, terms=3 if drawn.degrees == 1 else 2, size=MAX_INTEGER),
        schemes=strategies.schemes(names=drawn.schemes or ("lie2",)),
        initial_values=starts(tenths, drawn.degrees),
        initial_times=tenths,
        step_sizes=st.sampled_from([Fraction(n, 1000) for n in _STEP_SIZES_IN_THOUSANDTHS]),
        steps=(steps, steps),
    )
