"""`verify.check` of steps in several degrees of freedom, and what its callers may say."""

from fractions import Fraction
from typing import Any

import pytest

from verify import check
from verify.errors import InputError
from verify.integrators.results import Finding


def test_a_place_in_two_degrees_and_what_is_allowed_may_be_said() -> None:
    def rubbed(p: Any, q: Any, h: Any) -> Any:
        if q[0] > 1e300:
            return p, q
        p = [(x - h * y) * (1 - 1e-7) for x, y in zip(p, q, strict=True)]
        return p, [y + h * x for x, y in zip(p, q, strict=True)]

    two = "(p1**2 + p2**2 + q1**2 + q2**2)/2"
    at: dict[str, Any] = {"p": [1, 0], "q": ["1/2", 1], "step_size": "1/8"}
    found = check(two, rubbed, area_preserving=True, **at)
    assert isinstance(found, Finding)
    assert (found.verdict, found.places[0].z[2]) == ("REFUTED", Fraction(1, 2))
    allowed = check(two, rubbed, **at, within="1e-6")
    assert isinstance(allowed, Finding)
    assert allowed.symplectic is True
    with pytest.raises(InputError, match="has 1 numbers; allowed: 2"):
        check(two, rubbed, p=1, q=1)
