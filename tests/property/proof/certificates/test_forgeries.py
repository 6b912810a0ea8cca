"""Certificates of drawn proofs are accepted; what a forger makes of them, only where it is true."""

import copy
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.certificates import Data, certificates, true
from verify.proof.certificates.checker import check

# -- what a forger does ---------------------------------------------------------------------------

Place = tuple[Any, Any]  # a list or an object, and an index or a key in it


def places(data: Any) -> Iterator[Place]:
    keys = list(data) if isinstance(data, dict) else range(len(data))
    for key in keys:
        if key not in ("format", "scheme"):
            yield data, key
            if isinstance(data[key], dict | list):
                yield from places(data[key])


def forged(draw: st.DrawFn, data: Data) -> Data:
    changed = copy.deepcopy(data)
    inside, key = draw(st.sampled_from(list(places(changed))))
    old = inside[key]
    match old:
        case bool():
            inside[key] = not old
        case int() | None if inside is changed:
            inside[key] = draw(st.sampled_from([1, 2, 3, 4, None, (old or 0) + 1, 0]))
        case str() if old == "every":
            inside[key] = [["1/2", "p", "p"]]
        case str() if (isinstance(inside, list) and key == 0) or isinstance(inside, dict):
            wrong = [lambda x: -x, lambda x: x + 1, lambda x: x * Fraction(8, 7), lambda x: x * 0]
            with_number = draw(st.sampled_from(wrong))
            try:
                inside[key] = str(with_number(Fraction(old)))
            except ValueError:
                inside[key] = "p"
        case str():
            inside[key] = draw(st.sampled_from(["p", "q", "sin", "cos", "h", "#3", "H_p", "H_pq"]))
        case list():
            ways = ["drop", "p", "q"] if old else ["term"]
            match draw(st.sampled_from(ways)):
                case "drop" if isinstance(inside, list):
                    inside.pop(key)
                case "drop":
                    inside[key] = old[:-1]
                case "term":
                    inside[key] = [["1", "p"]]
                case name:
                    inside[key] = [*old, name] if isinstance(old[0], str) else old[1:]
        case dict():
            inside[key] = {}
    return changed


def accepted(data: Data) -> bool:
    try:
        check(data)
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, StopIteration):
        return False
    return True


@drawn(9)
@given(certificates, st.data())
def test_a_certificate_is_accepted_and_a_forgery_only_where_it_says_the_truth(
    data: Data, drawn: st.DataObject
) -> None:
    check(data)
    assert true(data)
    for _ in range(10):
        wrong = drawn.draw(st.composite(forged)(data))
        if accepted(wrong) and wrong != data:
            assert true(wrong), wrong


@drawn(12)
@given(certificates, st.data())
def test_a_cofactor_or_a_number_that_is_needed_cannot_be_another(
    data: Data, drawn: st.DataObject
) -> None:
    """Of the leading coefficient, the flow's part of the map, the potential, a cofactor."""
    if "stages" in data:
        return
    needed = [data["leading"], *data["p_next"][:2], *data["q_next"][:2], data.get("potential")]
    needed += [x for each in data.get("cofactors", {}).values() for x in each.values()]
    terms = [t for x in needed if x for t in x]
    term = drawn.draw(st.sampled_from(terms))
    term[0] = str(Fraction(term[0]) * drawn.draw(st.sampled_from([2, -1, Fraction(1, 3)])))
    assert not accepted(data)


rows = st.lists(
    st.tuples(*[st.sampled_from(["0", "1", "1/2", "-1", "2"])] * 4).map(list),
    min_size=1,
    max_size=2,
)


@drawn(80)
@given(rows, st.booleans())
def test_stages_are_accepted_exactly_where_their_determinants_are_one_polynomial(
    stages: list[list[str]], separable: bool
) -> None:
    data = {"hamiltonian": "every", "separable": separable, "stages": stages}
    assert accepted(data) == true(data)
