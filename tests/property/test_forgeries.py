"""Certificates of drawn proofs are accepted, and what a forger makes of them only where it is true.

What a certificate says is judged by sympy's derivatives, in numbers of 60 digits at a point: for
"every H" with a polynomial H of so high a degree that its derivatives there are as good as free.
"""

import copy
import json
import math
import tempfile
from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.property.strategies import P, Q, polynomials, rationals
from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.proof.certificate import of_every
from verify.proof.certificate_one import of_one
from verify.proof.checker import Algebra, check, function, times
from verify.proof.checking import checked, statement
from verify.proof.every import prove_every
from verify.proof.order import prove
from verify.proof.potential import potential_of
from verify.schemes import get

POINT = {P: sympy.Rational(3, 7), Q: sympy.Rational(-5, 11)}
TINY = mpmath.mpf(10) ** -30
FREE = sum(
    sympy.Rational((7 * i + 5 * j) ** 2 % 23 - 11, 1 + (i + j) % 5) * P**i * Q**j
    for i in range(8)
    for j in range(8)
    if 0 < i + j < 9
)
APART = FREE.subs(Q, 0) + FREE.subs(P, 0)
INVOLVED = (
    "cos({})", "sin({})", "exp({})", "1/(2 + ({})**2)", "exp(sin({}))", "cos({0})*sin({0})", "d*{}",
)  # fmt: skip
EVERY = (
    "lie1", "lie2", "lie3", "symplectic-euler", "stormer-verlet", "implicit-midpoint", "ruth3",
    "implicit-symplectic-euler", "explicit-midpoint",
)  # fmt: skip
Data = dict[str, Any]


def as_read(data: Data) -> Data:
    return json.loads(json.dumps(data))  # type: ignore[no-any-return]


@st.composite
def of_drawn(draw: st.DrawFn) -> Data:
    """The certificate of a drawn H, separable for a half of them, and a scheme."""
    separable = draw(st.booleans())
    inner = draw(polynomials("q" if separable else "pq", degree=2, most_terms=2))
    bent = draw(st.sampled_from(INVOLVED)).format(f"({inner})")
    text = f"p**2/2 + ({draw(rationals(4))})*{bent} + ({draw(rationals(3))})*q**3 + 5"
    scheme = get(draw(st.sampled_from(["lie1", "lie2", *["symplectic-euler"] * separable])))
    proof = prove(scheme.step_map(Hamiltonian.parse(text)), scheme)
    potential = potential_of(proof, scheme)
    data = as_read(of_one(proof, potential))
    assert (data["order"], data["convergence_order"]) == (proof.order, proof.convergence_order)
    assert ("potential" in data) == (potential.potential is not None and proof.order is not None)
    needed = max(proof.order or 0, proof.convergence_order or 0) + 1
    assert proof.order is None or max(map(len, (data["p_next"], data["q_next"]))) <= needed
    return data


certificates = st.one_of(
    of_drawn(), of_drawn(), st.sampled_from(EVERY).map(lambda n: as_read(of_every(prove_every(n))))
)


# -- what a certificate says, by sympy ------------------------------------------------------------

Dual = tuple[Any, Any, Any]  # a value at the point, and its derivatives by p and q


def names_of(data: Data) -> dict[str, sympy.Expr]:
    known = {"p": P, "q": Q}
    for name, kind, argument in data.get("functions", []):
        u = expression(argument, known)
        known[name] = 1 / u if kind == "inverse" else getattr(sympy, kind)(u)
    return known


def expression(terms: list[list[str]], known: dict[str, sympy.Expr]) -> sympy.Expr:
    total = sympy.S.Zero
    for c, *names in terms:
        factors = [known.get(n, sympy.Symbol(n, real=True)) for n in names]
        total += sympy.prod(factors, sympy.Rational(c))
    return total


@cache
def number(x: sympy.Expr) -> Any:
    others = {s: sympy.Rational(2, 3) for s in x.free_symbols - {P, Q}}
    return mpmath.mpf(sympy.N(x.subs({**POINT, **others}), 60))


@cache
def dual(x: sympy.Expr) -> Dual:
    return number(x), number(x.diff(P)), number(x.diff(Q))


@cache
def of_flow(hamiltonian: sympy.Expr, start: sympy.Symbol, n: int) -> sympy.Expr:
    """Xⁿ of p or q."""
    if n == 0:
        return start
    y = of_flow(hamiltonian, start, n - 1)
    return hamiltonian.diff(P) * y.diff(Q) - hamiltonian.diff(Q) * y.diff(P)


