"""The paper's claims file: every equation and criterion is claimed, and what is said is counted."""

import re
from collections.abc import Iterator

import pytest

from tests.paths import ROOT
from verify.claims.claims_file import load_claims

FILE = load_claims(ROOT / "reports" / "paper" / "claims.toml")
README = "README.md"
PAGES = (README, "docs/explanation/results-of-the-paper.md")
EQUATIONS = range(1, 33)
CRITERIA = range(1, 5)
FIGURES = range(1, 15)
# Refuted in every reading, and readings that were added or judged otherwise after a referee's look.
REFUTED = {
    "table-1", "table-2", "duffing-mse-initial-values", "pendulum-mse-initial-values",
    "duffing-mse-size", "pendulum-mse-size", "criterion-4-against-2",
}  # fmt: skip
REREAD = {
    "eq-9-kept", "eq-10-components", "eq-11", "criterion-4-and-2", "criterion-4-and-3",
    "criterion-4-against-3", "criterion-4-against-3-smooth", "duffing-ratio-decreases-drawn",
    "duffing-ratio-alike-drawn", "duffing-no-pattern", "duffing-no-pattern-50",
    "mse-quantifies-solution", "higher-derivatives-nonlinearity", "errors-in-every-step-exactly",
    "duffing-criteria-inference", "cat-face-elsewhere", "duffing-multi-step-area-elsewhere",
    "duffing-multi-step-consistent-elsewhere", "solution-error", "solution-error-pendulum",
    "solution-error-small-step", "solution-error-small-step-pendulum", "pendulum-disappointing",
    "pendulum-satisfactory-solution", "pendulum-satisfactory-solution-figure-10",
}  # fmt: skip
SECTIONS = ["2.1", "2.2", "3", "4.1", "4.2", "5", "Abstract"]
# Sentences of the paper that state something, in its words, with a claim on each.
SENTENCES = {
    "solution errors over long times": "solution-error",
    "convergence of the proposed algorithm is demonstrated": "convergence-inference",
    "exactly preserves the area": "criterion-1",
    "does not possess a strict symplectic structure": "not-symplectic",
    "function that depends on the step size": "determinant-depends-on-h",
    "cannot always be equal to 1": "determinant-of-the-examples",
    "near area-preserving": "criterion-2",
    "`ΔJ_k` → 0, when h → 0": "delta-j-tends-to-0",
    "near-identity mapping": "near-identity",
    "sum of the squares of the differences": "eq-15",
    "possible to quantify the accuracy": "mse-quantifies",
    "produces errors in every transformation": "errors-in-every-step",
    "partitioned into two different, separate parts": "partitioned",
    "Due to the nonlinearity of the system": "higher-derivatives",
    "between criterion 4 and criterion 3": "criterion-4-and-3",
    "compared to criterion 3": "criterion-4-against-3",
    "nearly area preserving": "criterion-3",
    "total error of the mapping will keep increasing": "total-error-increases",
    "approximately area-preserving transformation": "criterion-4",
    "sufficient condition for criterion 3": "criterion-2-implies-3",
    "no definite connection": "criterion-4-and-2",
    "stronger area-preserving performance": "criterion-4-against-2",
    "phase flow remains unchanged": "area-definition",
    "2-norm": "two-norm",
    "simplest symplectic algorithm": "symplectic-euler",
    "all dependent on": "duffing-depends",
    "as the step size increases, the mean squared error increases": "duffing-mse-increases",
    "the mean squared error hardly changes": "duffing-mse-initial-values",
    "in the order of": "duffing-mse-size",
    "high-order small quantity": "duffing-criterion-3",
    "as the step size increases, the cumulative total error increases": "duffing-lambda-increases",
    "fluctuates without any pattern": "duffing-no-pattern",
    "decreases with the increase of the step size": "duffing-ratio-decreases",
    "consistent regardless of the initial values": "duffing-ratio-alike",
    "smaller than the cumulative error": "duffing-mse-below-lambda",
    "smaller cumulative error has a better": "smaller-lambda",
    "very small cumulative total error": "duffing-small-lambda",
    "smaller step size has better": "duffing-smaller-step",
    "about 10⁻¹¹": "duffing-magnitudes-some",
    "maintaining area preservation": "duffing-criteria",
    "exact flow of the system (17) is area-preserving": "duffing-exact-flow-area",
    "maintains the dynamic behavior": "duffing-flow-dynamics",
    "possesses the geometric property of area preservation": "duffing-flow-area",
    "very consistent": "duffing-multi-step-consistent",
    "not only depend on the step size": "pendulum-depends",
    "disappointing error": "pendulum-disappointing",
    "considerably satisfactory": "pendulum-satisfactory",
    "almost coincides": "pendulum-flow-coincides",
    "strict property of preserving area": "pendulum-multi-step-euler",
    "qualitatively obtain the same results": "pendulum-multi-step-results",
    "effective in preserving the area": "pendulum-multi-step-area",
    "This paper proves": "maintains-area",
    "preserve the area of cat-face": "cat-face",
}


