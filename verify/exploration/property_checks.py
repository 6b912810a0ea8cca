"""The check of properties on sampled scenes, and the simplest scene for which one fails."""

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
        for each in properties:
            spoke, wrong = check_sample(each, sample)
            tested[each.name] += spoke
            if wrong:
                failures[each.name] += 1
                failure = Failure(property=each.name, example=number, message=wrong)
                first.setdefault(each.name, failure)
    names = [each.name for each in properties]
    return ExploreResult(
        looked_at={name: tested[name] for name in names},
        failed={name: failures[name] for name in names},
        first=tuple(first.values()),
    )


def check_sample(property_: Property, sample: Sample) -> tuple[bool, str]:
    """Return True if the property applies to the sample, and what is wrong, empty if nothing is."""
    try:
        return property_.holds(sample), ""
    except Violation as violation:
        return True, str(violation)
    except Exception as error:  # whatever the code under test may raise is a finding
        return True, f"raised {type(error).__name__}: {' '.join(str(error).split())}"


def shrink(property_: Property, space: SampleSpace, seed: int, number: int) -> ShrunkResult:
    """Find the simplest scene for which the property fails, from that scene of the seed."""
    scene, message = simplest(
        space, seed, number, lambda scene: check_sample(property_, Sample.from_scene(scene))[1]
    )
    # Another scheme may have been drawn than the one that a claim speaks of.
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
