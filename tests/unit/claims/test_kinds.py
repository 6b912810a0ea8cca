"""The paper's claims: each as it is printed, and each equation with one thing in it changed.

Mutants are made on the syntax tree of the printed formula, one change at a time. What a mutant is
worth is decided without `verify`: sympy derives the true map, Jacobian and ΔJ, and mpmath compares
at rational points (or sympy expands in h, where a claim holds up to a power of h).
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import pytest
import sympy

from tests.helpers.planted.mutation import mutants
from tests.helpers.sampled.formulas import H, P, Q, evaluate, lie_step, plain, plain_delta_j
from tests.helpers.sampled.identities.drawn import HIDDEN
from tests.paths import ROOT
from verify.claims.base_claim import Claim, Findings
from verify.claims.claims_file import load_claims
from verify.claims.verdicts import add_claims
from verify.errors import InputError
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene, load_scene
from verify.studies.tasks_of_scenes import plan_scenes
from verify.verdict import Verdict

PAPER = ROOT / "reports" / "paper"
FILE = load_claims(PAPER / "claims.toml")
CLAIMS: dict[str, Any] = {claim.id: claim for claim in FILE.claims}
EQUATIONS = {
    id_: claim for id_, claim in CLAIMS.items() if id_.startswith("eq-") and claim.kind != "theorem"
}
# Theorems speak of no scene: they are judged in tests/unit/papers.
ON_SCENES = {id_: claim for id_, claim in CLAIMS.items() if claim.kind != "theorem"}
SCENES = {name: load_scene(PAPER / f"{name}.toml") for name in ("duffing", "pendulum")}
ENERGY = {"duffing": "p**2/2 + q**2/2 + delta*q**4/4", "pendulum": "p**2/2 - cos(q)"}
POINTS = [
    {"p": Fraction(a, 17), "q": Fraction(b, 13), "h": Fraction(c, 11), "delta": Fraction(d, 7)}
    for a, b, c, d in ((5, -7, 3, 4), (-3, 11, 8, 9), (29, 4, -5, -6), (-8, -9, 2, 15))
]


def proofs_alone(scene: Scene) -> Scene:
    return scene.with_only(criteria=scene.criteria, every_hamiltonian=scene.every_hamiltonian)


@pytest.fixture(scope="module")
def proved() -> Findings:
    """The paper's scenes with their proofs and no run."""
    scenes = {name: proofs_alone(scene) for name, scene in SCENES.items()}
    return Findings(
        scenes, execute(plan_scenes(list(scenes.values())), Store(None), where=THIS_PROCESS)
    )


# -- what is true, without verify -----------------------------------------------------------------


@cache
def true_map(scene: str, scheme: str) -> tuple[sympy.Expr, sympy.Expr]:
    energy = plain(ENERGY[scene])
    if scheme == "lie2":
        return lie_step(energy, 2)
    assert scheme == "symplectic-euler"
    p_next = P - H * energy.diff(Q)
    return p_next, Q + H * energy.diff(P).subs(P, p_next)


def differences(claim: Any) -> list[sympy.Expr]:
    """printed − true for each formula of the claim."""
    p_next, q_next = true_map(claim.scene, claim.scheme)
    if claim.kind == "step_map":
        printed_p = plain(claim.p_next)
        printed_q = plain(claim.q_next).subs(sympy.Symbol("p_next"), printed_p)
        return [printed_p - p_next, printed_q - q_next]
    if claim.kind == "jacobian":
        true = [[x.diff(z) for z in (P, Q)] for x in (p_next, q_next)]
        return [plain(claim.entries[i][j]) - true[i][j] for i in (0, 1) for j in (0, 1)]
    printed = plain(claim.formula) - (1 if claim.kind == "lambda_factor" else 0)
    return [printed - plain_delta_j(p_next, q_next)]