def dual_of(terms: list[list[str]], known: dict[str, sympy.Expr]) -> Dual:
    """Of a polynomial in the names, by the product rule."""
    total = [mpmath.mpf(0)] * 3
    for c, *names in terms:
        term = [mpmath.mpf(Fraction(c).numerator) / Fraction(c).denominator, 0, 0]
        for n in names:
            x = dual(known.get(n, sympy.Symbol(n, real=True)))
            term = [term[0] * x[0], *(term[k] * x[0] + term[0] * x[k] for k in (1, 2))]
        total = [a + b for a, b in zip(total, term, strict=True)]
    return total[0], total[1], total[2]


def zero(x: Any) -> bool:
    return bool(abs(number(x) if isinstance(x, sympy.Expr) else x) < TINY)


def true(data: Data) -> bool:
    """Whether what it says holds, as far as one point shows it."""
    with mpmath.workdps(60):
        if "stages" in data:
            return all(preserved(*map(Fraction, r), data["separable"]) for r in data["stages"])
        return said_truly(data)


def said_truly(data: Data) -> bool:
    known = names_of(data)
    hamiltonian = APART if data.get("separable") else FREE
    if data["hamiltonian"] == "every":
        known |= free_derivatives(hamiltonian)
    else:
        hamiltonian = expression(data["hamiltonian"], known)
    order, agreed = data["order"], data["convergence_order"]
    length = max(len(data["p_next"]), len(data["q_next"]), agreed + 1)
    last = order or 2 * length
    series = [[dual_of(x, known) for x in data[n]] for n in ("p_next", "q_next")]
    series = [s + [dual_of([], known)] * (last + agreed + 1) for s in series]
    for start, own in zip((P, Q), series, strict=True):
        for n in range(agreed + 1):
            if not zero(own[n][0] - number(of_flow(hamiltonian, start, n)) / math.factorial(n)):
                return False
    leading = dual_of(data["leading"], known)[0]
    for n in range(1, last + 1):
        pairs = [(series[0][k], series[1][n - k]) for k in range(n + 1)]
        det = sum(x[1] * y[2] - x[2] * y[1] for x, y in pairs)
        if not zero(det - (leading if n == order else 0)):
            return False
    if order is None:
        return not data["leading"]
    if data["hamiltonian"] != "every":
        at = {sympy.Symbol(n, real=True): sympy.Rational(x) for n, x in data["witness"].items()}
        if zero(mpmath.mpf(sympy.N(expression(data["leading"], known).subs(at), 60))):
            return False
    if not data.get("potential"):
        return True
    _, by_p, by_q = dual_of(data["potential"], known)
    h_p, h_q = dual(hamiltonian)[1:]
    return zero(h_p * by_q - h_q * by_p - leading)


@cache
def free_derivatives(hamiltonian: sympy.Expr) -> dict[str, sympy.Expr]:
    powers = [(i, j) for i in range(7) for j in range(7 - i)]
    return {f"H_{'p' * i}{'q' * j}": hamiltonian.diff(P, i, Q, j) for i, j in powers}


def preserved(k: Fraction, d: Fraction, s: Fraction, t: Fraction, separable: bool) -> bool:
    """det A = det B of a stage with H_pp, H_pq, H_qq = 2, 3, 5 (2, 0, 5) at h = 1/7."""
    a, b, c, h = 2, 0 if separable else 3, 5, Fraction(1, 7)
    left = sympy.Matrix([[1 + h * k * b * s, h * k * c * t], [-h * d * a * s, 1 - h * d * b * t]])
    right = sympy.Matrix(
        [[1 - h * k * b * (1 - s), -h * k * c * (1 - t)],
         [h * d * a * (1 - s), 1 + h * d * b * (1 - t)]]
    )  # fmt: skip
    return bool(left.det() == right.det())


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
        case str() if isinstance(inside, list) and key == 0 or isinstance(inside, dict):
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


@settings(deadline=None, max_examples=9)
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


@settings(deadline=None, max_examples=12)
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
    st.tuples(*[st.sampled_from(["0", "1", "1/2", "-1", "2"])] * 4).map(list), min_size=1, max_size=2
)


@settings(deadline=None, max_examples=80)
@given(rows, st.booleans())
def test_stages_are_accepted_exactly_where_their_determinants_are_one_polynomial(
    stages: list[list[str]], separable: bool
) -> None:
    data = {"hamiltonian": "every", "separable": separable, "stages": stages}
    assert accepted(data) == true(data)


# -- what the checker works with ------------------------------------------------------------------

small = st.builds(Fraction, st.integers(-30, 30), st.integers(1, 8))
radii = st.builds(Fraction, st.integers(0, 3), st.just(1000))


@settings(deadline=None, max_examples=60)
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


@settings(deadline=None, max_examples=40)
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


@settings(deadline=None, max_examples=8)
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


# -- its file -------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=6)
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
