"""Properties held against sampled scenes, and the simplest scene for which one does not hold."""

from collections import Counter
from collections.abc import Iterable, Sequence

from verify.claims.scenes import slug
from verify.exploration import properties as catalogue
from verify.exploration.claims import claim_property
from verify.exploration.property import Property, Violation
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes import sample_scene, simplest
from verify.scenes.results.exploration import ExploreResult, Failure, ShrunkResult
from verify.scenes.toml_text import scene_text


def properties_of(names: Sequence[str], claims: Sequence[str]) -> tuple[Property, ...]:
    """The properties of these names, and what these claims (each as JSON) say.

    Raises InputError for an unknown property.
    """
    return (*map(catalogue.get, names), *map(claim_property, claims))


def check_properties(
    properties: Sequence[Property], space: SampleSpace, seed: int, numbers: Iterable[int]
) -> ExploreResult:
    """Holds each property against the scenes of these numbers of the seed."""
    looked_at, failed = Counter[str](), Counter[str]()
    first: dict[str, Failure] = {}
    for number in numbers:
        sample = Sample.of(sample_scene(space, seed, number))
        for each in properties:
            spoke, wrong = outcome(each, sample)
            looked_at[each.name] += spoke
            if wrong:
                failed[each.name] += 1
                found = Failure(property=each.name, example=number, message=wrong)
                first.setdefault(each.name, found)
    names = [each.name for each in properties]
    return ExploreResult(
        looked_at={name: looked_at[name] for name in names},
        failed={name: failed[name] for name in names},
        first=tuple(first.values()),
    )


def outcome(asked: Property, sample: Sample) -> tuple[bool, str]:
    """Whether the property speaks of the sample, and what is wrong; empty where nothing is."""
    try:
        return asked.holds(sample), ""
    except Violation as violation:
        return True, str(violation)
    except Exception as error:  # whatever the code under test may raise is a finding
        return True, f"raised {type(error).__name__}: {' '.join(str(error).split())}"


def shrink(asked: Property, space: SampleSpace, seed: int, number: int) -> ShrunkResult:
    """The simplest scene for which the property fails as for that scene of the seed."""
    scene, message = simplest(
        space, seed, number, lambda scene: outcome(asked, Sample.of(scene))[1]
    )
    # Another scheme may have been drawn than the one that a claim speaks of.
    named = scene.model_copy(
        update={"name": slug(asked.name), "schemes": (asked.scheme or scene.schemes[0],)}
    )
    origin = f"example {number} of seed {seed}, shrunk"
    comment = f"{asked.name}: {asked.sentence}\n{message}\n{origin}"
    return ShrunkResult(
        property=asked.name,
        example=number,
        message=message,
        scene=scene_text(named, comment=comment),
    )
