"""For every H(p, q, t): lieη in the jets, and splittings by conditions on sizes and times."""

from dataclasses import replace

import pytest
import sympy

from tests.helpers.lie_derivatives import lie_derivatives
from verify import schemes
from verify.algebra.identities.polynomials import terms_of
from verify.algebra.jets import Jets, Poly
from verify.claims.base_claim import Findings
from verify.claims.kinds import models
from verify.errors import InputError
from verify.hamiltonians.canonical_field import JetField
from verify.proof import order_for_every_h
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.verdict import Verdict


@pytest.mark.parametrize("eta", range(1, 7))
def test_lie_for_every_h_in_time(eta: int) -> None:
    found = prove_for_every_h(f"lie{eta}", timed=True)
    assert (found.verdict, found.order, found.convergence_order) == (Verdict.PROVED, eta + 1, eta)
    assert found.formula == f"-div(D^{eta} f)/{eta + 1}!, f = (-H_q, H_p)"
    assert found.telescopes is (eta % 2 == 0)
    assert found.quantifier == "every smooth H(p, q, t)"


def terms(jets: Jets, x: Poly) -> dict[frozenset[tuple[str, int]], str]:
    """Coefficients by the powers of names."""
    return {
        frozenset(
            (name, int(n)) for name, n in zip(jets.context.names(), powers, strict=True) if n
        ): str(c)
        for powers, c in terms_of(x)
    }


@pytest.mark.parametrize("eta", range(1, 6))
def test_where_h_does_not_depend_on_time_it_is_the_proof_for_every_h(eta: int) -> None:
    def divergence(jets: Jets) -> Poly:
        p, q = (lie_derivatives(jets, name, eta + 1)[-1] for name in ("p", "q"))
        return jets.diff(p, "p") + jets.diff(q, "q")

    timed, plain = Jets(eta + 2, timed=True), Jets(eta + 2)
    found, true = terms(timed, divergence(timed)), terms(plain, divergence(plain))
    still = {k: c for k, c in found.items() if not any(n.endswith("t") for n, _ in k)}
    assert still == true
    assert len(found) > len(still) or eta == 1


def test_d_without_the_derivative_by_time_is_another_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """The planted error: the flow's terms with X in place of D are of order 1."""
    jets = Jets(4, timed=True)
    right = lie_derivatives(jets, "p", 2)
    monkeypatch.setattr(
        JetField,
        "derive",
        lambda self, x: sum(
            slope * self.ring.diff(x, name)
            for slope, name in zip(self.slopes, self.names, strict=True)
        ),
    )
    wrong = lie_derivatives(Jets(4, timed=True), "p", 2)
    assert right[1] == wrong[1]
    assert right[2] - wrong[2] == -jets.h(0, 1, 1)


SPLITTINGS = [n for n in schemes.names() if schemes.get(n).needs_separable]


@pytest.mark.parametrize(
    ("name", "degrees"),
    [
        *(pytest.param(name, 1, marks=pytest.mark.sample(5), id=name) for name in SPLITTINGS),
        pytest.param("stormer-verlet", 3, id="three degrees of freedom"),
    ],
)
def test_with_right_clocks_every_splitting_is_of_its_order(name: str, degrees: int) -> None:
    found = prove_for_every_h(name, timed=True, degrees=degrees)
    assert (found.verdict, found.area_preserving) == (Verdict.PROVED, True)
    assert found.convergence_order >= schemes.get(name).order
    assert found.quantifier.startswith("every smooth H = T(p, t) + V(q, t)")


@pytest.mark.parametrize("degrees", [1, 3])
def test_a_wrong_clock_is_refuted_and_symplectic_all_the_same(degrees: int) -> None:
    found = prove_for_every_h("stormer-verlet, clock frozen", degrees=degrees, timed=True)
    assert (found.verdict, found.symplectic, found.convergence_order) == ("REFUTED", True, 1)


@pytest.mark.parametrize(
    ("times", "order", "words"),
    [
        ("at 0, , at 0", 1, "at t in every kick"),
        ("at 1, , at 1", 1, "at the step's end in every kick"),
        ("at 0, , at 1/2", 1, "the clock of its own kind"),
        ("at 1, , at 0", 2, ""),
        ("at 1/2, , at 1/2", 2, ""),
        ("at 0, at 1/2, at 1", 2, ""),
        ("at 0, at 0, at 1", 1, "at t in every drift"),
        ("at 0, at 1/3, at 1", 1, ""),
    ],
)
def test_wrong_clocks_are_refuted_with_their_condition_and_named(
    times: str, order: int, words: str
) -> None:
    first, middle, last = (part.strip() for part in times.split(","))
    scheme = f"kick 1/2 {first}; drift 1 {middle}; kick 1/2 {last}; order 2"
    found = prove_for_every_h(scheme, timed=True)
    assert found.convergence_order == order
    if order == 2:
        assert found.verdict is Verdict.PROVED
        return
    assert found.verdict is Verdict.REFUTED
    assert "·time = 1/2" in str(found.reason)
    assert words in str(found.reason)
    assert ("as if" in str(found.reason)) is bool(words)