def holds(claim: Any) -> bool:
    """Whether the claim is true, by sympy and mpmath."""
    for difference in differences(claim):
        up_to = getattr(claim, "up_to", None)
        if up_to is not None:
            powers = sympy.Poly(sympy.expand(difference), H).as_dict()
            if any(n < up_to for (n,) in powers):
                return False
        elif any(abs(evaluate(difference, at, 50)) > 10**-40 for at in POINTS):
            return False
    return True


# -- mutants --------------------------------------------------------------------------------------


def mutated(claim: Any) -> Iterator[Any]:
    """The claim with one of its formulas mutated."""
    if claim.kind == "step_map":
        for name in ("p_next", "q_next"):
            for text in mutants(getattr(claim, name)):
                yield claim.model_copy(update={name: text})
    elif claim.kind == "jacobian":
        for i in (0, 1):
            for j in (0, 1):
                for text in mutants(claim.entries[i][j]):
                    entries = [list(row) for row in claim.entries]
                    entries[i][j] = text
                    yield claim.model_copy(update={"entries": tuple(map(tuple, entries))})
    else:
        for text in mutants(claim.formula):
            yield claim.model_copy(update={"formula": text})
        if claim.up_to is not None:
            for change in (1, -1):
                yield claim.model_copy(update={"up_to": claim.up_to + change})


# Mutants that are true: a weaker claim is no error.
WEAKER = "up to O(h³) instead of O(h⁴): the difference is O(h⁴), so it is O(h³) as well"
EQUIVALENT = {("eq-21", "up_to", 3): WEAKER, ("eq-22", "up_to", 3): WEAKER,
              ("eq-23", "up_to", 3): WEAKER}  # fmt: skip


def change_in(claim: Any) -> tuple[str, str, Any]:
    """A mutant's id, and the key that was changed with its new value."""
    printed = CLAIMS[claim.id]
    (key,) = (k for k in type(claim).model_fields if getattr(claim, k) != getattr(printed, k))
    return claim.id, key, getattr(claim, key)


def verdicts(claims: Sequence[Any], findings: Findings) -> list[Verdict]:
    return [r.verdict for r in [claim.judge(findings) for claim in claims]]


def test_the_equations_of_the_issue_are_all_there() -> None:
    numbers = {int(id_.removeprefix("eq-")) for id_ in EQUATIONS}
    assert numbers == {*range(19, 25), *range(27, 33)}


@pytest.mark.left_to_ci
def test_there_are_at_least_500_mutants_and_those_that_are_true_are_explained() -> None:
    made = [m for claim in EQUATIONS.values() for m in mutated(claim)]
    assert len(made) >= 500
    assert {change_in(m) for m in made if holds(m)} == set(EQUIVALENT)


def test_mutants_change_signs_numbers_exponents_names_and_terms() -> None:
    made = mutants("1 - h**2/2*cos(q)")
    for expected in (
        "1 + h ** 2 / 2 * cos(q)",
        "2 - h ** 2 / 2 * cos(q)",
        "1 - h ** 3 / 2 * cos(q)",
        "1 - h ** 2 / 1 * cos(q)",
        "1 - h ** 2 / 2 * sin(q)",
        "1 - h ** 2 / 2 * cos(p)",
        "1 - q ** 2 / 2 * cos(q)",
        "1",
        "-(h ** 2 / 2 * cos(q))",
        "2 * 1 - h ** 2 / 2 * cos(q)",
        "1 - 2 * (h ** 2 / 2 * cos(q))",
    ):
        assert expected in made


@pytest.mark.parametrize("claim", EQUATIONS.values(), ids=EQUATIONS)
def test_an_equation_is_proved_as_it_is_printed(claim: Claim, proved: Findings) -> None:
    assert holds(claim), "the oracle of this file agrees"
    (found,) = [claim.judge(proved)]
    assert found.verdict is Verdict.PROVED
    assert found.evidence


