"""The scenes of a seed: number k of seed S is the same scene everywhere and always.

A scene is drawn from bytes that S and k alone make, so that it does not matter which of the others
were drawn, where, or by how many workers.
"""

import random
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.database import InMemoryExampleDatabase

from verify import strategies
from verify.exploration.property import Violation
from verify.exploration.sample_space import SampleSpace
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.scene import Scene
from verify.strategies.schemes import separable_for

_BYTES = 4096
_MOST_STEPS = 12
_ATTEMPTS = 100
_TERMS, _TERMS_IN_DEGREES = 4, 2  # the latter of each of several degrees of freedom

Fault = Callable[[Scene], str]  # what is wrong with a scene; empty where nothing is


@lru_cache(maxsize=32)
def scenes_of(drawn: SampleSpace) -> st.SearchStrategy[Scene]:
    """The strategy. Raises InputError for an unknown kind or scheme, and a degree below 1."""
    terms = _TERMS if drawn.degrees == 1 else _TERMS_IN_DEGREES
    usual = not drawn.kinds and drawn.degree == SampleSpace().degree
    return strategies.scenes(
        hamiltonians=None if usual else hamiltonians_of(drawn, terms),
        schemes=strategies.schemes(names=drawn.schemes) if drawn.schemes else None,
        steps=(1, _MOST_STEPS),
        time_dependent=drawn.time_dependent and usual,
        degrees=drawn.degrees,
    )


def hamiltonians_of(
    drawn: SampleSpace, terms: int, size: int = 9
) -> st.SearchStrategy[Hamiltonian]:
    """Those of the space; `terms` and `size` as `verify.strategies.hamiltonians` has them."""
    return strategies.hamiltonians(
        drawn.kinds or strategies.KINDS,
        degree=drawn.degree,
        separable=separable_for(drawn.schemes),
        time_dependent=drawn.time_dependent,
        terms=terms,
        size=size,
        degrees=drawn.degrees,
    )


def sample_scene(drawn: SampleSpace, seed: int, number: int) -> Scene:
    """Scene `number` of the seed."""
    box, fuzz = _drawer(drawn)
    for attempt in range(_ATTEMPTS):
        box.clear()
        fuzz(bytes_of(seed, number, attempt))
        if box:
            return box[0]
    raise RuntimeError(f"none of {_ATTEMPTS} draws gives a scene")


def bytes_of(seed: int, number: int, attempt: int = 0) -> bytes:
    """What a scene is drawn from."""
    return random.Random(f"{seed}:{number}:{attempt}").randbytes(_BYTES)  # noqa: S311 - no secret


@lru_cache(maxsize=32)
def _drawer(drawn: SampleSpace) -> tuple[list[Scene], Callable[[bytes], Any]]:
    box: list[Scene] = []

    @settings(database=None)
    @given(scenes_of(drawn))
    def draw(scene: Scene) -> None:
        box.append(scene)

    return box, draw.hypothesis.fuzz_one_input  # type: ignore[attr-defined]


def simplest(drawn: SampleSpace, seed: int, number: int, look: Fault) -> tuple[Scene, str]:
    """The simplest scene that hypothesis shrinks that one to, where `look` still finds something.

    It must find something in that scene itself.
    """
    found: list[tuple[Scene, str]] = []

    @settings(
        database=InMemoryExampleDatabase(),
        phases=(Phase.reuse, Phase.shrink),
        deadline=None,
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
        print_blob=False,
    )
    @seeded(0)  # below the settings: shrinking takes chances, and a seed would forget the database
    @given(scenes_of(drawn))
    def fails(scene: Scene) -> None:
        wrong = look(scene)
        if wrong:
            found.append((scene, wrong))
            raise Violation(wrong)

    for attempt in range(_ATTEMPTS):
        try:
            fails.hypothesis.fuzz_one_input(bytes_of(seed, number, attempt))  # type: ignore[attr-defined]
        except Violation:
            break
    try:
        fails()
    except Violation:  # hypothesis ends with the simplest
        return found[-1]
    raise RuntimeError(f"scene {number} of seed {seed} fails no more")
