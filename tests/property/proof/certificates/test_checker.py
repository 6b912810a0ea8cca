"""The balls that the checker of certificates works with, and the files that it reads."""

import json
import tempfile
from fractions import Fraction
from pathlib import Path

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.certificates import Data, certificates
from verify.errors import InputError
from verify.proof.certificates.balls import function, times
from verify.proof.certificates.certificate_file import check_file
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import state_theorem

_FINE = Fraction(1, 2**500)

# -- what the checker works with ------------------------------------------------------------------

small = st.builds(Fraction, st.integers(-30, 30), st.integers(1, 8))
radii = st.builds(Fraction, st.integers(0, 3), st.just(1000))


@drawn(60)
@given(st.sampled_from(["sin", "cos", "exp", "inverse"]), small, radii, st.sampled_from([-1, 0, 1]))
def test_a_functions_enclosure_holds_its_values_and_is_narrow(
    kind: str, x: Fraction, radius: Fraction, end: int
) -> None:
    if kind == "inverse" and abs(x) <= radius:
        with pytest.raises(ValueError, match="may be 0"):
            function(kind, (x, radius))
        return
    middle, bound = function(kind, (x, radius))
    with mpmath.workdps(60):
        at = mpmath.mpf((x + end * radius).numerator) / (x + end * radius).denominator
        value = 1 / at if kind == "inverse" else getattr(mpmath, kind)(at)
        apart = abs(mpmath.mpf(middle.numerator) / middle.denominator - value)
        width = mpmath.mpf(bound.numerator) / bound.denominator
        assert apart <= width + mpmath.mpf(10) ** -50
        slope = abs(float(x)) + 2
        most = 3.0 ** (slope + 1) if kind != "inverse" else 1.2 / float(abs(x)) ** 2
        assert width <= most * float(radius) + 1e-12
        assert width > 0


@drawn(40)
@given(small, small, radii, radii, st.tuples(*[st.sampled_from([-1, 0, 1])] * 2))
def test_a_product_of_balls_is_the_narrowest_about_its_middle(
    x: Fraction, y: Fraction, r: Fraction, s: Fraction, ends: tuple[int, int]
) -> None:
    middle, radius = times((x, r), (y, s))
    assert abs(middle - x * y) <= abs(x * y) * _FINE
    assert abs((x + ends[0] * r) * (y + ends[1] * s) - middle) <= radius
    corners = [abs((x + a * r) * (y + b * s) - middle) for a in (-1, 1) for b in (-1, 1)]
    assert radius <= max(corners) + (1 + abs(x * y)) * _FINE


# -- its file -------------------------------------------------------------------------------------


@drawn(6)
@given(certificates, st.data())
def test_a_file_says_what_was_certified_and_not_what_is_malformed(
    data: Data, drawn: st.DataObject
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "certificate.json"
        path.write_text(json.dumps(data), encoding="utf-8")
        assert check_file(path) == state_theorem(check(data))
        key = drawn.draw(st.sampled_from(sorted(set(data) - {"format"})))
        path.write_text(json.dumps({n: x for n, x in data.items() if n != key}))
        reason = check_file(path)
        assert key in ("potential", "stages", "tableau", "time_dependent", "numbers") or (
            isinstance(reason, str) and key in reason
        )
        assert key not in ("stages", "tableau") or reason == "p_next is missing"
        assert key != "numbers" or "'w' stands for nothing" in str(reason)
        for text in ("[]", "{", json.dumps({**data, "format": "another"})):
            path.write_text(text)
            with pytest.raises(InputError):
                check_file(path)
        with pytest.raises(InputError):
            check_file(path.with_name("none"))
