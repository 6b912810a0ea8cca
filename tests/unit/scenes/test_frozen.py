"""Models that are made from objects by their fields."""

from dataclasses import dataclass

import pytest
from pydantic import ValidationError

from verify.scenes.frozen import Frozen


class Point(Frozen):
    p: int
    q: int
    label: str = "a point"


@dataclass
class Source:
    p: int
    q: int
    other: str = "no field"


def test_fields_are_those_that_are_named_then_those_of_the_object_then_defaults() -> None:
    assert Point.from_object(Source(1, 2), q=3) == Point(p=1, q=3, label="a point")


def test_a_field_that_is_nowhere_is_an_error_and_so_is_a_name_that_is_no_field() -> None:
    with pytest.raises(ValidationError, match="p"):
        Point.from_object(object(), q=3)
    with pytest.raises(ValidationError, match="width"):
        Point.from_object(Source(1, 2), width=3)
