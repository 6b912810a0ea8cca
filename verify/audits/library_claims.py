"""The claims on an integrator of another library, each with its verdict and evidence.

An integrator is a library's own code, or a table from its sources. The tables of each library are
in a TOML file in `reports/audits`, as `verify check-table` takes it, whose `title` is the library
with its version. Both are reported in the same way.
"""

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import partial, singledispatch
from itertools import groupby
from pathlib import Path

from verify.audits import reproductions
from verify.audits.methods import float_step, tableau_proofs
from verify.audits.methods.driver import POINTS
from verify.audits.methods.integrator import (
    ExactTableau,
    FloatStep,
    FloatTable,
    LibraryComparison,
    ReleasedIntegrator,
    table_integrator,
)
from verify.audits.reproductions import write_clock_program
from verify.audits.second_look import Look, look_again, look_at_claim, look_at_step, look_at_table
from verify.content import content
from verify.integrators.tables import kinds
from verify.integrators.tables.cost import Severity, severity_of
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.table_claim import TableClaim
from verify.integrators.tables.table_file import TableFile
from verify.prose import Prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes.printed.sentences import ruling_on_digits, ruling_on_order
from verify.schemes.printed.splitting_table import PrintedTable, judge_order
from verify.verdict import Verdict

_LITERATURE_FILE = "literature.toml"  # `verify.audits.libraries.literature` reads it
_NO_EVIDENCE = Prose()
_SYMPLECTICITY_POINTS = (
    (Fraction(1, 5), Fraction(-1, 4), Fraction(3, 10), Fraction(1, 7)),
)  # p, then q
_SYMPLECTIC = "symplectic: det J ≡ 1"
_IN_TIME_TEXT = "where the force depends on time"
_UNCLAIMED_IN_TIME = f"its order {_IN_TIME_TEXT}, of which nothing is said"
_FOLLOWING_KINDS = ("row sums", "symmetric", "stage order")
_KINDS_WITH_PROGRAM = ("agreement", "in time")  # their program is shown, whatever the verdict is
# A claim, the program that reproduces it, and a second look, which returns None if no means are
# left that share no code with the first.
_Claim = tuple[TableClaim, str, Callable[[], Look | None]]


def claims_of(integrator: ReleasedIntegrator, section: str, prefix: str) -> Iterator[ClaimResult]:
    """Yield the claims of an integrator: on its order and on its symplecticity, if they are made;
    for a printed table, on its order and on its digits.

    `prefix`: the beginning of the ids.
    """
    for claim, code, look in _claims(integrator.method, integrator):
        ending = f". Driven: {integrator.driven}"
        result = result_of(claim, prefix, integrator.name, section, integrator.source, ending, look)
        shows_code = (
            result.verdict in (Verdict.REFUTED, Verdict.UNDECIDED)
            or claim.kind in _KINDS_WITH_PROGRAM
        )
        yield result.model_copy(update={"reproduction": code if shows_code else ""})


def result_of(
    claim: TableClaim, prefix: str, name: str, section: str, source: str, ending: str,
    look: Callable[[], Look | None],
) -> ClaimResult:  # fmt: skip
    """Return the claim as it stands after a second look. `ending`: of its evidence, in plain
    words."""
    severity = claim.severity or ""
    verdict, evidence = look_again(claim.verdict, claim.evidence, severity, look)
    return ClaimResult(
        id=f"{prefix}/{name}/{claim.kind}",
        kind=claim.kind,
        source=name,
        section=section,
        statement=prose(f"{claim.statement} ({source})"),
        scene="",
        verdict=verdict,
        evidence=prose(evidence, ending),
        details=tuple(tuple(map(prose, row)) for row in claim.details),
        severity=severity if verdict is Verdict.REFUTED else "",
    )


def _no_look() -> None:
    return None


def separate(claims: Iterable[TableClaim]) -> Iterator[TableClaim]:
    """Leave out the claims that fail since the order does: one mistake is reported once."""
    wrong = False
    for claim in claims:
        # A wrong coefficient that costs the order breaks these conditions as well.
        follows = claim.kind in _FOLLOWING_KINDS or (
            claim.kind == "order in time" and claim.severity == Severity.WRONG_ORDER
        )
        if not (wrong and follows and claim.verdict is Verdict.REFUTED):
            yield claim
        wrong |= claim.kind == "order" and claim.verdict is Verdict.REFUTED


