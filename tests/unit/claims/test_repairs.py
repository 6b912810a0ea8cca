"""What may be claimed in place of a statement: what a file may say of it, and what a result has."""

from collections.abc import Callable
from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.prose import Formula
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

HEAD = '[defaults]\nscheme = "lie2"\nsystem = "harmonic"\nkind = "defect_order"\n'
# ΔJ of lie2 on the oscillator is of order 4.
STATEMENT = '[[claim]]\nid = "eq-1"\ndefect_order = 3\nstatement = "It is of order 3."\n'
OTHER = '[[claim]]\nid = "eq-2"\ndefect_order = 4\nstatement = "It is of order 4."\n'
READING = '[[claim]]\nid = "read"\ndefect_order = 4\nreading_of = "eq-1"\nreading = "rightly"\n'
OURS = '[[claim]]\nid = "ours"\ndefect_order = 4\nstanding = "ours"\nstatement = "It is `h^4`."\n'


@pytest.fixture
def results_of(tmp_path: Path) -> Callable[..., dict[str, ClaimResult]]:
    """Judges the claims of a file with these lines."""

    def judge(*lines: str) -> dict[str, ClaimResult]:
        path = tmp_path / "claims.toml"
        path.write_text(HEAD + "".join(lines), encoding="utf-8")
        results = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
        return {result.id: result for result in results}

    return judge


# -- what is right --------------------------------------------------------------------------------


def test_a_claim_of_ours_repairs_the_statement_that_it_names(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    results = results_of(STATEMENT, OURS, 'repairs = "eq-1"\neffect = "table"\n')
    ours = results["ours"]
    assert (ours.repairs, ours.repaired, ours.effect) == ("eq-1", "", "table")
    assert (ours.statement_id, ours.verdict) == ("", Verdict.PROVED)
    assert (results["eq-1"].repairs, results["eq-1"].verdict) == ("", Verdict.REFUTED)


def test_a_claim_of_ours_repairs_nothing_if_it_does_not_say_so(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    assert results_of(STATEMENT, OURS)["ours"].repairs == ""


def test_a_claim_of_ours_may_repair_a_statement_that_stands_after_it(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    assert results_of(OURS, 'repairs = "eq-1"\n', STATEMENT)["ours"].repairs == "eq-1"


def test_a_reading_with_other_words_repairs_its_statement(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    words = 'repaired = "It is `h^4`."\neffect = "none"\n'
    read = results_of(STATEMENT, READING, words)["read"]
    assert (read.repairs, read.effect, read.statement) == ("eq-1", "none", "It is of order 3.")
    assert read.repaired.parts == ("It is ", Formula("h^4"), ".")


def test_a_reading_without_other_words_repairs_nothing(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    assert results_of(STATEMENT, READING)["read"].repairs == ""


def test_the_first_reading_may_repair_its_statement_too(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    """Such a statement is printed as it is meant, and with a word that is wrong."""
    first = OTHER + 'reading = "so"\nrepaired = "The order is 4."\n'
    assert results_of(first)["eq-2"].repairs == "eq-2"


def test_a_claim_of_ours_may_have_other_words_than_its_statement(
    results_of: Callable[..., dict[str, ClaimResult]],
) -> None:
    ours = results_of(STATEMENT, OURS, 'repairs = "eq-1"\nrepaired = "4, and not 3."\n')["ours"]
    assert (ours.repairs, ours.repaired) == ("eq-1", "4, and not 3.")


# -- mistakes -------------------------------------------------------------------------------------

NO_REPAIR = "goes with `repairs`, or with `repaired` in a reading of a statement"
WRONG = {  # the lines of the file after its head, and what is said with the line of the key
    "repairs-of-a-first-reading": (
        STATEMENT + 'repairs = "eq-2"\n' + OTHER + OURS,
        "claims.toml:9: claim eq-1: repairs=eq-2: is a key of claims that are ours",
    ),
    "repairs-of-another-reading": (
        STATEMENT + READING + 'repairs = "eq-1"\n',
        "claims.toml:14: claim read: repairs=eq-1: is a key of claims that are ours",
    ),
    "repairs-of-an-unknown-statement": (
        STATEMENT + OURS + 'repairs = "eq-11"\n',
        "claims.toml:14: claim ours: repairs=eq-11: unknown; is eq-1 meant?",
    ),
    "repairs-of-nothing-alike": (
        STATEMENT + OTHER + OURS + 'repairs = "table"\n',
        "claims.toml:18: claim ours: repairs=table: unknown; allowed: eq-1, eq-2",
    ),
    "repairs-of-a-reading": (
        STATEMENT + READING + OURS + 'repairs = "read"\n',
        "claims.toml:19: claim ours: repairs=read: unknown; allowed: eq-1",
    ),
    "repairs-of-ours": (
        STATEMENT + OURS + 'repairs = "ours"\n',
        "claims.toml:14: claim ours: repairs=ours: unknown; allowed: eq-1",
    ),
    "effect-alone": (
        STATEMENT + 'effect = "none"\n' + OURS,
        f"claims.toml:9: claim eq-1: effect=none: {NO_REPAIR}",
    ),
    "effect-of-ours-alone": (
        STATEMENT + OURS + 'effect = "table"\n',
        f"claims.toml:14: claim ours: effect=table: {NO_REPAIR}",
    ),
    "words-of-ours-alone": (
        STATEMENT + OURS + 'repaired = "It is 4."\n',
        f"claims.toml:14: claim ours: repaired=It is 4.: {NO_REPAIR}",
    ),
    "words-where-no-statement-is-counted": (
        STATEMENT + 'repaired = "It is 4."\n',
        f"claims.toml:9: claim eq-1: repaired=It is 4.: {NO_REPAIR}",
    ),
    "no-such-effect": (
        STATEMENT + OURS + 'repairs = "eq-1"\neffect = "all"\n',
        "claims.toml:15: claim ours: effect=all: must be '', 'none', 'table' or 'conclusion'",
    ),
    "no-words": (
        STATEMENT + READING + "repaired = 3\n",
        "claims.toml:14: claim read: repaired=3: ",
    ),
}


@pytest.mark.parametrize(("lines", "message"), WRONG.values(), ids=WRONG)
def test_what_repairs_nothing_is_named_with_its_line(
    tmp_path: Path, lines: str, message: str
) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(HEAD + lines, encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_claims(path)
    assert str(error.value).startswith(message)
    assert "\n" not in str(error.value)
