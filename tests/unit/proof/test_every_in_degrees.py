"""Proofs for every H in n degrees of freedom, held against those for one H and for the plane."""

from fractions import Fraction
from itertools import product
from typing import Any

import pytest
import sympy

from verify.algebra.formula import parse, symbol
from verify.algebra.jets import JetsInDegrees
from verify.errors import InputError, LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof import proof_for_every_h, series_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get
from verify.schemes.steps.two_form import TwoForm

PAIR = "p1**2*q2 + (p2 + q1*p1)**3/3 + q1**2*q2**2*p2 + p1*p2*q1"
DRIVEN = "p1**2*q2*t + (p2 + q1*p1)**3/3 + q1**2*q2**2*t**2 + p1*p2*q1*t"
TRIPLE = "p1**2*q2*p3 + p2*q3**2 + q1*q2*p1*p3 + q3*p2**2"
PLACE = [Fraction(n, d) for n, d in ((3, 7), (-2, 5), (5, 8), (4, 9), (-7, 11), (1, 3), (2, 5))]


def at_point(expression: sympy.Expr, names: list[str]) -> sympy.Rational:
    put = {symbol(n): sympy.Rational(x.numerator, x.denominator)
           for n, x in zip(names, PLACE, strict=False)}  # fmt: skip
    return sympy.Rational(expression.subs(put))


def in_numbers(jets: JetsInDegrees, x: Any, energy: sympy.Expr) -> sympy.Rational:
    """A polynomial in the jets at a point, with the derivatives of one H in place of them."""
    names, values = [*jets.variables], {}
    for name in names:
        values[name] = at_point(symbol(name), names)
    for index, written in zip(jets.indices, jets.context.names()[len(names) :], strict=True):
        if written in str(x):
            own = energy
            for name, n in zip(names, index, strict=True):
                own = own.diff(symbol(name), n) if n else own
            values[written] = at_point(own, names)
    return sympy.Rational(str(x.subs({n: parse_fraction(v) for n, v in values.items()})))


def parse_fraction(x: sympy.Rational) -> Any:
    import flint

    return flint.fmpq(int(x.p), int(x.q))


CASES = [
    *((s, PAIR, False) for s in ("lie1", "lie2", "lie3", "rk4", "explicit-midpoint")),
    ("lie2", DRIVEN, True), ("explicit-midpoint", DRIVEN, True),
    ("lie1", TRIPLE, False), ("lie2", TRIPLE, False),
]  # fmt: skip


@pytest.mark.sample(2)
@pytest.mark.parametrize(("scheme", "formula", "timed"), CASES)
def test_it_is_that_of_one_h(scheme: str, formula: str, timed: bool) -> None:
    hamiltonian = Hamiltonian.parse(formula)
    every = prove_for_every_h(scheme, degrees=hamiltonian.degrees, timed=timed)
    one = prove(get(scheme).step_map(hamiltonian), get(scheme))
    assert (every.verdict, every.order, every.convergence_order) == (
        one.verdict, one.order, one.convergence_order)  # fmt: skip
    assert every.form is not None
    leading = one.first.form
    assert leading is not None
    jets, names = every.form.ring, [*hamiltonian.coordinates, *(["t"] if timed else [])]
    assert isinstance(jets, JetsInDegrees)
    for a, b in product(range(2), range(2, 4)):
        ours = in_numbers(jets, every.form.entry(a, b), hamiltonian.exact)
        theirs = at_point(leading.ring.expression(leading.entry(a, b)), names)
        assert ours == theirs


