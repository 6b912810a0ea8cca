"""The search on one island of a hunt: by hypothesis's `target`, then refined by single numbers.

A local search moves to neighbours, scenes that differ slightly in a single number. Each scene of
the result was measured twice, the second time with twice the digits.
"""

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
from verify.exploration.different_scenes import scene_of, select_by_shape, shape_of
from verify.exploration.measures import DIGITS, MEASURES, Measure
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes import hamiltonians_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.exploration import HuntResult, Worst
from verify.scenes.scene import Scene, scene_from
from verify.scenes.toml_text import scene_text
from verify.strategies.numbers import starts

_FACTORS = (Fraction(1, 2), Fraction(4, 5), Fraction(5, 4), Fraction(2))
_MOVES = tuple(sign * Fraction(1, 10**k) for k in (1, 2) for sign in (1, -1))
_PLACES = 3  # decimals of a coefficient or a step size


def neighbours(
    scene: Scene,
    *,
    reach: Fraction,
    steps: tuple[Fraction, Fraction],
    coefficients: tuple[Fraction, Fraction],
) -> Iterator[Scene]:
    """Yield each neighbour once: with another initial value, step size or coefficient of H.

    Initial values stay within `reach`, step sizes within `steps`, and the |coefficients| of H
    within `coefficients`; without that last bound a search would only make H ever larger.
    """
    sample = Sample.from_scene(scene)
    formula, place, h, n = (
        scene.hamiltonian or "",
        sample.place,
        sample.step_size,
        len(sample.place),
    )

    order = (*range(n // 2, n), *range(n // 2))  # q, then p
    moved_places = [
        (*place[:k], place[k] + move, *place[k + 1 :]) for move in _MOVES for k in order
    ]
    sizes = [min(max(_round(h * factor), steps[0]), steps[1]) for factor in _FACTORS]
    others = chain(
        ((formula, place, size) for size in sizes),
        ((formula, other, h) for other in moved_places if max(map(abs, other)) <= reach),
        ((other, place, h) for other in _formulas(sample.hamiltonian, coefficients)),
    )
    yielded = {(formula, place, h)}
    for other in others:
        if other not in yielded:
            yielded.add(other)
            with suppress(InputError):  # such as an H that is not defined there
                yield _scene(sample, *other)


def _scene(sample: Sample, formula: str, place: Iterable[Fraction], h: Fraction) -> Scene:
    arguments = sample.with_place(place).run_arguments
    start = {name: arguments[name] for name in ("q", "p")}
    grid = {"steps": sample.steps, "step_sizes": [h], "initial_values": [start]}
    whole = {"hamiltonian": formula, "t0": sample.t0, "schemes": sample.scene.schemes, "grid": grid}
    return scene_from(whole, "neighbour")


def _formulas(hamiltonian: Hamiltonian, bounds: tuple[Fraction, Fraction]) -> Iterator[str]:
    """Yield H with one coefficient of its sum changed."""
    least, greatest = bounds
    terms = sympy.Add.make_args(hamiltonian.exact)
    for k, term in enumerate(terms):
        content, primitive = term.as_content_primitive()  # 1/(2*p**2 + 2) has a factor of ½
        sign, rest = primitive.as_coeff_Mul()
        coefficient = content * sign
        if not coefficient.is_Rational or rest.is_number:
            continue
        for factor in (*_FACTORS, Fraction(-1)):
            value = _round(Fraction(int(coefficient.p), int(coefficient.q)) * factor)
            if least <= abs(value) <= greatest:
                changed_term = sympy.Rational(value) * rest
                yield to_text(sympy.Add(*terms[:k], changed_term, *terms[k + 1 :]))


def _round(x: Fraction) -> Fraction:
    """Round to so few decimals that the scene stays readable."""
    return round(x, _PLACES)


REACH, STEP_SIZES = Fraction(2), (Fraction(1, 1000), Fraction(1, 10))
_THOUSANDTHS = (100, 50, 20, 10, 5, 2, 1, 80, 60, 40, 30, 25, 15, 8, 6, 4, 3)  # of drawn step sizes
SIZE = 7  # of the coefficients' numerators and denominators: the greatest that is drawn
COEFFICIENTS = Fraction(1, SIZE), Fraction(SIZE)
MOST_EXAMPLES = 10**7  # of a hunt, so that no two islands of two seeds draw the same
KEPT = 6
_DIRECTED = Fraction(3, 5)  # of the scenes, by hypothesis; the others are neighbours of the worst
_TENTHS = 20
_AGREEMENT = 0.01  # of lg of a measure, with twice the digits


def search_island(
    measure: str, space: SampleSpace, seed: int, island: int, *, count: int, steps: int
) -> HuntResult:
    """Return the worst scenes among the `count` that the island measures, of `steps` steps each."""
    look = MeasuredScenes(MEASURES[measure], count)
    # Seeds of two islands differ, also for different seeds of the hunt: see MOST_EXAMPLES.
    chance = seed * MOST_EXAMPLES + island
    _search_directed(look, hunted_scenes(space, steps), chance, max(1, int(count * _DIRECTED)))
    _refine(look)
    return HuntResult(worst=tuple(_confirm_worst(look)), examples=len(look.seen))


class MeasuredScenes:
    """The measured scenes of an island, at most `limit`, with their values."""

    def __init__(self, measure: Measure, limit: int) -> None:
        self.measure, self.limit = measure, limit
        self.seen: dict[str, float | None] = {}

    def __call__(self, scene: Scene) -> float | None:
        """Measure a scene; None also if the limit of scenes is reached."""
        # The text identifies a scene, so that a scene drawn twice is measured once.
        text = scene_text(scene)
        if text not in self.seen and self.has_room:
            self.seen[text] = self.measure.evaluate(Sample.from_scene(scene), DIGITS)
        return self.seen.get(text)

    @property
    def has_room(self) -> bool:
        """True if one more scene may be measured."""
        return len(self.seen) < self.limit

    def worst(self) -> list[Worst]:
        """Return all scenes that have a value, the worst first."""
        values = ((text, value) for text, value in self.seen.items() if value is not None)
        return sorted((Worst(value=value, scene=text) for text, value in values), key=sorting_key)


def sorting_key(each: Worst) -> tuple[float, int, str]:
    """Return the sorting key: the worst first, among equal ones the shortest."""
    return -each.value, len(each.scene), each.scene


def _confirm_worst(look: MeasuredScenes) -> Iterator[Worst]:
    """Yield the worst scene of each shape whose value is confirmed with twice the digits."""
    shapes: set[str] = set()
    for each in look.worst():
        shape = shape_of(each)
        if len(shapes) == KEPT:
            return
        if shape in shapes:
            continue
        again = look.measure.evaluate(Sample.from_scene(scene_of(each)), 2 * DIGITS)
        # A value that changes with more digits is made of rounding errors, and is no measure.
        if again is not None and abs(again - each.value) <= _AGREEMENT:
            shapes.add(shape)
            yield Worst(value=again, scene=each.scene)


def _search_directed(
    look: MeasuredScenes, scenes: st.SearchStrategy[Scene], chance: int, count: int
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
        value = look(scene)
        if value is not None:
            target(value)

    # Where every scene that is drawn has to be rejected, there are none to look at.
    with suppress(Unsatisfiable):
        look_at()


def _refine(look: MeasuredScenes) -> None:
    """Climb from the worst scene of each shape in turn, as long as scenes may be measured."""
    for begin in select_by_shape(look.worst()):
        if not look.has_room:
            return
        _climb(begin, look)


def _climb(begin: Worst, look: MeasuredScenes) -> None:
    """Move to the first neighbour that is worse, as long as there is one."""
    value, scene, has_moved = begin.value, scene_of(begin), True
    while has_moved:
        has_moved = False
        for other in neighbours(scene, reach=REACH, steps=STEP_SIZES, coefficients=COEFFICIENTS):
            if not look.has_room:
                return
            measured_value = look(other)
            if measured_value is not None and measured_value > value:
                value, scene, has_moved = measured_value, other, True
                break


def hunted_scenes(drawn: SampleSpace, steps: int) -> st.SearchStrategy[Scene]:
    """Return a strategy for plain scenes: few terms, starts in tenths, h from 1/1000 to 1/10."""
    # No whole number that is drawn may be 100 or more: hypothesis likes to try those that stand in
    # the modules loaded, and what is drawn would then depend on which these are. A coefficient with
    # its sign is drawn as a number below 2·SIZE².
    tenths = st.integers(-_TENTHS, _TENTHS).map(lambda n: Fraction(n, 10))
    return strategies.scenes(
        hamiltonians=hamiltonians_of(drawn, terms=3 if drawn.degrees == 1 else 2, size=SIZE),
        schemes=strategies.schemes(names=drawn.schemes or ("lie2",)),
        initial_values=starts(tenths, drawn.degrees),
        initial_times=tenths,
        step_sizes=st.sampled_from([Fraction(n, 1000) for n in _THOUSANDTHS]),
        steps=(steps, steps),
    )
