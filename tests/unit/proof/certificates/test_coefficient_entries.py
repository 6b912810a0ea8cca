"""Certificates of schemes by their coefficients: all that preserve area have one, whatever these
are."""

import copy
from dataclasses import asdict, replace
from functools import cache
from typing import Any

import pytest
import sympy

from tests.helpers.sampled.certificates import as_read, of_every_in_time
from tests.oracle.printed_certificates import is_true
from verify.errors import InputError
from verify.proof.certificates import coefficient_entries as written
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import EstablishedStatement, state_theorem
from verify.proof.order_for_every_h import prove_for_every_h
from verify.schemes import get, names
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.verdict import Verdict

SYMPLECTIC = [name for name in names() if get(name).area_preserving]
TABLEAUX = [name for name in SYMPLECTIC if isinstance(get(name).every_h, TreeConditions)]
OF_STAGES = [name for name in SYMPLECTIC if name not in TABLEAUX]
FORM = {False: "every smooth H", True: "every smooth H = T(p) + V(q)"}


@cache
def _certificate(name: str) -> dict[str, Any]:
    return as_read(certify_for_every_h(prove_for_every_h(name)))


def certificate(name: str) -> dict[str, Any]:
    """That of the scheme for every H in the plane."""
    return copy.deepcopy(_certificate(name))


def accepted(data: dict[str, Any]) -> EstablishedStatement:
    return state_theorem(check(data))


