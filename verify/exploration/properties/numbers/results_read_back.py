"""What is written reads back equal: the scene as TOML, H's formula, the step map's formulas."""

from verify.algebra.enclosure import enclose
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.arb import format_ball
from verify.exploration.property import Violation
from verify.exploration.reference_steps import BITS
from verify.exploration.sample import Sample
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.scene import Scene, scene_from, scene_text
from verify.scenes.toml_file import toml_data
from verify.schemes.maps.formula_map import step_map_from_formulas
from verify.schemes.maps.parts import parts_of

_MAX_TERMS = 15  # of a map


def holds(sample: Sample) -> None:
    if sample.is_turn(one_in=2):
        _must_be_same_scene(sample.scene)
    else:
        _must_be_same(sample)
    if sample.is_turn(one_in=3) and sample.brief:
        _must_be_same_map(sample)


def _must_be_same_scene(scene: Scene) -> None:
    if scene_from(toml_data(scene_text(scene), "scene"), "scene") != scene:
        raise Violation("the scene's TOML reads back as another scene")


def _must_be_same(sample: Sample) -> None:
    original, values = sample.hamiltonian, []
    read = Hamiltonian.parse(original.formula, dict(original.values))
    for hamiltonian in (original, read):
        field, _ = canonical_field(hamiltonian)
        elements = (field.energy, *field.slopes)
        values.append([enclose(field.ring, x, sample.start, BITS) for x in elements])
    for x, y in zip(*values, strict=True):
        if (x is None) != (y is None) or (x is not None and not x.overlaps(y)):
            raise Violation(f"H reads back as another: {original.formula}")


def _must_be_same_map(sample: Sample) -> None:
    parts = parts_of(sample.step_map)
    if parts is None or parts[-1].length > _MAX_TERMS:
        return
    closed, names = parts[-1], [f"{name}_next" for name in sample.point]
    texts = [to_text(closed.ring.expression(x)) for x in closed.elements]
    formulas = dict(zip(names, texts, strict=True))
    read = step_map_from_formulas(sample.hamiltonian, formulas).flat
    for name, x, y in zip(names, closed.elements, read.elements, strict=True):
        ours = enclose(closed.ring, x, sample.start, BITS)
        theirs = enclose(read.ring, y, sample.start, BITS)
        if ours is not None and theirs is not None and not ours.overlaps(theirs):
            raise Violation(
                f"{name} reads back as {format_ball(theirs)}, and is {format_ball(ours)}"
            )
