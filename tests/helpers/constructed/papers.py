"""Reports of papers built by hand: statements in every category, repairs, tables and causes."""

from typing import Any

from tests.helpers.constructed.scenes import PAPER
from verify.claims.claims_file import load_claims
from verify.prose import read_prose
from verify.scenes.results.claim import ClaimResult, statements_of
from verify.scenes.results.report import Provenance, Report
from verify.verdict import Verdict

P, R, U = Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED

SIZES = ("0.001", "0.002", "0.004", "0.006", "0.008", "0.01")
STARTS = ("0.1", "0.3", "0.5", "1", "1.5")


# A table that five initial values have, at six step sizes, and the program that computes it.
COMPUTED: dict[str, Any] = {
    "details": (
        ("initial value", *(f"h = {h}" for h in SIZES)),
        ("printed, for all", *(f"-9.{n}" for n in range(6))),
        *(
            (f"q₀ = {q}, p₀ = 0", *(f"-1{k}.{n}071" for n in range(6)))
            for k, q in enumerate(STARTS)
        ),
    ),
    "reproduction": "print(1)\n",
}


def reading(of: str, verdict: Verdict, **changes: Any) -> ClaimResult:
    """A claim that is a reading of the statement `of`, or ours for ""; its evidence names it."""
    name = changes.get("id", of)
    fields: dict[str, Any] = {
        "id": name, "source": f"Eq. {of or name}", "statement": f"It is {of or name}.",
        "statement_id": of, "standing": "fair" if of else "ours", "scene": "", "verdict": verdict,
        "evidence": f"because of {name}",
    }  # fmt: skip
    return ClaimResult.model_validate(fields | changes)


def repair(of: str, verdict: Verdict = P, **changes: Any) -> ClaimResult:
    """A claim of ours that repairs the statement `of`."""
    name = f"{of}-right"
    fields = {"id": name, "statement": f"It is rather {name}.", "repairs": of}
    return reading("", verdict, **fields | changes)


def table(of: str, verdict: Verdict = R, **changes: Any) -> ClaimResult:
    """A refuted table."""
    fields = COMPUTED | {
        "source": f"Table {of}", "statement": "The printed row.",
        "evidence": "6 of 6 entries are wrong: they are lg(1/N)",
    }  # fmt: skip
    return reading(of, verdict, **fields | changes)


def paper(*claims: ClaimResult, **changes: Any) -> Report:
    """The report of these claims, whose statements are counted."""
    made_by = Provenance(
        command="verify report mine.toml", versions={"Python": "3"}, machine="one", seconds=1.0,
        kept=0, computed=1,
    )  # fmt: skip
    fields: dict[str, Any] = {
        "title": "“A scheme”: what holds of it", "claims": claims,
        "statements": statements_of(claims), "scenes": (), "left_out": (), "provenance": made_by,
    }  # fmt: skip
    return Report.model_validate(fields | changes)


def each_category(**changes: Any) -> Report:
    """Statements A … G: as meant, misprinted, depending, refuted twice, undecided, and a table.

    B and D have a repair, E has one that is refuted itself, the others have none.
    """
    return paper(
        reading("A", P),
        reading("A", R, id="A-strictly", standing="strict"),
        reading("B", R, id="B-letter", standing="misprint"),
        reading("B", P, repaired=read_prose("It is `B^2`."), repairs="B", effect="none"),
        reading("C", R, id="C-narrow"),
        reading("C", P, id="C-broad"),
        reading("D", R),
        repair("D", effect="conclusion"),
        reading("E", R),
        repair("E", R),
        reading("F", U),
        table("G"),
        repair("G", effect="table"),
        **changes,
    )


def paper_sized() -> Report:
    """The statements, repairs and causes of the paper's own file, with more refuted than are.

    Only what is ours, or a repair, holds; nothing is computed.
    """
    file = load_claims(PAPER / "claims.toml")
    claims = []
    for claim in file.claims:
        holds = claim.standing == "ours" or claim.repaired
        result = claim.result(P if holds else R, "by hand")
        is_table = result.kind == "table" and not holds
        claims.append(result.model_copy(update=COMPUTED if is_table else {}))
    return paper(*claims, title=file.title, preface=file.about, causes=tuple(file.causes))