def refused(data: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        check(data)


def values(data: dict[str, Any]) -> list[list[sympy.Expr]]:
    """The rows of numbers that the file has, by sympy alone."""
    x, roots = sympy.Symbol("x"), {}
    for name, polynomial, low, high in data.get("numbers", []):
        exact = sympy.Poly([sympy.Integer(c) for c in reversed(polynomial)], x)
        ends = sympy.Rational(low), sympy.Rational(high)
        assert exact.count_roots(*ends) == 1
        within = [root for root in exact.real_roots() if ends[0] < root < ends[1]]
        (roots[name],) = within

    def value(entry: Any) -> sympy.Expr:
        if isinstance(entry, str):
            return sympy.Rational(entry)
        terms = (
            sympy.Rational(c) * sympy.prod([roots[name] for name in inner]) for c, *inner in entry
        )
        return sympy.Add(*terms)

    tableau = data.get("tableau")
    rows = data["stages"] if tableau is None else [*tableau["a"], *map(tableau.get, "bc")]
    return [[value(entry) for entry in row] for row in rows if row is not None]


def own_rows(name: str) -> list[list[Any]]:
    """The scheme's coefficients."""
    every_h = get(name).every_h
    if isinstance(every_h, TreeConditions):
        return [*every_h.tableau.rows, every_h.tableau.weights]
    if isinstance(every_h, Splitting):
        return [
            [size, 0, 0, 0] if kind == "kick" else [0, size, 0, 0] for kind, size in every_h.parts
        ]
    return [[s.kick, s.drift, s.at_p, s.at_q] for s in every_h.stages]  # type: ignore[union-attr]


# -- all schemes ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SYMPLECTIC)
def test_what_preserves_area_has_a_certificate_of_its_own_coefficients(name: str) -> None:
    data, separable = certificate(name), get(name).needs_separable
    said, end = accepted(data), "scheme of these stages"
    what = f"Runge–Kutta {end}" if name in TABLEAUX else end
    assert said.statement == f"det J = 1 for {FORM[separable]} and the {what}"
    assert (said.area_preserving, said.symplectic, said.order) == (True, True, None)
    assert bool(said.domain) is not get(name).explicit
    for found, own in zip(values(data), own_rows(name), strict=True):
        for x, y in zip(found, own, strict=True):
            assert abs(sympy.N(x - sympy.sympify(y), 60, chop=False)) < sympy.Float("1e-50")


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", SYMPLECTIC)
def test_so_it_has_in_time_separable_and_in_several_degrees(name: str) -> None:
    separable = get(name).needs_separable
    said = accepted(of_every_in_time(name))
    form = "T(p, t) + V(q, t)" if separable else "H(p, q, t)"
    assert said.statement.startswith(f"det J = 1 for every smooth {'H = ' * separable}{form} and")
    alone = accepted(as_read(certify_for_every_h(prove_for_every_h(name, True))))
    assert alone.statement.startswith(f"det J = 1 for {FORM[True]} and")
    said = accepted(as_read(certify_for_every_h(prove_for_every_h(name, degrees=3))))
    where = f"{FORM[separable]} in 3 degrees of freedom"
    assert said.statement.startswith(f"S = JᵀΩJ − Ω = 0 for {where} and the")
    assert (said.degrees, said.symplectic) == (3, True)


def test_there_are_rational_and_irrational_ones_of_each_kind() -> None:
    irrational = {name for name in SYMPLECTIC if "numbers" in certificate(name)}
    assert {"yoshida4", "blanes-moan4", "triple-jump6", "gauss4", "gauss6"} <= irrational
    assert {"stormer-verlet", "implicit-midpoint"} <= {*SYMPLECTIC} - irrational
    assert {"gauss4", "gauss6"} <= {*TABLEAUX}


def test_what_is_printed_of_stages_is_true() -> None:
    assert is_true(asdict(accepted(of_every_in_time("mclachlan-atela2"))), points=1)
    said = asdict(accepted(certificate("mclachlan-atela2")))
    assert is_true(said, points=1)
    assert not is_true(said | {"p_next": f"{said['p_next']} + h*p*q"}, points=1)


def test_of_a_tableau_the_number_and_every_coefficient_count_in_what_is_printed() -> None:
    said = asdict(accepted(certificate("gauss4")))
    formula = said["p_next"]
    assert formula.startswith("P1 = p - h*(1/4)*H_q(P1, Q1) - h*(-w/6 + 1/4)*H_q(P2, Q2); P2 = p")
    assert said["numbers"] == ("w = the root of w**2 - 3 in [1, 2]",)
    assert is_true(said, points=1)  # of order 4, for any w: b_1 = b_2 and a_12 + a_21 = 1/2
    wrong = formula.replace("-w/6 + 1/4", "-w/5 + 1/4", 1)
    assert not is_true(said | {"p_next": wrong}, points=1)
    with pytest.raises(AssertionError):
        is_true(said | {"numbers": ("w = the root of w**2 - 5 in [1, 2]",)}, points=1)


# -- coefficients of one's own --------------------------------------------------------------------

INNER = "1/(2 - 2**(1/3))"


def of_sizes(size: str) -> dict[str, Any]:
    """That of two kicks of this size and of what is left to 1."""
    return as_read(
        certify_for_every_h(prove_for_every_h(f"kick {size}; drift 1; kick 1 - ({size})"))
    )


@pytest.mark.parametrize(
    ("size", "polynomial"),
    [
        ("sqrt(2)", "w**2 - 2"),
        (INNER, "6*w**3 + 12*w**2 + 6*w + 1"),
        ("sqrt(3 + 2*sqrt(2))", "w**2 - 2*w - 1"),
        ("sqrt(1 + sqrt(2 + sqrt(3)))", "w**8 - 4*w**6 + 2*w**4 + 4*w**2 - 2"),
        ("sqrt(2) + sqrt(3)", "w1**2 - 2"),
        ("2**(1/32)", "w**32 - 2"),
        ("-sqrt(1/7)", "w**2 - 7"),
    ],
)
def test_a_size_that_is_made_by_roots_is_a_number(size: str, polynomial: str) -> None:
    data = of_sizes(size)
    assert any(f"root of {polynomial} in [" in said for said in accepted(data).numbers)
    assert abs(sympy.N(values(data)[0][0] - sympy.sympify(size), 60)) < sympy.Float("1e-50")


@pytest.mark.parametrize(
    ("size", "reason"),
    [
        ("pi", "pi is not made by roots: no certificate"),
        ("exp(1/3)", "is not made by roots: no certificate"),
        ("sqrt(sqrt(1 + sqrt(2 + sqrt(3 + sqrt(5 + sqrt(7))))) + 6)", "of degree 64, or seems so"),
        ("2**(1/40)", "of degree 40, or seems so; allowed: up to 32: no certificate"),
    ],
)
def test_another_size_has_no_certificate(size: str, reason: str) -> None:
    with pytest.raises(InputError, match="scheme=kick") as found:
        of_sizes(size)
    assert reason in str(found.value)


def test_no_interval_is_made_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(written, "_MOST_HALVINGS", 0)
    with pytest.raises(InputError, match=r"sqrt\(2\) is in no interval that is found"):
        of_sizes("sqrt(2)")


def test_a_tableau_with_dependent_numbers_would_be_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """√(3 + 2√2) is 1 + √2: the proof sees that, the file has a polynomial for each alone."""
    half, root = sympy.Rational(1, 2), sympy.sqrt(2)
    hidden = sympy.sqrt(3 + 2 * root) - 1  # √2
    tableau = ImplicitTableau.from_numbers(
        ((half / 2, half / 2 - root), (half / 2 + hidden, half / 2)), (half, half)
    )
    assert all(condition.holds for condition in tableau.area_conditions())
    made = replace(get("gauss4"), every_h=TreeConditions(tableau))
    monkeypatch.setattr("verify.proof.certificates.certification.get", lambda _: made)
    proof = replace(prove_for_every_h("gauss4"), verdict=Verdict.PROVED)
    refused(
        as_read(certify_for_every_h(proof)), r"tableau: b_1 a_12 \+ b_2 a_21 - b_1 b_2 is not zero"
    )


def test_what_does_not_preserve_area_has_none_by_its_coefficients() -> None:
    """rk4 in time is certified by the jets, and not by stages."""
    assert "tableau" in of_every_in_time("gauss4")
    for name in ("rk4", "explicit-midpoint"):
        data = of_every_in_time(name)
        assert "tableau" not in data
        told = f"det J − 1 = L h^{get(name).order + 1}"
        assert told in str(state_theorem(check(data)))
