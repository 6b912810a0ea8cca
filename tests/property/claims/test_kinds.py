"""Claims about random Hamiltonians: a true one is never refuted, a planted error is.

What is true is computed by plain sympy, apart from `verify`: the map of Eq. 2–5, its determinant,
and their expansions in h.
"""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.exact_orbits import Case, exact
from tests.helpers.planted.mutation import mutants
from tests.helpers.sampled.formulas import (
    H,
    P,
    Q,
    lie_step,
    plain,
    plain_delta_j,
    polynomials,
    trigonometric,
)
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import decimal
from verify.claims.base_claim import Findings
from verify.claims.claims_file import load_claims
from verify.claims.kinds import models
from verify.claims.verdicts import prepare
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.scenes.scene import Scene
from verify.verdict import Verdict

quick = drawn(25)


@dataclass(frozen=True)
class True_:  # noqa: N801 - True is taken
    """What plain sympy says of one H and one scheme; `order` is None where ΔJ ≡ 0."""

    text: str
    scheme: str
    p_next: sympy.Expr
    q_next: sympy.Expr
    delta_j: sympy.Expr
    order: int | None
    convergence: int | None


def true_of(text: str, eta: int) -> True_:
    energy = plain(text)
    p_next, q_next = lie_step(energy, eta)
    delta_j = sympy.expand(plain_delta_j(p_next, q_next))
    order = next((n for n in range(1, 2 * eta + 1) if not zero(delta_j.coeff(H, n))), None)
    more = [a - b for a, b in zip(lie_step(energy, eta + 1), (p_next, q_next), strict=True)]
    # The map is the flow's Taylor series cut off: one term more differs, or they agree further.
    convergence = eta if any(not zero(x) for x in more) else None
    return True_(text, f"lie{eta}", p_next, q_next, delta_j, order, convergence)


def zero(x: sympy.Expr) -> bool:
    return bool(sympy.expand(sympy.expand_trig(x).rewrite(sympy.exp)) == 0)


def verdict(at: True_, kind: str, **keys: Any) -> Verdict:
    """Of a claim on a scene made of that H; its formulas are written by our printer."""
    written = {n: to_text(x) if isinstance(x, sympy.Expr) else x for n, x in keys.items()}
    claim = models()[kind].model_validate({"id": "c", "scene": "made", "scheme": at.scheme,
                                        "kind": kind, **written})  # fmt: skip
    scene = Scene(hamiltonian=at.text, schemes=(at.scheme,), name="made")
    return claim.judge(Findings({"made": scene})).verdict


def entries(at: True_) -> list[list[str]]:
    return [[to_text(x.diff(z)) for z in (P, Q)] for x in (at.p_next, at.q_next)]


made = st.builds(true_of, polynomials(degree=4, most_terms=3), st.integers(1, 3))
also = st.builds(true_of, trigonometric(most_terms=1), st.integers(1, 2))


@quick
@given(made | also)
def test_true_claims_are_proved(at: True_) -> None:
    assert verdict(at, "step_map", p_next=at.p_next, q_next=at.q_next) is Verdict.PROVED
    assert verdict(at, "jacobian", entries=entries(at)) is Verdict.PROVED
    assert verdict(at, "delta_j", formula=at.delta_j) is Verdict.PROVED
    assert verdict(at, "lambda_factor", formula=at.delta_j + 1) is Verdict.PROVED
    assert verdict(at, "area_preserving", area_preserving=at.order is None) is Verdict.PROVED
    if at.order is not None:
        leading = at.delta_j.coeff(H, at.order) * H**at.order
        assert verdict(at, "delta_j", formula=leading, up_to=at.order + 1) is Verdict.PROVED
        assert verdict(at, "order", order=at.order) is Verdict.PROVED
    if at.convergence is not None:
        found = verdict(at, "convergence_order", convergence_order=at.convergence)
        assert found is Verdict.PROVED


@quick
@given(made | also, st.data())
def test_planted_orders_are_refuted(at: True_, data: st.DataObject) -> None:
    assert verdict(at, "area_preserving", area_preserving=at.order is not None) is Verdict.REFUTED
    off = data.draw(st.sampled_from([1, -1, 2]))
    if at.order is None:
        assert verdict(at, "order", order=data.draw(st.integers(1, 9))) is Verdict.REFUTED
    elif at.order + off > 0:
        assert verdict(at, "order", order=at.order + off) is Verdict.REFUTED
        least = verdict(at, "order", order=at.order + off, at_least=True)
        assert least is (Verdict.REFUTED if off > 0 else Verdict.PROVED)
    if at.convergence is not None and at.convergence + off > 0:
        found = verdict(at, "convergence_order", convergence_order=at.convergence + off)
        assert found is Verdict.REFUTED