@pytest.mark.parametrize(("scheme", "has_formula"), [("lie2", True), ("rk4", False)])
def test_a_leading_form_of_too_many_terms_is_told_by_its_formula_where_it_has_one(
    scheme: str, has_formula: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    form = prove_for_every_h(scheme, degrees=2).form
    assert form is not None
    for most in (form.length, form.length - 1):
        monkeypatch.setattr(proof_for_every_h, "MOST_TERMS", most)
        found = prove_for_every_h(scheme, degrees=2)
        assert bool(found.formula) is has_formula
        long = has_formula and most < form.length
        assert found.leading == (found.formula if long else form.text)


@pytest.mark.sample(7)
@pytest.mark.parametrize("scheme", ["lie1", "lie2", "lie3", "lie4", "rk4", "gauss4", "ruth3",
                                    "implicit-midpoint", "blanes-moan4"])  # fmt: skip
def test_what_is_needed_in_the_plane_is_needed_in_more(scheme: str) -> None:
    plane, more = prove_for_every_h(scheme), prove_for_every_h(scheme, degrees=2)
    assert (more.verdict, more.order) == (plane.verdict, plane.order)
    assert more.symplectic == plane.area_preserving
    assert more.convergence_order == plane.convergence_order
    if scheme.startswith("lie"):
        assert more.telescopes == plane.telescopes


@pytest.mark.parametrize(("scheme", "degrees"), [("lie4", 2), ("lie3", 2), ("lie2", 3)])
def test_telescoping_is_checked_identity_by_identity(scheme: str, degrees: int) -> None:
    found = prove_for_every_h(scheme, degrees=degrees)
    even = get(scheme).order % 2 == 0
    assert found.telescopes is even
    said = " ".join(map(str, found.checked))
    assert "zero polynomials" in said
    assert ("Lie derivative of β" in said) is even
    assert found.why


def test_a_wrong_potential_is_not_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    right = series_for_every_h.potential_of_lie

    def wrong(flow: Any, eta: int) -> TwoForm:
        form = right(flow, eta)
        return TwoForm.from_entries(
            form.ring, form.names, lambda a, b: form.entry(a, b) * (2 - (a == 1))
        )

    monkeypatch.setattr(series_for_every_h, "potential_of_lie", wrong)
    assert prove_for_every_h("lie2", degrees=2).telescopes is None


def test_a_wrong_clock_is_refuted_and_symplectic_all_the_same() -> None:
    found = prove_for_every_h("stormer-verlet, clock frozen", degrees=3, timed=True)
    assert (found.verdict, found.symplectic, found.convergence_order) == ("REFUTED", True, 1)
    assert prove_for_every_h("stormer-verlet", degrees=3, timed=True).verdict == "PROVED"


def test_a_splitting_that_claims_too_much_is_refuted() -> None:
    found = prove_for_every_h("kick 1/2; drift 1; kick 1/2; order 3", degrees=4)
    assert (found.verdict, found.convergence_order) == ("REFUTED", 2)


def test_for_which_h_it_is_said() -> None:
    lie1 = prove_for_every_h("lie1", degrees=2)
    assert lie1.quantifier == "every smooth H(p, q) in 2 degrees of freedom"
    verlet = prove_for_every_h("stormer-verlet", degrees=3, timed=True)
    assert "H = T(p, t) + V(q, t) in 3" in verlet.quantifier


@pytest.mark.parametrize(
    ("scheme", "degrees", "words"),
    [
        ("lie2", 0, "must be 1 … 64"),
        ("lie2", 65, "must be 1 … 64"),
        ("lie2", 20, "derivatives of H would be needed"),
        ("lie8", 3, "are too many for lie8"),
        ("p_next = p; q_next = q", 2, "in one degree of freedom only"),
    ],
)
def test_what_is_too_much_is_one_line(scheme: str, degrees: int, words: str) -> None:
    with pytest.raises((InputError, LimitError), match=words):
        prove_for_every_h(scheme, degrees=degrees)


def test_derivatives_of_h_are_what_sympy_finds() -> None:
    names, energy = ["p1", "p2", "q1", "q2"], parse(PAIR)
    jets = JetsInDegrees(names, 4)
    x = (
        jets.first("p1") * jets.derivative((1, 0, 1, 0))
        + jets.variable("q2") * jets.first("q2") ** 2
    )
    p1, q1, q2 = map(symbol, ("p1", "q1", "q2"))
    same = energy.diff(p1) * energy.diff(p1, q1) + q2 * energy.diff(q2) ** 2
    for name in names:
        ours = in_numbers(jets, jets.diff(jets.diff(x, name), "p1"), energy)
        assert ours == at_point(same.diff(symbol(name), p1), names)
