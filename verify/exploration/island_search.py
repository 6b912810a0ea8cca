"""One island of a hunt: searched with hypothesis's `target`, then refined one number at a time.

What is kept was measured twice, the second time with twice the digits.

Scenes that differ from one in a single number, a little: where a local search looks next.
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
from verify.exploration.different_scenes import by_shape, scene_of, shape_of
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
    """Each once: with another initial value in reach, step size within `steps`, or |coefficient| of
    H within `coefficients`; without that last bound a search would only make H ever larger."""
    sample = Sample.of(scene)
    formula, at, h, n = scene.hamiltonian or "", sample.place, sample.step_size, len(sample.place)
    order = (*range(n // 2, n), *range(n // 2))  # q, then p
    moved = [(*at[:k], at[k] + move, *at[k + 1 :]) for move in _MOVES for k in order]
    sizes = [min(max(_rounded(h * factor), steps[0]), steps[1]) for factor in _FACTORS]
    others = chain(
        ((formula, at, size) for size in sizes),
        ((formula, other, h) for other in moved if max(map(abs, other)) <= reach),
        ((other, at, h) for other in _formulas(sample.hamiltonian, coefficients)),
    )
    seen = {(formula, at, h)}
    for other in others:
        if other not in seen:
            seen.add(other)
            with suppress(InputError):  # such as an H that is not defined there
                yield _scene(sample, *other)


def _scene(sample: Sample, formula: str, at: Iterable[Fraction], h: Fraction) -> Scene:
    moved = sample.at(at).run_arguments
    start = {name: moved[name] for name in ("q", "p")}
    grid = {"steps": sample.steps, "step_sizes": [h], "initial_values": [start]}
    whole = {"hamiltonian": formula, "t0": sample.t0, "schemes": sample.scene.schemes, "grid": grid}
    return scene_from(whole, "neighbour")


def _formulas(hamiltonian: Hamiltonian, within: tuple[Fraction, Fraction]) -> Iterator[str]:
    """H with one coefficient of its sum changed."""
    least, most = within
    terms = sympy.Add.make_args(hamiltonian.exact)
    for k, term in enumerate(terms):
        content, primitive = term.as_content_primitive()  # 1/(2*p**2 + 2) has a factor of ½
        sign, rest = primitive.as_coeff_Mul()
        coefficient = content * sign
        if not coefficient.is_Rational or rest.is_number:
            continue
        for factor in (*_FACTORS, Fraction(-1)):
            value = _rounded(Fraction(int(coefficient.p), int(coefficient.q)) * factor)
            if least <= abs(value) <= most:
                changed = sympy.Rational(value) * rest
                yield to_text(sympy.Add(*terms[:k], changed, *terms[k + 1 :]))


def _rounded(x: Fraction) -> Fraction:
    """To so few decimals that the scene stays readable."""
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
    """The worst scenes among `count` that the island looks at, of so many steps each."""
    look = MeasuredScenes(MEASURES[measure], count)
    chance = seed * MOST_EXAMPLES + island
    _directed(look, hunted_scenes(space, steps), chance, max(1, int(count * _DIRECTED)))
    _refined(look)
    return HuntResult(worst=tuple(_confirmed(look)), examples=len(look.seen))


class MeasuredScenes:
    """Measures scenes, at most so many, and remembers what it found."""

    def __init__(self, measure: Measure, most: int) -> None:
        self.measure, self.most = measure, most
        self.seen: dict[str, float | None] = {}

    def __call__(self, scene: Scene) -> float | None:
        """What a scene measures; None too where there is nothing left to measure it with."""
        text = scene_text(scene)
        if text not in self.seen and self.left:
            self.seen[text] = self.measure.of(Sample.of(scene), DIGITS)
        return self.seen.get(text)

    @property
    def left(self) -> bool:
        """Whether it may measure one more."""
        return len(self.seen) < self.most

    def worst(self) -> list[Worst]:
        """All that have a value, the worst first."""
        known = ((text, value) for text, value in self.seen.items() if value is not None)
        return sorted((Worst(value=value, scene=text) for text, value in known), key=by_value)


def by_value(each: Worst) -> tuple[float, int, str]:
    """The worst first, of equal ones the shortest."""
    return -each.value, len(each.scene), each.scene


def _confirmed(look: MeasuredScenes) -> Iterator[Worst]:
    """The worst of each shape that measures the same with twice the digits."""
    found: set[str] = set()
    for each in look.worst():
        shape = shape_of(each)
        if len(found) == KEPT:
            return
        if shape in found:
            continue
        again = look.measure.of(Sample.of(scene_of(each)), 2 * DIGITS)
        if again is not None and abs(again - each.value) <= _AGREEMENT:
            found.add(shape)
            yield Worst(value=again, scene=each.scene)


def _directed(
    look: MeasuredScenes, scenes: st.SearchStrategy[Scene], chance: int, count: int
) -> None:
    """Looks at so many scenes that hypothesis draws, ever nearer to what measures most."""

    @seeded(chance)
    @settings(
        max_examples=count,
        database=None,
        phases=(Phase.generate, Phase.target),
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(scenes)
    def looked(scene: Scene) -> None:
        value = look(scene)
        if value is not None:
            target(value)

    # Where every scene that is drawn has to be rejected, there are none to look at.
    with suppress(Unsatisfiable):
        looked()


def _refined(look: MeasuredScenes) -> None:
    """Climbs from the worst scene of each shape in turn, as long as scenes may be looked at."""
    for begin in by_shape(look.worst()):
        if not look.left:
            return
        _climb(begin, look)


def _climb(begin: Worst, look: MeasuredScenes) -> None:
    """Moves to the first neighbour that is worse, as long as there is one."""
    value, scene, moved = begin.value, scene_of(begin), True
    while moved:
        moved = False
        for other in neighbours(scene, reach=REACH, steps=STEP_SIZES, coefficients=COEFFICIENTS):
            if not look.left:
                return
            found = look(other)
            if found is not None and found > value:
                value, scene, moved = found, other, True
                break


def hunted_scenes(drawn: SampleSpace, steps: int) -> st.SearchStrategy[Scene]:
    """Ordinary-looking ones: a few terms, initial values in tenths, h from 1/1000 to 1/10."""
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