@quick
@given(made | also, st.data())
def test_planted_errors_in_formulas_are_refuted(at: True_, data: st.DataObject) -> None:
    """One thing changed in p′, in ΔJ or in an entry, wherever that changes the function."""
    place = data.draw(st.sampled_from(["p_next", "q_next", "delta_j", "entry"]))
    i, j = data.draw(st.integers(0, 1)), data.draw(st.integers(0, 1))
    printed = entries(at)[i][j] if place == "entry" else to_text(getattr(at, place))
    changed = data.draw(st.sampled_from(mutants(printed) or ["1"]))
    try:
        value = plain(changed)
    except (TypeError, ValueError, ZeroDivisionError, RecursionError):
        assume(False)
        return
    assume(value.is_finite is not False and not value.has(sympy.I, sympy.zoo, sympy.nan))
    assume(not zero(value - plain(printed)))
    if place == "delta_j":
        found = verdict(at, "delta_j", formula=value)
    elif place == "entry":
        wrong = entries(at)
        wrong[i][j] = to_text(value)
        found = verdict(at, "jacobian", entries=wrong)
    else:
        keys = {"p_next": at.p_next, "q_next": at.q_next, place: value}
        found = verdict(at, "step_map", **keys)
    assert found is Verdict.REFUTED


@quick
@given(
    polynomials("p", degree=4, most_terms=2), polynomials("q", degree=4, most_terms=2), st.data()
)
def test_claims_on_symplectic_euler_of_separable_hamiltonians(
    kinetic: str, potential: str, data: st.DataObject
) -> None:
    energy = plain(f"{kinetic} + {potential}")
    p_next = P - H * energy.diff(Q)
    q_next = Q + H * energy.diff(P).xreplace({P: p_next})
    at = True_(
        f"{kinetic} + {potential}", "symplectic-euler", p_next, q_next, sympy.S.Zero, None, 1
    )
    assert verdict(at, "step_map", p_next=p_next, q_next=q_next) is Verdict.PROVED
    assert verdict(at, "area_preserving", area_preserving=True) is Verdict.PROVED
    assert verdict(at, "area_preserving", area_preserving=False) is Verdict.REFUTED
    assert verdict(at, "order", order=data.draw(st.integers(1, 9))) is Verdict.REFUTED
    assert verdict(at, "delta_j", formula=H ** data.draw(st.integers(1, 9))) is Verdict.REFUTED
    wrong = p_next + data.draw(st.sampled_from([H**2 * Q, H * P / 10**9, Q * H**7]))
    assert verdict(at, "step_map", p_next=wrong, q_next=q_next) is Verdict.REFUTED


# -- numbers --------------------------------------------------------------------------------------


def numbers_file(at: Case, printed: dict[str, str], bound: str) -> str:
    claims = "".join(
        f'[[claim]]\nid = "{kind}"\nkind = "{kind}"\nprinted = "{text}"\n'
        for kind, text in printed.items()
    )
    return (
        f'[defaults]\nscheme = "{at.scheme}"\nhamiltonian = "{at.text}"\nstep_size = "{at.h}"\n'
        f'steps = {at.steps}\nq = "{at.q}"\np = "{at.p}"\n{claims}'
        f'[[claim]]\nid = "bounded"\nkind = "bounded"\nbound = "{bound}"\n'
    )


def verdicts_of(content: str) -> dict[str, Verdict]:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "claims.toml"
        path.write_text(content)
        found = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    return {claim.id: claim.verdict for claim in found}


def test_a_value_halfway_between_two_printed_ones_is_seen() -> None:
    assert is_halfway(Fraction(50625, 10**8), "5.062e-04")
    assert not is_halfway(Fraction(50625, 10**8), "5.0625e-04")
    assert not is_halfway(Fraction(50624, 10**8), "5.062e-04")


def is_halfway(value: Fraction, printed: str) -> bool:
    mantissa, _, exponent = printed.partition("e")
    places = len(mantissa.partition(".")[2])
    return 2 * abs(value - Fraction(printed)) == Fraction(10) ** (int(exponent or 0) - places)


@drawn(15)
@given(polynomials(degree=3, most_terms=2), st.integers(1, 2), st.integers(2, 9), st.data())
def test_printed_numbers_are_enclosed_and_with_one_digit_changed_refuted(
    text: str, eta: int, digits: int, data: st.DataObject
) -> None:
    """Against the same few steps in rational numbers."""
    at = Case(text, f"lie{eta}", Fraction(3, 7), Fraction(-2, 5), Fraction(1, 20), 4, {})
    true = {name: value for name, (value, _) in exact(at).items()}
    assume(true["mse"] != 0 and true["lambda"] != 0)
    printed = {kind: decimal(true[kind], digits) for kind in ("mse", "lambda")}
    # A value halfway between two printed numbers rounds to neither beyond doubt.
    assume(not any(is_halfway(true[kind], text) for kind, text in printed.items()))
    largest = true["lambda_max"]
    good = verdicts_of(numbers_file(at, printed, str(decimal(largest * Fraction(1001, 1000), 30))))
    assert set(good.values()) == {Verdict.ENCLOSED}
    wrong = {kind: digit_changed(text, data) for kind, text in printed.items()}
    bad = verdicts_of(numbers_file(at, wrong, decimal(largest * Fraction(999, 1000), 30)))
    assert set(bad.values()) == {Verdict.REFUTED}


def digit_changed(printed: str, data: st.DataObject) -> str:
    """Another digit at one place: at least one unit of the last place off."""
    places = [i for i, c in enumerate(printed.partition("e")[0]) if c.isdigit()]
    at = data.draw(st.sampled_from(places))
    other = data.draw(st.sampled_from([d for d in "123456789" if d != printed[at]]))
    return printed[:at] + other + printed[at + 1 :]
