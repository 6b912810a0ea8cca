"""Names for parts of a map: the same values and derivatives as the map written out."""

from fractions import Fraction

import pytest

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.ring import Ring
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.stages import Stages, chained

AT = {"p": Fraction(3, 7), "q": Fraction(5, 11), "h": Fraction(1, 9), "a": Fraction(2, 3)}
SYSTEMS = [
    "p**2/2 + a*q**4",
    "p**2/2 - cos(a*q)",
    "sqrt(1 + a*p**2) + log(1 + q**2)",
    "exp(a*p) + 1/(2 + cosh(q))",
]
every_system = pytest.mark.parametrize("text", SYSTEMS)


@every_system
@pytest.mark.parametrize("variable", ["p", "q", "h", "a"])
def test_a_chain_of_names_has_the_derivatives_of_the_closed_form(text: str, variable: str) -> None:
    hamiltonian = Hamiltonian.parse(text)
    step_map = get("stormer-verlet").step_map(hamiltonian)
    maps = [(step.p_next, step.q_next) for step in step_map.substeps]
    field, *named = chained(step_map.substeps[0].field, maps)
    closed, written = hamiltonian.field(*step_map.composed)
    assert any(g.kind == "stage" for g in field.ring.generators_in(*named))
    for x, y in zip(named, written, strict=True):
        for ours, theirs in (
            (x, y),
            (field.ring.diff(x, variable), closed.ring.diff(y, variable)),
            (
                field.ring.diff(field.ring.diff(x, variable), "q"),
                closed.ring.diff(closed.ring.diff(y, variable), "q"),
            ),
        ):
            one, two = enclose(field.ring, ours, AT, 256), enclose(closed.ring, theirs, AT, 256)
            assert one.overlaps(two)
            assert one.rad() < 1e-50


def test_short_parts_and_constants_get_no_name() -> None:
    ring, (p, h) = embed(
        [Hamiltonian.parse("p").exact, Hamiltonian.parse("a + 1").exact], ("p", "q", "h", "a")
    )
    for x in (p, 3 * p * ring.variable("q"), h, ring.variable("h") + 1):
        assert ring.named(x) == x


def test_equal_parts_share_a_name_and_where_no_room_is_left_they_get_none() -> None:
    ring = Ring(("p", "q"), 0)
    p, q = ring.variable("p"), ring.variable("q")
    name = ring.named(p + q)
    assert name != p + q
    assert ring.named(q + p) == name
    for k in range(2, 2 + ring.room):
        ring.named(p + k * q)
    full = p - q
    assert ring.named(full) == full


@every_system
def test_functions_at_the_point_itself_are_those_that_are_there(text: str) -> None:
    field, _ = Hamiltonian.parse(text).field()
    stages = Stages(field, 3)
    before = len(stages.ring.generators)
    at = stages.at(stages.start)
    assert at(field.h_p) == stages.field.h_p
    assert len(stages.ring.generators) == before


@every_system
def test_functions_at_another_point_obey_their_relations_there(text: str) -> None:
    field, _ = Hamiltonian.parse(text).field()
    stages = Stages(field, 1)
    p, q = stages.start
    at = stages.at((p + q, q - p))
    for index, power, relation in field.ring.relations:
        assert at(relation) == 0, (index, power)
    moved = enclose(stages.ring, at(field.h_q), AT, 256)
    there = {**AT, "p": AT["p"] + AT["q"], "q": AT["q"] - AT["p"]}
    assert moved.overlaps(enclose(field.ring, field.h_q, there, 256))
    assert not moved.overlaps(enclose(field.ring, field.h_q, AT, 256))