@pytest.mark.left_to_ci
@pytest.mark.parametrize("claim", EQUATIONS.values(), ids=EQUATIONS)
def test_an_equation_with_one_thing_changed_is_refuted(claim: Claim, proved: Findings) -> None:
    made = list(mutated(claim))
    assert len(made) >= 15
    expected = [Verdict.PROVED if change_in(m) in EQUIVALENT else Verdict.REFUTED for m in made]
    found = [claim.judge(proved) for claim in made]
    wrong = [(m, f.verdict, e) for m, f, e in zip(made, found, expected, strict=True)
             if f.verdict is not e]  # fmt: skip
    assert not wrong
    refuted = [f for f in found if f.verdict is Verdict.REFUTED]
    assert all("printed − computed = " in f.evidence and "not zero" in f.evidence for f in refuted)


REWRITTEN = {
    "eq-29-by-sin": ("eq-29", "h**4/4*(1 - sin(q)^2) - h**3/2*p*sin(q)"),
    "eq-29-by-cos-2q": ("eq-29", "h**4/8*(1 + cos(2*q)) - h**3*p/2*sin(q)"),
    "eq-29-by-tan": ("eq-29", "h**4/4/(1 + tan(q)**2) - h**3*p*sin(q/2)*cos(q/2)"),
    "eq-31-factored": ("eq-31", "1 + h**3/4*(h*cos(q)**2 - 2*p*sin(q))"),
    "eq-21-with-more": ("eq-21", "3*delta*p*q*h**3 + 77*h**4*q - h^5"),
}


@pytest.mark.parametrize(("id_", "formula"), REWRITTEN.values(), ids=REWRITTEN)
def test_an_equation_written_in_another_way_is_proved(
    id_: str, formula: str, proved: Findings
) -> None:
    claim = CLAIMS[id_].model_copy(update={"formula": formula})
    assert holds(claim)
    assert verdicts([claim], proved) == [Verdict.PROVED]


def test_an_identity_that_is_not_seen_is_neither_proved_nor_refuted(proved: Findings) -> None:
    more = CLAIMS["eq-29"].formula + " + " + HIDDEN
    claim = CLAIMS["eq-29"].model_copy(update={"formula": more})
    assert verdicts([claim], proved) == [Verdict.UNDECIDED]


def test_what_holds_for_positive_q_alone_is_proved_there(proved: Findings) -> None:
    more = CLAIMS["eq-29"].formula + " + log(q**2) - 2*log(q)"
    claim = CLAIMS["eq-29"].model_copy(update={"formula": more})
    found = claim.judge(proved)
    assert (found.verdict, found.domain) == (Verdict.PROVED, ("q > 0",))


@pytest.mark.parametrize("up_to", [3, 5, 6])
def test_a_remainder_is_of_the_order_printed_and_no_higher(up_to: int, proved: Findings) -> None:
    """Eq. 21 leaves out a term in h⁴: it holds up to O(h⁴), and not up to O(h⁵)."""
    claim = CLAIMS["eq-21"].model_copy(update={"up_to": up_to})
    expected = Verdict.PROVED if up_to <= 4 else Verdict.REFUTED
    assert verdicts([claim], proved) == [expected]
    assert holds(claim) == (expected is Verdict.PROVED)


def test_eq_21_without_its_remainder_is_refuted(proved: Findings) -> None:
    exact = CLAIMS["eq-21"].model_copy(update={"up_to": None})
    assert verdicts([exact], proved) == [Verdict.REFUTED]


@pytest.mark.parametrize("id_", ["eq-19", "eq-27"])
@pytest.mark.parametrize("scheme", ["lie1", "lie3", "symplectic-euler"])
def test_an_equation_of_one_scheme_is_refuted_for_another(
    id_: str, scheme: str, proved: Findings
) -> None:
    scenes = {n: s.model_copy(update={"schemes": (scheme,)}) for n, s in proved.scenes.items()}
    findings = Findings(
        scenes, execute(plan_scenes(list(scenes.values())), Store(None), where=THIS_PROCESS)
    )
    claim = CLAIMS[id_].model_copy(update={"scheme": scheme})
    assert verdicts([claim], findings) == [Verdict.REFUTED]