def numbers(kind: str, source: str) -> Iterator[int]:
    """The numbers in a source: `Eq. 2, 4 and 5` names 2, 4 and 5, `Figures 8–10` 8, 9 and 10."""
    for found in re.finditer(rf"{kind}[a-z.]* (\d+(?:(?:, | and |–)\d+)*)", source):
        for part in re.split(", | and ", found[1]):
            first, _, last = part.partition("–")
            yield from range(int(first), int(last or first) + 1)


def claimed(kind: str) -> set[int]:
    return {n for claim in FILE.claims for n in numbers(kind, claim.source)}


def test_every_equation_criterion_and_figure_has_a_claim() -> None:
    printed = [claim for claim in FILE.claims if claim.standing != "ours"]
    assert {n for c in printed for n in numbers("Eq", c.source)} >= set(EQUATIONS)
    assert {n for c in printed for n in numbers("Criteri", c.source)} >= set(CRITERIA)
    assert {figure.label for figure in FILE.figures} == {f"Figure {n}" for n in FIGURES}
    assert all(figure.claims for figure in FILE.figures)
    tables = {c.source for c in printed if c.kind == "table"}
    assert tables == {"Table 1", "Table 2"}


def test_what_refutes_a_statement_or_repairs_one_is_computed_again_by_a_test_that_is_there() -> (
    None
):
    read = {c.id for c in FILE.claims if c.reading_of in REFUTED}
    confirmed = {c.id: c.confirmed_by for c in FILE.claims if c.confirmed_by}
    assert read | REREAD <= confirmed.keys()
    for test in confirmed.values():
        path, _, name = test.partition("::")
        assert f"def {name}(" in (ROOT / path).read_text(encoding="utf-8"), test


def test_the_causes_explain_all_that_is_refuted_in_every_reading() -> None:
    explained = {name for cause in FILE.causes for name in cause.explains}
    assert explained >= REFUTED
    assert {"eq-9", "eq-10", "eq-11", "eq-12", "criterion-4-and-2"} <= explained


def test_ranges_and_lists_in_a_source_are_read() -> None:
    assert [*numbers("Eq", "Eq. 2, 4 and 5; Eq. 8–10")] == [2, 4, 5, 8, 9, 10]
    assert [*numbers("Criteri", "On Section 3, Criteria 2–4")] == [2, 3, 4]
    assert [*numbers("Eq", "Section 4.1")] == []


@pytest.mark.parametrize("words", SENTENCES)
def test_every_sentence_that_states_something_has_a_claim(words: str) -> None:
    (claim,) = [c for c in FILE.claims if c.id == SENTENCES[words]]
    assert claim.standing != "ours"
    if claim.id == "convergence-inference":
        assert "Abstract" in claim.source
    else:
        assert words.lower() in claim.statement.lower()


def test_every_section_is_spoken_of() -> None:
    assert {claim.section.split(" ")[0] for claim in FILE.claims} == set(SECTIONS)


def test_no_statement_says_how_it_is_read() -> None:
    """That is said of each reading, so that what the paper prints stands alone."""
    assert not [c.id for c in FILE.claims if "(read:" in c.statement]
    several = {c.reading_of for c in FILE.claims if c.reading_of not in ("", c.id)}
    assert not [c.id for c in FILE.claims if c.reading_of in several and not c.reading]


@pytest.mark.parametrize("page", PAGES)
def test_the_documentation_counts_the_statements_of_the_file(page: str) -> None:
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    readings = [claim for claim in FILE.claims if claim.standing != "ours"]
    statements = {claim.reading_of for claim in readings}
    assert f"{len(statements)} statements of the paper, in {len(readings)} readings" in text
    ours = re.findall(r"(\d+) more claims are ours", text)
    assert {*ours} <= {str(len(FILE.claims) - len(readings))}
    assert ours or page == README, "the page counts them, and README may"


@pytest.mark.parametrize("page", PAGES)
def test_the_documentation_names_the_paper_as_the_file_does(page: str) -> None:
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    (named,) = (line.removeprefix("The paper: ") for line in FILE.about if "Contemporary" in line)
    paper, doi = re.fullmatch(r"(.*, \d{4}), (doi:\S+?)\. .*", named).groups()  # type: ignore[union-attr]
    assert paper in text
    assert f"[{doi}](https://doi.org/{doi.removeprefix('doi:')})" in text


def test_the_page_names_the_paper_and_does_not_call_it_verified() -> None:
    assert "A New Area-Preserving Geometric Numerical Algorithm of Nonlinear Systems" in FILE.title
    assert "verified" not in FILE.title
    assert "Contemporary Mathematics" in " ".join(FILE.about)
    assert FILE.left_out
