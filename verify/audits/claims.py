"""The claims that are made for someone else's integrator, each with its verdict and evidence."""

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import partial, singledispatch

from verify.audits import reproductions
from verify.audits.methods.integrator import (
    Comparison,
    ExactTableau,
    FloatStep,
    ReleasedIntegrator,
)
from verify.audits.methods.measured import finding
from verify.audits.methods.scripted import POINTS
from verify.audits.methods.tableau import (
    WRONG,
    Symplecticity,
    TableauOrder,
    order_of,
    repair,
    symplecticity,
)
from verify.audits.methods.tabled import FloatTable, table_integrator
from verify.audits.second.look import Look, at_claim, at_step, at_table, look_again
from verify.integrators.results import Finding
from verify.integrators.tables import kinds
from verify.integrators.tables.cost import Severity, severity_of
from verify.integrators.tables.table_claim import TableClaim
from verify.prose import Formula, Number, Prose, join_prose, prose, read_prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes.printed.sentences import Judgement, judgement_of_digits, judgement_of_order
from verify.schemes.printed.splitting_order import judge_order
from verify.schemes.printed.splitting_table import PrintedTable
from verify.verdict import Verdict

NONE = Prose()
_PLACES = ((Fraction(1, 5), Fraction(-1, 4), Fraction(3, 10), Fraction(1, 7)),)  # p, then q
_NOT_CLAIMED = "Nothing is claimed of symplecticity"
_SYMPLECTIC = "symplectic: det J ≡ 1"
_IN_TIME = "where the force depends on time"
_UNSAID = f"its order {_IN_TIME}, of which nothing is said"
_FOLLOWING = ("row sums", "symmetric", "stage order")
_ALWAYS_TOLD = ("agreement", "in time")  # with its reproduction, whatever is found
# What is claimed, its reproduction, and a second look, where there are means that share no code.
_Claim = tuple[TableClaim, str, Callable[[], Look | None]]