@singledispatch
def _claims(method: object, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    """Yield the claims of an integrator, by the kind of its method."""
    raise TypeError(f"{integrator.name}: no method is a {type(method).__name__}")


@_claims.register
def _(method: LibraryComparison, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    verdict, evidence, details = method.compare()
    sentence, severity = prose(evidence), Severity.OF_WORDS
    claim = TableClaim(method.kind, method.statement, verdict, sentence, details, severity)
    yield claim, integrator.reproduction, _no_look


@_claims.register
def _(method: PrintedTable, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    order = integrator.order
    assert order is not None  # noqa: S101 - of printed tables it is always claimed
    judgement = judge_order(method, order)
    ruling = ruling_on_order(judgement, order)
    claim = TableClaim("order", f"order {order}", *ruling, Severity.WRONG_ORDER)
    yield claim, integrator.reproduction, _no_look
    if judgement.verdict is not Verdict.REFUTED and method.printed.units:
        code = reproductions.write_digits_program(method, judgement.nearest, order)
        wording = "every digit is right, to one unit of the last"
        severity = severity_of(judgement, Severity.WRONG_ORDER) or Severity.OF_WORDS
        yield (
            TableClaim("digits", wording, *ruling_on_digits(judgement), severity),
            code,
            _no_look,
        )


@_claims.register
def _(method: FloatTable, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    for claim in separate(kinds.get(method.entry.kind).claims(method.entry)):
        if not claim.kind.endswith("digits"):  # of floats nothing is claimed of them
            yield claim, integrator.reproduction, partial(look_at_claim, method.entry, claim.kind)


@_claims.register
def _(method: ExactTableau, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    table, rounded, claimed = method.tableau, method.rounded, integrator.order
    if claimed is not None:
        order = tableau_proofs.order_of(table, claimed, rounded)
        wrong = order.order < claimed and not rounded
        repaired = tableau_proofs.repair(table, claimed) if wrong else _NO_EVIDENCE
        ruling = tableau_proofs.judge_exact_order(
            claimed, order, tableau_proofs.symplecticity(table, rounded), rounded, repaired
        )
        embedded = "embedded" in integrator.name
        severity = Severity.WRONG_WEIGHTS if embedded else Severity.WRONG_ORDER
        claim = TableClaim("order", f"order {claimed}", *ruling, severity)
        yield claim, integrator.reproduction, partial(_at_tableau, method, integrator.name, claimed)
    if integrator.area_preserving:
        area = tableau_proofs.symplecticity(table, rounded)
        verdict = {True: Verdict.PROVED, False: Verdict.REFUTED, None: Verdict.UNDECIDED}
        severity = Severity.NOT_SYMPLECTIC
        claim = TableClaim("area", _SYMPLECTIC, verdict[area.holds], area.evidence, (), severity)
        yield claim, integrator.reproduction, _no_look


def _at_tableau(method: ExactTableau, name: str, claimed: int) -> Look:
    table = method.tableau
    entry = table_integrator(
        name, "runge-kutta", "", "", order=claimed,
        a=[[str(x) for x in row] for row in table.rows], b=[str(x) for x in table.weights],
    ).method.entry  # fmt: skip
    return look_at_table(entry, "order", claimed, exact=not method.rounded)


@_claims.register
def _(method: FloatStep, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    point = (
        method.points or (POINTS if method.hamiltonian.degrees == 1 else _SYMPLECTICITY_POINTS)
    )[0]
    order, area, code = integrator.order, integrator.area_preserving, integrator.reproduction
    timed = method.hamiltonian.time_dependent
    if order is not None:
        statement = f"order {order}, too, {_IN_TIME_TEXT}" if timed else f"order {order}"
        severity = Severity.WRONG_CLOCK if timed else Severity.WRONG_ORDER
        ruling = float_step.judge_measured_order(order, float_step.finding(method), area)
        claim = TableClaim("order", statement, *ruling, severity)
        script = reproductions.write_order_program(code, point, order, timed)
        yield claim, script, partial(look_at_step, integrator, order)
    elif timed:
        claim = TableClaim(
            "in time", _UNCLAIMED_IN_TIME, *float_step.report_unclaimed(float_step.finding(method))
        )
        yield claim, reproductions.write_time_program(code, point), _no_look
    if area:
        ruling = float_step.judge_measured_area(float_step.finding(method))
        claim = TableClaim("area", _SYMPLECTIC, *ruling, Severity.NOT_SYMPLECTIC)
        yield claim, reproductions.write_area_program(code, point), _no_look


# -- tables that libraries have in their sources --------------------------------------------------


def files() -> list[Path]:
    """Return the files, one a library."""
    folder = content("reports", "audits")
    return [path for path in sorted(folder.glob("*.toml")) if path.name != _LITERATURE_FILE]


def claims_of_tables(table_file: TableFile) -> Iterator[ClaimResult]:
    """Yield the claims of a library's tables."""
    entries = {entry.name: entry for entry, _ in table_file.entries}
    for table, judged in groupby(table_file.judge(), key=lambda each: each.table):
        for claim in separate(each.claim for each in judged):
            yield _claim(table_file.title, entries[table], claim)


def _claim(title: str, entry: TableEntry, claim: TableClaim) -> ClaimResult:
    cost = f". It costs {claim.cost.sentence}" if claim.cost and claim.cost.sentence else ""
    result = result_of(
        claim, title.split()[0], entry.name, f"{title}, printed tables", entry.source,
        f"{cost}. Read in {entry.read}", partial(look_at_claim, entry, claim.kind),
    )  # fmt: skip
    refuted = result.verdict is Verdict.REFUTED
    return result.model_copy(update={"reproduction": write_clock_program(entry) if refuted else ""})
