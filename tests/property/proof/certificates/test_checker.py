"""What the checker of certificates works with, and the files that it reads."""

import json
import re
import tempfile
from fractions import Fraction
from pathlib import Path

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.certificates import (
    TINY,
    Data,
    certificates,
    expression,
    names_of,
    number,
    of_drawn,
    zero,
)
from tests.helpers.sampled.formulas import P, Q
from verify.errors import InputError
from verify.proof.certificates.checker import Algebra, function, times
from verify.proof.certificates.file import checked, statement

# -- what the checker works with ------------------------------------------------------------------

small = st.builds(Fraction, st.integers(-30, 30), st.integers(1, 8))
radii = st.builds(Fraction, st.integers(0, 3), st.just(1000))


@drawn(60)
@given(st.sampled_from(["sin", "cos", "exp", "inverse"]), small, radii, st.sampled_from([-1, 0, 1]))
def test_a_functions_enclosure_holds_its_values_and_is_narrow(
    kind: str, x: Fraction, radius: Fraction, end: int
) -> None:
    if kind == "inverse" and abs(x) <= radius:
        with pytest.raises(ValueError, match="may be zero"):
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
        assert (width == 0) == (kind == "inverse" and radius == 0)


@drawn(40)
@given(small, small, radii, radii, st.tuples(*[st.sampled_from([-1, 0, 1])] * 2))
def test_a_product_of_balls_is_the_narrowest_about_its_middle(
    x: Fraction, y: Fraction, r: Fraction, s: Fraction, ends: tuple[int, int]
) -> None:
    middle, radius = times((x, r), (y, s))
    assert middle == x * y
    assert abs((x + ends[0] * r) * (y + ends[1] * s) - middle) <= radius
    corners = [abs((x + a * r) * (y + b * s) - middle) for a in (-1, 1) for b in (-1, 1)]
    assert max(corners) == radius


def shown(x: dict[tuple[str, ...], Fraction]) -> list[list[str]]:
    return [[str(c), *monomial] for monomial, c in x.items()]


@drawn(8)
@given(of_drawn(), st.sampled_from("pq"))
def test_the_checkers_derivatives_values_and_relations_are_those_of_its_functions(
    data: Data, by: str
) -> None:
    algebra, known = Algebra(data), names_of(data)
    h = expression(data["hamiltonian"], known)
    for name, own in (("p", algebra.h_p), ("q", algebra.h_q)):
        assert zero(expression(shown(own), known) - h.diff({"p": P, "q": Q}[name]))
    whole = {tuple(sorted(names)): Fraction(c) for c, *names in data["leading"]}
    slope = expression(data["leading"], known).diff({"p": P, "q": Q}[by])
    assert zero(expression(shown(algebra.diff(whole, by)), known) - slope)
    assert all(zero(expression(shown(r), known)) for r in algebra.relations.values())
    at = {"p": (Fraction(3, 7), Fraction(0)), "q": (Fraction(-5, 11), Fraction(0))}
    at["d"] = Fraction(2, 3), Fraction(0)
    middle, radius = algebra.value(whole, at)
    with mpmath.workdps(60):
        value = number(expression(data["leading"], known))
        found = mpmath.mpf(middle.numerator) / middle.denominator
        assert abs(found - value) <= float(radius) + TINY
    assert radius < Fraction(1, 10**6)


@drawn(6)
@given(certificates, st.sampled_from(["sin", "exp", "inverse"]), st.sampled_from("qh"))
def test_a_name_that_has_a_meaning_is_given_to_no_function(
    data: Data, kind: str, other: str
) -> None:
    """p, q, h and the functions have theirs; "every H" has derivatives, and no function at all."""
    if "stages" in data:
        return
    own = data.get("functions", [])
    for name in ("p", other, *(f[0] for f in own)):
        with pytest.raises(ValueError, match=f"{re.escape(name)} is a new name"):
            Algebra({**data, "functions": [*own, [name, kind, [["2", "q"]]]]})
    with_new = {**data, "functions": [*own, ["#new", "exp", [["1", "q"]]]]}
    if data["hamiltonian"] == "every":
        with pytest.raises(ValueError, match="#new is a new name"):
            Algebra(with_new)
    else:
        assert "#new" in Algebra(with_new).made


# -- its file -------------------------------------------------------------------------------------


@drawn(6)
@given(certificates, st.data())
def test_a_file_says_what_was_certified_and_not_what_is_malformed(
    data: Data, drawn: st.DataObject
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "certificate.json"
        path.write_text(json.dumps(data), encoding="utf-8")
        assert checked(path) == (True, statement(data))
        key = drawn.draw(st.sampled_from(sorted(set(data) - {"format", "scheme", "cofactors"})))
        if key in ("order", "convergence_order", "leading", "p_next", "q_next", "hamiltonian"):
            path.write_text(json.dumps({n: x for n, x in data.items() if n != key}))
            holds, reason = checked(path)
            assert not holds or "stages" in data
            assert holds or key in reason
        for text in ("[]", "{", json.dumps({**data, "format": "another"})):
            path.write_text(text)
            with pytest.raises(InputError):
                checked(path)
        with pytest.raises(InputError):
            checked(path.with_name("none"))
    said, order = statement(data), data.get("order")
    assert ("every smooth H" in said) == (data["hamiltonian"] == "every")
    assert ("T(p) + V(q)" in said) == bool(data.get("separable"))
    assert ("X·G" in said) == ("potential" in data)
    assert ("det J = 1" in said) == (order is None)
    if order is not None:
        assert f"L h^{order} + O(h^{order + 1})" in said
        assert ("generic" in said) == (data["hamiltonian"] == "every")
    if "stages" not in data:
        assert f"up to h^{data['convergence_order']}" in said