def claims_of(integrator: ReleasedIntegrator, section: str, prefix: str) -> Iterator[ClaimResult]:
    """Yield one claim for the order and one for symplecticity, where they are made; of a printed
    table one for the order and one for its digits. `prefix` begins the ids."""
    for claim, code, look in _claims(integrator.method, integrator):
        ending = f". Driven: {integrator.driven}"
        result = result_of(claim, prefix, integrator.name, section, integrator.source, ending, look)
        shows_code = (
            result.verdict in (Verdict.REFUTED, Verdict.UNDECIDED) or claim.kind in _ALWAYS_TOLD
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
        follows = claim.kind in _FOLLOWING or (
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
def _(method: Comparison, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    verdict, evidence, details = method.compare()
    said, severity = prose(evidence), Severity.OF_WORDS
    claim = TableClaim(method.kind, method.statement, verdict, said, details, severity)
    yield claim, integrator.reproduction, _no_look


@_claims.register
def _(method: PrintedTable, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    order = integrator.order
    assert order is not None  # noqa: S101 - of printed tables it is always claimed
    judgement = judge_order(method, order)
    said = judgement_of_order(judgement, order)
    claim = TableClaim("order", f"order {order}", *said, Severity.WRONG_ORDER)
    yield claim, integrator.reproduction, _no_look
    if judgement.verdict is not Verdict.REFUTED and method.printed.units:
        code = reproductions.write_digits_program(method, judgement.nearest, order)
        exact = "every digit is right, to one unit of the last"
        severity = severity_of(judgement, Severity.WRONG_ORDER) or Severity.OF_WORDS
        yield TableClaim("digits", exact, *judgement_of_digits(judgement), severity), code, _no_look


@_claims.register
def _(method: FloatTable, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    for claim in separate(kinds.get(method.entry.kind).claims(method.entry)):
        if not claim.kind.endswith("digits"):  # of floats nothing is claimed of them
            yield claim, integrator.reproduction, partial(at_claim, method.entry, claim.kind)


@_claims.register
def _(method: ExactTableau, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    table, rounded, claimed = method.tableau, method.rounded, integrator.order
    if claimed is not None:
        order = order_of(table, claimed, rounded)
        wrong = order.order < claimed and not rounded
        repaired = repair(table, claimed) if wrong else NONE
        said = judge_exact_order(claimed, order, symplecticity(table, rounded), rounded, repaired)
        embedded = "embedded" in integrator.name
        severity = Severity.WRONG_WEIGHTS if embedded else Severity.WRONG_ORDER
        claim = TableClaim("order", f"order {claimed}", *said, severity)
        yield claim, integrator.reproduction, partial(_at_tableau, method, integrator.name, claimed)
    if integrator.area_preserving:
        area = symplecticity(table, rounded)
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
    return at_table(entry, "order", claimed, exact=not method.rounded)


@_claims.register
def _(method: FloatStep, integrator: ReleasedIntegrator) -> Iterator[_Claim]:
    point = (method.points or (POINTS if method.exact.degrees == 1 else _PLACES))[0]
    order, area, code = integrator.order, integrator.area_preserving, integrator.reproduction
    timed = method.exact.time_dependent
    if order is not None:
        statement = f"order {order}, too, {_IN_TIME}" if timed else f"order {order}"
        severity = Severity.WRONG_CLOCK if timed else Severity.WRONG_ORDER
        said = judge_measured_order(order, finding(method), area)
        claim = TableClaim("order", statement, *said, severity)
        script = reproductions.write_order_program(code, point, order, timed)
        yield claim, script, partial(at_step, integrator, order)
    elif timed:
        claim = TableClaim("in time", _UNSAID, *report_unclaimed(finding(method)))
        yield claim, reproductions.write_time_program(code, point), _no_look
    if area:
        said = judge_measured_area(finding(method))
        claim = TableClaim("area", _SYMPLECTIC, *said, Severity.NOT_SYMPLECTIC)
        yield claim, reproductions.write_area_program(code, point), _no_look


# -- tableaux -------------------------------------------------------------------------------------


def judge_exact_order(
    claimed: int,
    tableau_order: TableauOrder,
    area: Symplecticity,
    rounded: bool,
    repaired: Prose = NONE,
) -> Judgement:
    """Judge the order of exact coefficients by proof; of floats up to their rounding."""
    of_next = prose(
        "; of ", Formula(f"h^{tableau_order.order + 1}"), ", ", Formula(tableau_order.next)
    )
    by = prose(" fails by ", Number(f"{tableau_order.residue:.3g}"))
    ends = prose(of_next, by) if tableau_order.next else NONE
    symplectic = {True: "it is symplectic", False: "it is not symplectic", None: ""}[area.holds]
    remark = prose(f". {_NOT_CLAIMED}")
    if symplectic:
        remark = prose(remark, f"; {symplectic}: ", area.evidence)
    if tableau_order.order >= claimed:
        more = f", and even order {tableau_order.order}" if tableau_order.order > claimed else ""
        text = f"order {claimed}{more} by {tableau_order.by}"
        if rounded:
            largest = f"`{tableau_order.largest:.1e}`"
            text += f", with residues up to {largest}, as its floats' rounding leaves them"
        verdict = Verdict.MEASURED if rounded else Verdict.PROVED
        return verdict, prose(read_prose(text), ends, remark), ()
    if rounded and tableau_order.residue < float(WRONG):
        reason = read_prose(
            f"its floats satisfy `{tableau_order.next}` but for `{tableau_order.residue:.2e}`, "
            "more than rounding and less than a wrong method: digits are missing"
        )
        return Verdict.UNDECIDED, reason, ()
    fails = f"`{tableau_order.next}` fails by `{tableau_order.residue:.5g}`"
    reason = read_prose(
        f"its order is {tableau_order.order}: of `h^{tableau_order.order + 1}`, {fails}"
    )
    mend = prose(". ", repaired) if repaired else NONE
    return Verdict.REFUTED, prose(reason, mend, remark), ()


# -- floats ---------------------------------------------------------------------------------------


def judge_measured_order(claimed: int, measured: Finding, area_claimed: bool | None) -> Judgement:
    """Judge a measured order against the claimed one; what is not known refutes nothing."""
    order, is_decided = measured.convergence_order, measured.order_decided
    remark = ""
    if area_claimed is None and measured.area_preserving is False:
        remark = f". {_NOT_CLAIMED}, and area is not preserved"
    notes = join_prose("", (prose(". ", _capital(note)) for note in measured.notes[:1]))
    if is_decided and (order is None or order >= claimed):
        return Verdict.MEASURED, prose(measured.reason, remark, notes), ()
    # An order below 1 would mean that no scheme is there at all. It is more likely that we drive
    # the library wrongly, so that nothing is refuted.
    if is_decided and order is not None and order < 1:
        prefix = "nothing of H's flow is seen in it, as where it is driven in a wrong way; "
        return Verdict.UNDECIDED, prose(prefix, measured.reason), ()
    if is_decided and order is not None:
        return Verdict.REFUTED, prose(measured.reason, notes), ()
    return Verdict.UNDECIDED, prose(measured.reason, notes), ()


def report_unclaimed(measured: Finding) -> Judgement:
    """Report what is measured where nothing is claimed: it refutes nothing, whatever it is."""
    verdict = Verdict.MEASURED if measured.order_decided else Verdict.UNDECIDED
    return verdict, measured.reason, ()


def _capital(note: Prose) -> Prose:
    """Return the note with a capital, where it opens with a text."""
    first, *rest = note.parts
    return prose(f"{first[0].upper()}{first[1:]}" if type(first) is str else first, *rest)


def judge_measured_area(measured: Finding) -> Judgement:
    """Refute for an area defect above the probe's own error; none that is seen is MEASURED."""
    error = "unknown" if measured.probe_error is None else f"`{measured.probe_error:.1e}`"
    if measured.area_preserving:
        return Verdict.MEASURED, read_prose(f"no area defect above the probe's error {error}"), ()
    if measured.area_preserving is False and measured.largest is not None:
        text = f"|det J − 1| is up to `{measured.largest:.3g}`, where the probe's error is {error}"
        return Verdict.REFUTED, prose(read_prose(text), "; ", measured.reason), ()
    return Verdict.UNDECIDED, measured.reason, ()
