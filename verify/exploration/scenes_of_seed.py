"""The scenes of a seed, the check of properties on them, and the simplest scene that fails one.

Scene k of seed s is drawn from bytes that depend on s and k alone: it does not depend on the other
scenes that are drawn, on the machine, or on the number of workers.
"""

import random
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.database import InMemoryExampleDatabase

from verify import strategies
from verify.claims.claim_scenes import slug
from verify.exploration import properties as catalogue
from verify.exploration.claim_properties import claim_property
from verify.exploration.property import Property, Violation
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.exploration import ExploreResult, Failure, ShrunkResult
from verify.scenes.scene import Scene, scene_text
from verify.strategies.schemes import separable_for

_BYTES_OF_SCENE = 4096  # hypothesis rejects a draw that needs more
_MAX_STEPS = 12
_MAX_ATTEMPTS = 100
_MAX_PLANAR_TERMS, _MAX_TERMS_PER_DEGREE = 4, 2  # of H, in the plane and with several degrees

FindFault = Callable[[Scene], str]  # returns the fault of a scene, "" if it has none


@lru_cache(maxsize=32)
def scenes_of(drawn: SampleSpace) -> st.SearchStrategy[Scene]:
    """Return the strategy for the space's scenes.

    Raises InputError for an unknown kind or scheme, and a degree below 1.
    """
    terms = _MAX_PLANAR_TERMS if drawn.degrees == 1 else _MAX_TERMS_PER_DEGREE
    usual = not drawn.kinds and drawn.degree == SampleSpace().degree
    return strategies.scenes(
        hamiltonians=None if usual else hamiltonians_of(drawn, terms),
        schemes=strategies.schemes(names=drawn.schemes) if drawn.schemes else None,
        steps=(1, _MAX_STEPS),
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
    for attempt in range(_MAX_ATTEMPTS):
        box.clear()
        fuzz(bytes_of(seed, number, attempt))
        if box:
            return box[0]
    raise RuntimeError(f"none of {_MAX_ATTEMPTS} draws gives a scene")


def bytes_of(seed: int, number: int, attempt: int = 0) -> bytes:
    """Return the bytes from which a scene is drawn."""
    return random.Random(f"{seed}:{number}:{attempt}").randbytes(_BYTES_OF_SCENE)  # noqa: S311 - no secret


@lru_cache(maxsize=32)
def _drawer(drawn: SampleSpace) -> tuple[list[Scene], Callable[[bytes], Any]]:
    box: list[Scene] = []

    @settings(database=None)
    @given(scenes_of(drawn))
    def draw(scene: Scene) -> None:
        box.append(scene)

    return box, draw.hypothesis.fuzz_one_input  # type: ignore[attr-defined]


def simplest(drawn: SampleSpace, seed: int, number: int, look: FindFault) -> tuple[Scene, str]:
    """Return the simplest scene to which hypothesis shrinks that one, and its fault.

    `look` returns the fault of a scene; that scene itself must have one.
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
    @seeded(0)  # shrinking is random; above the settings a seed would discard the database
    @given(scenes_of(drawn))
    def fails(scene: Scene) -> None:
        message = look(scene)
        if message:
            failures.append((scene, message))
            raise Violation(message)

    for attempt in range(_MAX_ATTEMPTS):
        try:
            fails.hypothesis.fuzz_one_input(bytes_of(seed, number, attempt))  # type: ignore[attr-defined]
        except Violation:
            break
    try:
        fails()
    except Violation:  # hypothesis fails the simplest scene last
        return failures[-1]
    raise RuntimeError(f"scene {number} of seed {seed} fails no more")


# -- the properties -------------------------------------------------------------------------------


def properties_of(names: Sequence[str], claims: Sequence[str]) -> tuple[Property, ...]:
    """Return the properties of these names, and those of these claims (each as JSON).

    Raises InputError for an unknown property.
    """
    return (*map(catalogue.get, names), *map(claim_property, claims))


def check_properties(
    properties: Sequence[Property], space: SampleSpace, seed: int, numbers: Iterable[int]
) -> ExploreResult:
    """Check each property on the scenes of these numbers of the seed."""
    tested, failures = Counter[str](), Counter[str]()
    first: dict[str, Failure] = {}
    for number in numbers:
        # The sample, with its map and proof, is shared by all properties.
        sample = Sample.from_scene(sample_scene(space, seed, number))
        for property_ in properties:
            applies, message = check_sample(property_, sample)
            tested[property_.name] += applies
            if message:
                failures[property_.name] += 1
                failure = Failure(property=property_.name, example=number, message=message)
                first.setdefault(property_.name, failure)
    names = [property_.name for property_ in properties]
    return ExploreResult(
        looked_at={name: tested[name] for name in names},
        failed={name: failures[name] for name in names},
        first=tuple(first.values()),
    )


class PropertyCheck(NamedTuple):
    """The check of a property on a sample: `applies`, and `message`, empty if nothing is wrong."""

    applies: bool
    message: str = ""


def check_sample(property_: Property, sample: Sample) -> PropertyCheck:
    """Check a property on a sample, and report also what the code under test raises."""
    try:
        return PropertyCheck(property_.holds(sample))
    except Violation as violation:
        return PropertyCheck(True, str(violation))
    except Exception as error:  # any exception of the code under test is a finding
        text = f"raised {type(error).__name__}: {' '.join(str(error).split())}"
        return PropertyCheck(True, text)


def shrink(property_: Property, space: SampleSpace, seed: int, number: int) -> ShrunkResult:
    """Find the simplest scene for which the property fails, from that scene of the seed."""
    scene, message = simplest(
        space, seed, number, lambda scene: check_sample(property_, Sample.from_scene(scene)).message
    )
    # The scheme of a claim replaces the one that was drawn.
    named_scene = scene.model_copy(
        update={"name": slug(property_.name), "schemes": (property_.scheme or scene.schemes[0],)}
    )
    origin = f"example {number} of seed {seed}, shrunk"
    comment = f"{property_.name}: {property_.sentence}\n{message}\n{origin}"
    return ShrunkResult(
        property=property_.name,
        example=number,
        message=message,
        scene=scene_text(named_scene, comment=comment),
    )