def test_a_drifts_time_does_not_count_where_t_does_not_depend_on_it() -> None:
    found = prove_for_every_h("kick 1/2 at 0; drift 1 at 7/3; kick 1/2 at 1; order 2", timed=True)
    assert (found.verdict, found.convergence_order) == (Verdict.REFUTED, 1)
    told = [str(line) for line in found.checked if "the map has order" in str(line)]
    assert told == [
        f"for every H = {kind} + V(q, t) the map has order 2" for kind in ("T(p)", "p²/(2m)")
    ]


def test_kicks_commute_and_conditions_of_kicks_alone_are_not_asked_for() -> None:
    """Of order 3, though K_1 and K_0 have another coefficient than in the exact flow."""
    found = prove_for_every_h(
        "kick 7/24 at 0; drift 2/3; kick -1/12 at 0; kick 2/3 at 1/2; kick 1/6 at 1; drift -2/3; "
        "kick -1/24 at 0; drift 1; order 3",
        timed=True,
    )
    assert (found.verdict, found.convergence_order) == (Verdict.PROVED, 3)


@pytest.mark.parametrize("name", ["rk4", "explicit-midpoint", "implicit-midpoint", "gauss4"])
def test_stages_at_their_times_keep_the_order_for_every_h(name: str) -> None:
    found, claims = prove_for_every_h(name, timed=True), schemes.get(name)
    assert (found.verdict, found.convergence_order) == (Verdict.PROVED, claims.order)
    assert found.area_preserving is claims.area_preserving
    assert found.quantifier == "every smooth H(p, q, t)"


def test_a_higher_claim_of_a_method_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    claimed = replace(schemes.get("gauss4"), order=5)
    monkeypatch.setattr(order_for_every_h, "get", lambda _: claimed)
    found = prove_for_every_h("gauss4", timed=True)
    assert (found.verdict, found.convergence_order) == (Verdict.REFUTED, 4)


def test_stages_one_after_the_other_are_proved_too() -> None:
    found = prove_for_every_h("implicit-symplectic-euler", timed=True)
    assert (found.verdict, found.area_preserving) == (Verdict.PROVED, True)
    assert found.quantifier == "every smooth H(p, q, t)"


def test_other_schemes_are_refused_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="up to lie8"):
        prove_for_every_h("lie9", timed=True)
    for_one = replace(schemes.get("rk4"), every_h=None)
    monkeypatch.setattr(order_for_every_h, "get", lambda _: for_one)
    with pytest.raises(InputError, match="it cannot be proved for every H in t"):
        prove_for_every_h("rk4", timed=True)


@pytest.mark.parametrize(("scheme", "order"), [("rk4", 5), ("explicit-midpoint", 3)])
def test_explicit_stages_have_the_order_that_the_prover_in_n_degrees_has(
    scheme: str, order: int
) -> None:
    """With the coefficient itself, which for an H without t is that of the proof without it."""
    found, made = (
        prove_for_every_h(scheme, timed=True),
        prove_for_every_h(scheme, degrees=2, timed=True),
    )
    assert (found.verdict, found.order, found.area_preserving) == ("PROVED", order, False)
    assert (made.verdict, made.order, made.volume_order) == ("PROVED", order, order)
    assert (found.convergence_order, found.convergence_decided) == (order - 1, True)
    assert [c.holds for c in found.conditions].count(False) > 0
    leading, without = map(sympy.sympify, (found.leading, prove_for_every_h(scheme).leading))
    of_t = [x for x in leading.free_symbols if x.name.endswith("t")]
    assert of_t
    assert sympy.expand(leading.subs(dict.fromkeys(of_t, 0)) - without) == 0
    assert certify_for_every_h(found)


@pytest.mark.parametrize(
    ("scheme", "order", "verdict"),
    [("rk4", 5, "PROVED"), ("rk4", 6, "REFUTED"), ("rk4", 4, "REFUTED"),
     ("explicit-midpoint", 3, "PROVED"), ("explicit-midpoint", 4, "REFUTED")],
)  # fmt: skip
def test_a_claim_of_the_order_of_delta_j_for_every_h_in_time_is_decided(
    scheme: str, order: int, verdict: str
) -> None:
    claim = models()["order"].model_validate(
        {"id": "c", "kind": "order", "scheme": scheme, "order": order,
         "every": "hamiltonian in time"}
    )  # fmt: skip
    assert claim.judge(Findings({})).verdict == verdict