@pytest.mark.parametrize("formula", ["3*h**3*delta*p*q + eps", "abs(q)", "open('x')", "h**3*", ""])
def test_a_claim_that_is_no_formula_is_an_input_error(formula: str, proved: Findings) -> None:
    with pytest.raises(InputError, match="claim eq-21"):
        [CLAIMS["eq-21"].model_copy(update={"formula": formula}).judge(proved)]


# -- claims on scenes, on short runs --------------------------------------------------------------


@pytest.fixture(scope="module")
def short() -> tuple[Findings, dict[str, ClaimResult]]:
    """The paper's scenes and those of its claims over [0, 2], and the claims checked on them."""
    scenes = {}
    for name, scene in FILE.scenes.items():
        scenes[name] = proofs_alone(scene)
        if scene.grid is not None:
            grid = scene.grid.model_copy(update={"time": Fraction(2), "separate": False})
            scenes[name] = scenes[name].model_copy(update={"grid": grid})
    plan = plan_scenes([scenes[name] for name in SCENES])
    known = add_claims(plan, list(ON_SCENES.values()), scenes)
    findings = Findings(scenes, {**known, **execute(plan, Store(None), where=THIS_PROCESS)})
    return findings, {r.id: r for r in [claim.judge(findings) for claim in ON_SCENES.values()]}


@pytest.mark.left_to_ci
def test_every_claim_on_the_papers_scenes_gets_a_verdict_with_evidence(short: Any) -> None:
    _, found = short
    assert set(found) == set(ON_SCENES)
    for id_, claim in ON_SCENES.items():
        assert (found[id_].source, found[id_].scene) == (claim.source, claim.scene)
        assert found[id_].evidence
        assert "\n" not in found[id_].evidence
    assert all(found[id_].verdict is Verdict.PROVED for id_ in EQUATIONS)
    assert ["det J" in found[f"eq-{n}"].evidence for n in (23, 31)] == [True, True]
    assert not any("det J − 1" in found[f"eq-{n}"].evidence for n in (23, 31))
    assert found["duffing-criteria"].verdict is Verdict.PROVED
    assert {found[id_].verdict for id_ in ("table-1", "table-2")} == {Verdict.REFUTED}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", ["duffing", "pendulum"])
def test_the_measured_verdicts_are_those_of_plain_floats(short: Any, name: str) -> None:
    findings, found = short
    runs = findings.runs(findings.scenes[name], "lie2")
    starts, sizes = sorted({(r.q, r.p) for r in runs}), sorted({float(r.step_size) for r in runs})
    at = {(r.q, r.p, float(r.step_size)): {n: float(v.value) for n, v in r.values.items()}
          for r in runs}  # fmt: skip
    mse = [[at[*s, h]["mse"] for h in sizes] for s in starts]
    lam = [[abs(at[*s, h]["lambda"]) for h in sizes] for s in starts]
    ratio = [[m / x for m, x in zip(*rows, strict=True)] for rows in zip(mse, lam, strict=True)]

    def increases(rows: list[list[float]]) -> bool:
        return all(a < b for row in rows for a, b in pairwise(row))

    expected = {
        f"{name}-mse-increases": increases(mse),
        f"{name}-lambda-increases": increases(lam),
        f"{name}-ratio-decreases": increases([[-x for x in row] for row in ratio]),
        f"{name}-mse-initial-values": all(max(c) < 2 * min(c) for c in zip(*mse, strict=True)),
    }
    for id_, true in expected.items():
        assert found[id_].verdict is (Verdict.ENCLOSED if true else Verdict.REFUTED), id_
