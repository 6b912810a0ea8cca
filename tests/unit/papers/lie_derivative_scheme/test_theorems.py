"""The paper's theorems: their verdicts, and that no wrong counterexample or identity passes."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import flint
import pytest
import sympy

from tests.helpers.planted.theorem_controls import refused
from tests.paths import ROOT
from verify.claims.base_claim import Findings
from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers import check_theorem, names
from verify.papers.argument import Argument, Check, _read_argument, vanishes
from verify.papers.differential_polynomials import DifferentialFlow, flow_of_every_hamiltonian
from verify.papers.exact_maps import Areas, RationalPoint, value
from verify.papers.lie_derivative_scheme import (
    components,
    consistency,
    convergence,
    examples,
    lie_series,
    lipschitz,
    matrix_vector,
    sentences_of_section_2,
    sentences_of_section_3,
    two_norm,
)
from verify.papers.lie_derivative_scheme.criteria import connections
from verify.papers.lie_derivative_scheme.examples import ExampleMap
from verify.scenes.toml_file import read_toml
from verify.schemes import get
from verify.verdict import Verdict

PROVED, REFUTED, UNDECIDED = Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED
TOML = ROOT / "reports" / "paper" / "claims.toml"
VERDICTS = {
    "lie-exponential": PROVED,
    "eq-1": PROVED,
    "eq-3": REFUTED,
    "eq-3-meant": PROVED,
    "local-error": PROVED,
    "eq-7": REFUTED,
    "eq-7-meant": PROVED,
    "eq-8": PROVED,
    "convergence": PROVED,
    "convergence-inference": REFUTED,
    "eq-9": REFUTED,
    "eq-9-plane": PROVED,
    "eq-10": REFUTED,
    "eq-10-meant": PROVED,
    "eq-9-kept": REFUTED,
    "eq-10-components": REFUTED,
    "eq-11": REFUTED,
    "eq-11-norm": PROVED,
    "taylor-method": PROVED,
    "partitioned": PROVED,
    "partitioned-separable": REFUTED,
    "higher-derivatives": PROVED,
    "higher-derivatives-nonlinearity": REFUTED,
    "mse-quantifies": PROVED,
    "mse-quantifies-solution": REFUTED,
    "errors-in-every-step": PROVED,
    "errors-in-every-step-exactly": REFUTED,
    "duffing-criteria-inference": REFUTED,
    "two-norm": REFUTED,
    "two-norm-of-the-step": PROVED,
    "eq-12": REFUTED,
    "eq-12-tangent": PROVED,
    "near-identity": PROVED,
    "near-identity-inference": REFUTED,
    "area-definition": PROVED,
    "area-definition-flow": REFUTED,
    "criterion-1": PROVED,
    "criterion-1-any-map": REFUTED,
    "eq-14": PROVED,
    "eq-15": PROVED,
    "eq-15-sum": REFUTED,
    "eq-17": PROVED,
    "eq-25": PROVED,
    "criterion-2": PROVED,
    "criterion-3": PROVED,
    "criterion-3-any-map": REFUTED,
    "criterion-4": PROVED,
    "smaller-lambda": PROVED,
    "smaller-lambda-each-step": REFUTED,
    "determinant-of-every-h": REFUTED,
    "determinant-of-the-examples": PROVED,
    "determinant-classification": PROVED,
    "criterion-2-implies-3": PROVED,
    "criterion-4-and-2": REFUTED,
    "criterion-4-and-3": PROVED,
    "criterion-2-implies-3-pointwise": REFUTED,
    "criterion-4-and-2-pointwise": PROVED,
    "criterion-4-against-2": REFUTED,
    "criterion-4-against-2-smooth": REFUTED,
    "criterion-4-against-3": REFUTED,
    "criterion-4-against-3-smooth": PROVED,
    "criteria-of-consistent-schemes": PROVED,
    "consistency-is-not-enough": PROVED,
    "total-error-increases": REFUTED,
    "criterion-2-implies-4": PROVED,
    "criterion-4-equals-2": PROVED,
    "growth-of-lambda": PROVED,
    "right-criterion-3": PROVED,
}


# -- the registry ---------------------------------------------------------------------------------


def test_every_theorem_is_found_and_has_its_verdict() -> None:
    assert {name: check_theorem(name).verdict for name in names()} == VERDICTS
    for claim in (c for c in load_claims(TOML).claims if c.kind == "theorem"):
        found = claim.judge(Findings({}))  # here, where all theorems are checked
        assert (found.verdict, found.source) == (VERDICTS[found.id], claim.source)
        assert found.scene == claim.scene
        assert found.evidence
        assert "\n" not in found.evidence


@pytest.mark.parametrize("name", VERDICTS)
def test_an_argument_is_one_line_a_paragraph_and_a_table(name: str) -> None:
    argument = check_theorem(name)
    assert "\n" not in argument.evidence + argument.proof
    assert argument.evidence
    assert argument.proof.count("∎") == 1
    assert argument.proof.endswith(f"∎ {argument.remark}".strip())
    assert "  " not in argument.proof
    head, *rows = argument.details
    assert rows
    assert all(len(row) == len(head) and row[-1] == "holds" for row in rows)


def test_each_theorem_judges_the_claim_of_its_name() -> None:
    tables = [t for t in read_toml(TOML)["claim"] if t["kind"] == "theorem"]
    assert [t["id"] for t in tables] == [t["name"] for t in tables]
    assert {t["name"] for t in tables} == set(names())


def test_an_unknown_theorem_is_named() -> None:
    with pytest.raises(InputError, match=r"theorem=fermat.*eq-9"):
        check_theorem("fermat")


# -- a failed check shows nothing -----------------------------------------------------------------


def argued(*checks: Check) -> Argument:
    return _read_argument(Verdict.PROVED, "because\n\n- so it is [checks]", checks=checks)


def test_an_argument_with_a_failed_check_or_none_is_undecided_and_has_no_proof() -> None:
    good, bad = Check("one", True, "1"), Check("two", False, "2")
    assert argued(good).verdict is PROVED
    for wrong in (argued(good, bad), argued(bad), argued()):
        assert wrong.verdict is UNDECIDED
        assert wrong.proof == ""
    assert "two" in argued(good, bad).evidence


# -- generic H, against sympy's own derivatives ---------------------------------------------------


@pytest.mark.parametrize("eta", [1, 2, 3])
@pytest.mark.parametrize("formula", ["p**3*q + q**4/4 + p**2/2", "p**2*q**2 - q"])
def test_delta_j_of_a_generic_h_is_that_of_the_house_for_one_h(formula: str, eta: int) -> None:
    flow = flow_of_every_hamiltonian(eta + 2)
    hamiltonian = Hamiltonian.parse(formula)
    p, q, h = sympy.symbols("p q h", real=True)
    put = {}
    for name in flow.ring.names:
        if name.startswith("H"):
            i, j = map(int, name[1:].split("_"))
            put[name] = sympy.diff(hamiltonian.expression, p, i, q, j) if i + j else None
    total = sympy.Integer(0)
    for n, x in flow.delta_j(*flow.lie(eta)).items():
        for monomial, coefficient in x.to_dict().items():
            term = sympy.Rational(int(coefficient.p), int(coefficient.q)) * h**n
            for name, power in zip(flow.ring.names, monomial, strict=True):
                if power:
                    term *= put[name] ** int(power)
            total += term
    told = get(f"lie{eta}").step_map(hamiltonian).delta_j
    assert sympy.expand(total - told) == 0


def test_a_derivative_beyond_the_order_of_a_generic_h_is_an_error_and_not_zero() -> None:
    flow = flow_of_every_hamiltonian(2)
    with pytest.raises(KeyError):
        flow.lie_derivatives("p", 3)


# -- Eq. 2–5 --------------------------------------------------------------------------------------


def test_a_recursion_by_one_operator_alone_is_not_the_exponential() -> None:
    def one_operator(flow: DifferentialFlow, y: Any) -> Any:
        return flow.h_p * flow.ring.diff(y, "q")

    assert refused(lie_series.lie_exponential(one_operator))


def test_a_recursion_with_a_wrong_sign_is_not_the_exponential() -> None:
    assert refused(lie_series.lie_exponential(lambda flow, y: -lie_series.eq_4(flow, y)))


def test_eq_3_with_q_for_p_is_not_refuted() -> None:
    assert refused(lie_series.eq_3("q"))


# -- Eq. 8–11 -------------------------------------------------------------------------------------


@pytest.mark.parametrize("shift", [1, -1])
def test_an_order_other_than_eta_is_not_proved(shift: int) -> None:
    assert refused(convergence.convergence(shift))


def test_eq_10_with_the_index_that_is_meant_is_not_refuted() -> None:
    assert refused(convergence.eq_10(fixed=False))


@pytest.mark.parametrize(
    "pair",
    [
        (RationalPoint(Fraction(0), Fraction(1)), RationalPoint(Fraction(0), Fraction(1))),
        (RationalPoint(Fraction(0), Fraction(0)), RationalPoint(Fraction(1), Fraction(1))),
        (RationalPoint(Fraction(0), Fraction(0)), RationalPoint(Fraction(1), Fraction(0))),
    ],
)
def test_a_pair_with_different_p_or_the_same_q_does_not_refute_eq_9(
    pair: tuple[RationalPoint, RationalPoint],
) -> None:
    assert refused(lipschitz.eq_9(pair))


@pytest.mark.parametrize(
    "formula",
    [
        "-(q - p**3)",  # lie2 steps it exactly
        "-(q - p**2) + (q - p**2)**2/2",
        "-(q - p**3) + (q - p**3)**2",
        "p**2/2 + q**2/2",
    ],
)
def test_eq_10_and_11_are_refuted_by_components_for_that_h_alone(formula: str) -> None:
    assert refused(components.eq_11(formula))
    assert refused(components.eq_10_components(formula))


def test_eq_9_with_z_tilde_is_not_refuted_by_a_step_without_a_local_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(components, "errors", lambda eta, h, steps: [flint.acb(0)] * (steps + 1))
    assert refused(components.eq_9_kept())


def test_the_two_norm_is_not_refuted_where_the_step_does_not_stretch() -> None:
    assert refused(two_norm.two_norm(RationalPoint(Fraction(0), Fraction(0))))
    assert refused(two_norm.two_norm(RationalPoint(Fraction(0), Fraction(1, 2))))


# -- Eq. 12 ---------------------------------------------------------------------------------------


def test_eq_12_is_not_refuted_by_a_quadratic_h_or_by_the_origin() -> None:
    assert refused(matrix_vector.eq_12(Hamiltonian.parse("p**2/2 + p*q + q**2")))
    assert refused(matrix_vector.eq_12(point=RationalPoint(Fraction(0), Fraction(0))))


@pytest.mark.parametrize(("p_next", "q_next"), [("-2*q", "p"), ("p - h*q", "q + h*p"), ("p", "q")])
def test_a_map_that_changes_areas_or_moves_little_does_not_refute_near_identity(
    p_next: str, q_next: str
) -> None:
    assert refused(matrix_vector.near_identity_inference(p_next, q_next))


# -- the criteria ---------------------------------------------------------------------------------

EXAMPLES = [x for x in vars(examples).values() if isinstance(x, ExampleMap)]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda e: e.name)
@pytest.mark.parametrize("place", [0, 1, 2])
def test_each_number_said_of_an_example_is_held_against_its_run(
    example: ExampleMap, place: int
) -> None:
    assert example.check().holds

    def closed(h: Fraction) -> Any:
        numbers = list(example.closed(h))
        numbers[place] += h**40
        return tuple(numbers)

    assert not replace(example, closed=closed).check().holds


def test_the_criteria_are_not_told_apart_by_maps_with_other_numbers() -> None:
    area_preserving = replace(examples.FRICTION, p_next="p", q_next="q + h*p")
    assert refused(connections.criterion_2_implies_3(replace(examples.NOT_UNIFORM, q_next="q")))
    assert refused(connections.criterion_4_and_3(friction=area_preserving))
    assert refused(connections.criterion_4_and_3(alternating=[area_preserving]))
    assert refused(connections.criterion_4_against_2(compensated=area_preserving))
    assert refused(connections.criterion_4_against_2(alternating=[area_preserving]))
    assert refused(connections.criterion_4_against_3(friction=area_preserving))
    assert refused(connections.criterion_4_against_3(alternating=[area_preserving]))
    drifting = replace(examples.COMPENSATED, p_next="p*(1 + h*(3/4 - q))")
    assert refused(connections.criterion_4_against_2(compensated=drifting))


def test_the_inequalities_hold_for_every_run_and_not_for_made_up_numbers() -> None:
    class Wrong(Areas):
        mse = Fraction(0)

    values = (Fraction(1, 2), Fraction(-1, 3), Fraction(2))
    assert connections.inequalities_hold(Areas(values))
    assert not connections.inequalities_hold(Wrong(values))


def test_a_map_for_another_field_has_a_delta_j_of_order_h() -> None:
    assert refused(consistency.criteria_of_consistent_schemes(hamiltonian=False))
    assert 1 not in consistency.consistent_map()


@pytest.mark.parametrize("q", [Fraction(1, 2), Fraction(82, 100), Fraction(83, 100), Fraction(2)])
def test_one_plus_h_times_the_norm_is_a_factor_up_to_an_edge_and_not_beyond(q: Fraction) -> None:
    assert two_norm._is_a_factor(q, Fraction(1, 1000)).holds is True
    wrong = Fraction(1, 10) if q * q < Fraction(2, 3) else Fraction(10)
    assert two_norm._is_a_factor(q, Fraction(1, 1000), wrong).holds is False


def test_no_other_examples_pass_for_the_sentences_beside_equations() -> None:
    assert refused(sentences_of_section_2.partitioned(sign=1))
    assert refused(sentences_of_section_2.partitioned_separable("p**2 + q**3"))
    assert refused(sentences_of_section_2.higher_derivatives_nonlinearity(linear="p**2/2 + q**2"))
    assert refused(sentences_of_section_2.higher_derivatives_nonlinearity(linear="p**2*q + p*q"))
    assert refused(sentences_of_section_2.higher_derivatives_nonlinearity(curved="p**2/2 + q**2"))
    assert refused(sentences_of_section_2.higher_derivatives_nonlinearity(curved="p**3 + q**4"))
    assert refused(sentences_of_section_3.mse_quantifies_solution(("p - h*q", "q + h*p")))
    assert refused(sentences_of_section_3.errors_in_every_step_exactly(share=Fraction(4, 3)))
    assert refused(sentences_of_section_3.errors_in_every_step_exactly(q=Fraction(2)))
    for p_next, q_next in (
        ("-p*(1 + h*(q + 1/20)/10**8)", "-q"),  # depends on h
        ("-p*(1 + (q - 1/20)/10**11)", "-q"),  # areas shrink
        ("-p*(1 + (q + 1/2)/10**11)", "-q"),  # too fast
        ("-p*(1 + (q + 1/20)/10**9)", "-q"),
    ):
        assert refused(sentences_of_section_3.duffing_criteria_inference((p_next, q_next)))


def test_a_start_from_which_the_total_error_grows_does_not_refute_that_it_grows() -> None:
    point = RationalPoint(Fraction(1), Fraction(1, 5))
    assert refused(sentences_of_section_3.total_error_increases(point))


def test_a_value_that_is_not_rational_is_not_taken_for_one() -> None:
    p = sympy.Symbol("p", real=True)
    with pytest.raises(ValueError, match="not rational"):
        value(sympy.sqrt(p), RationalPoint(Fraction(2), Fraction(0)), Fraction(1))


def test_vanishes_tells_a_zero_from_what_is_not() -> None:
    ring = flow_of_every_hamiltonian(1).ring
    assert vanishes("x", ring.zero).holds
    assert not vanishes("x", ring.zero, ring["p"]).holds
