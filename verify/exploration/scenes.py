"""The scenes of a seed: scene k of seed S is the same everywhere and always.

A scene is drawn from bytes that depend on S and k alone, so that it does not matter which others
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

# Bytes for one scene: hypothesis rejects a draw that needs more.
_BYTES = 4096
_MOST_STEPS = 12
_ATTEMPTS = 100
_TERMS, _TERMS_IN_DEGREES = 4, 2  # the latter of each of several degrees of freedom

Fault = Callable[[Scene], str]  # what is wrong with a scene; empty where nothing is


@lru_cache(maxsize=32)
def scenes_of(drawn: SampleSpace) -> st.SearchStrategy[Scene]:
    """Return the strategy for the space's scenes.

    Raises InputError for an unknown kind or scheme, and a degree below 1.
    """
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
    """Return the strategy for the H of the space; see `verify.strategies.hamiltonians`."""
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
    """Draw scene `number` of the seed."""
    box, fuzz = _drawer(drawn)
    for attempt in range(_ATTEMPTS):
        box.clear()
        fuzz(bytes_of(seed, number, attempt))
        if box:
            return box[0]
    raise RuntimeError(f"none of {_ATTEMPTS} draws gives a scene")


def bytes_of(seed: int, number: int, attempt: int = 0) -> bytes:
    """Return the bytes from which a scene is drawn."""
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
    """Return the simplest scene to which hypothesis shrinks that one, and its fault by `look`.

    `look` must report a fault of that scene itself.
    """
    failures: list[tuple[Scene, str]] = []

    @settings(
        # The database keeps the failing example, from which `fails()` shrinks.
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
            failures.append((scene, wrong))
            raise Violation(wrong)

    for attempt in range(_ATTEMPTS):
        try:
            fails.hypothesis.fuzz_one_input(bytes_of(seed, number, attempt))  # type: ignore[attr-defined]
        except Violation:
            break
    try:
        fails()
    except Violation:  # hypothesis ends with the simplest
        return failures[-1]
    raise RuntimeError(f"scene {number} of seed {seed} fails no more")
