"""For every H(p, q, t): lieη in the jets, and splittings by conditions on sizes and times."""

import pytest
import sympy

from verify import schemes
from verify.algebra.generator import terms_of
from verify.algebra.series.jets import JetRing, Jets, Poly
from verify.algebra.series.timed_jets import TimedJets
from verify.errors import InputError
from verify.proof.every import prove_every
from verify.proof.every_in_time import prove_every_in_time
from verify.schemes.clock_conditions import ClockedSplitting
from verify.schemes.clock_mistakes import mistake
from verify.schemes.splitting import alternating, right_times
from verify.verdict import Verdict

HALF = sympy.Rational(1, 2)
VERLET = alternating("kick", (HALF, sympy.S.One, HALF))


@pytest.mark.parametrize("eta", range(1, 7))
def test_lie_for_every_h_in_time(eta: int) -> None:
    found = prove_every_in_time(f"lie{eta}")
    assert (found.verdict, found.order, found.convergence_order) == (Verdict.PROVED, eta + 1, eta)
    assert found.formula == f"-div(D^{eta} f)/{eta + 1}!, f = (-H_q, H_p)"
    assert found.telescopes is (eta % 2 == 0)
    assert found.quantifier == "every smooth H(p, q, t)"


def terms(jets: JetRing, x: Poly) -> dict[frozenset[tuple[str, int]], str]:
    """Coefficients by the powers of names."""
    return {
        frozenset((name, int(n)) for name, n in zip(jets.names, powers, strict=True) if n): str(c)
        for powers, c in terms_of(x)
    }


@pytest.mark.parametrize("eta", range(1, 6))
def test_where_h_does_not_depend_on_time_it_is_the_proof_for_every_h(eta: int) -> None:
    def divergence(jets: Jets | TimedJets) -> Poly:
        p, q = (jets.lie_derivatives(name, eta + 1)[-1] for name in ("p", "q"))
        return jets.diff(p, "p") + jets.diff(q, "q")

    timed, plain = TimedJets(eta + 2), Jets(eta + 2)
    found, true = terms(timed, divergence(timed)), terms(plain, divergence(plain))
    still = {k: c for k, c in found.items() if not any(n.endswith("t") for n, _ in k)}
    assert still == true
    assert len(found) > len(still) or eta == 1


def test_d_without_the_derivative_by_time_is_another_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """The planted error: the flow's terms with X in place of D are of order 1."""
    jets = TimedJets(4)
    right = jets.lie_derivatives("p", 2)
    monkeypatch.setattr(
        TimedJets,
        "derive",
        lambda self, x: self.h(1, 0) * self.diff(x, "q") - self.h(0, 1) * self.diff(x, "p"),
    )
    wrong = jets.lie_derivatives("p", 2)
    assert right[1] == wrong[1]
    assert right[2] - wrong[2] == -jets.h(0, 1, 1)


@pytest.mark.parametrize("name", [n for n in schemes.names() if schemes.get(n).needs_separable])
def test_with_right_clocks_every_splitting_is_of_its_order(name: str) -> None:
    found = prove_every_in_time(name)
    assert (found.verdict, found.area_preserving) == (Verdict.PROVED, True)
    assert found.convergence_order >= schemes.get(name).order
    assert found.quantifier == "every smooth H = T(p, t) + V(q, t)"


@pytest.mark.parametrize(
    ("times", "order", "words"),
    [
        ("at 0, , at 0", 1, "at t in every part"),
        ("at 1, , at 1", 1, "at t + h in every part"),
        ("at 0, , at 1/2", 1, "its own clock"),
        ("at 1, , at 0", 2, ""),
        ("at 1/2, , at 1/2", 2, ""),
        ("at 0, at 1/2, at 1", 2, ""),
        ("at 0, at 0, at 1", 1, ""),
    ],
)
def test_wrong_clocks_are_refuted_with_their_condition_and_named(
    times: str, order: int, words: str
) -> None:
    first, middle, last = (part.strip() for part in times.split(","))
    scheme = f"kick 1/2 {first}; drift 1 {middle}; kick 1/2 {last}; order 2"
    found = prove_every_in_time(scheme)
    assert found.convergence_order == order
    if order == 2:
        assert found.verdict is Verdict.PROVED
        return
    assert found.verdict is Verdict.REFUTED
    assert "·time = 1/2" in str(found.reason)
    assert (words or "as if") in str(found.reason) or not words
    assert ("as if" in str(found.reason)) is bool(words)


def test_a_drifts_time_does_not_count_where_t_does_not_depend_on_it() -> None:
    times = (sympy.S.Zero, sympy.Rational(7, 3), sympy.S.One)
    for drifts_too in (True, False):
        conditions = ClockedSplitting(VERLET, times, drifts_too).order_conditions(2)
        assert all(c.holds for c in conditions) is not drifts_too


def test_right_clocks_are_each_advanced_by_the_other_flow() -> None:
    assert right_times(VERLET) == (0, HALF, 1)
    assert mistake(VERLET, right_times(VERLET)) == ""


@pytest.mark.parametrize("name", ["rk4", "explicit-midpoint", "implicit-midpoint", "gauss4"])
def test_stages_at_their_times_keep_the_order_for_every_h(name: str) -> None:
    found, claims = prove_every_in_time(name), schemes.get(name)
    assert (found.verdict, found.convergence_order) == (Verdict.PROVED, claims.order)
    assert found.area_preserving is claims.area_preserving
    assert found.quantifier == "every smooth H(p, q, t)"


def test_a_condition_that_an_h_without_t_does_not_need_refutes_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A method of order 5 in the plane that fails one tree is not called wrong in time."""
    from dataclasses import replace

    from verify.proof import every_in_time

    claimed = replace(schemes.get("gauss4"), order=5)
    monkeypatch.setattr(every_in_time, "get", lambda _: claimed)
    assert prove_every_in_time("gauss4").verdict is Verdict.REFUTED
    higher = replace(prove_every("gauss4"), convergence_order=5)
    monkeypatch.setattr(every_in_time, "prove_every", lambda _: higher)
    assert prove_every_in_time("gauss4").verdict is Verdict.UNDECIDED


def test_other_schemes_are_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="allowed: lieη, splittings, Runge–Kutta methods"):
        prove_every_in_time("implicit-symplectic-euler")
    with pytest.raises(InputError, match="up to lie8"):
        prove_every_in_time("lie9")
