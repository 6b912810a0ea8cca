"""The integrators of others → a Report: what each claims, held against what is found."""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from types import ModuleType

from sympy import S

from verify.algebra.conditions import Condition
from verify.execution.provenance import provenance
from verify.integrators.others import libraries as others
from verify.integrators.others import printed_libraries
from verify.integrators.others.claims import claims_of
from verify.integrators.others.integrator import ReleasedIntegrator
from verify.integrators.others.measured import FAILURES
from verify.integrators.step import last_line, quiet
from verify.integrators.tables.check import read_tables
from verify.prose import prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report
from verify.schemes.splitting_conditions import Splitting
from verify.verdict import Verdict

TITLE = "The integrators of others, verified"
_OnLibrary = Callable[[str], None]


def make_integrators_report(command: str, on_library: _OnLibrary | None = None) -> Report:
    """The report of all libraries that are installed, and of the printed tables.

    `on_library` is called with what each library is called before it is looked at.
    """
    begun = time.perf_counter()
    claims: list[ClaimResult] = []
    left_out: list[tuple[str, str]] = []
    found: dict[str, str] = {}
    missing: list[str] = []
    broken: list[str] = []
    for name in others.names():
        module, version = others.get(name), others.installed(name)
        if version is None:
            missing.append(module.TITLE)
            left_out.append((module.TITLE, "is not installed: pip install 'areaproof[peers]'"))
            continue
        if on_library is not None:
            on_library(module.TITLE)
        if module.LIBRARY is not None:
            found[module.TITLE] = version
        section = f"{module.TITLE} {version}".strip()
        with quiet():
            own, failed = _claims(module, section)
        claims += own
        broken += [module.TITLE] if failed else []
        left_out += [*failed, *((f"{module.TITLE}: {what}", why) for what, why in module.LEFT_OUT)]
    for path in printed_libraries.files():
        tables = read_tables(path)
        if on_library is not None:
            on_library(f"{tables.title}, printed tables")
        claims += printed_libraries.claims_of(tables)
        left_out += [(f"{tables.title}: {what}", why) for what, why in tables.left_out]
    told = provenance(command, begun, kept=0, computed=len(claims))
    return Report(
        title=TITLE,
        claims=tuple(claims),
        scenes=(),
        left_out=tuple(left_out),
        preface=tuple(_preface(found, missing, broken, claims)),
        provenance=told.model_copy(update={"versions": told.versions | found}),
    )


def _claims(module: ModuleType, section: str) -> tuple[list[ClaimResult], list[tuple[str, str]]]:
    """The claims of one file; and what of it could not be looked at since the library fails, each
    with its error: that refutes nothing, and does not end the report."""
    prefix = str(module.TITLE).replace(" ", "-")
    failed: list[tuple[str, str]] = []
    claims: list[ClaimResult] = []
    for integrator in _integrators(module, failed):
        try:
            claims += claims_of(integrator, section, prefix)
        except FAILURES as error:
            if module.LIBRARY is None:
                raise  # no one else's code was run: it is ours that is wrong
            failed.append((f"{module.TITLE}: {integrator.name}", f"fails: {last_line(error)}"))
    if module.LIBRARY is None:
        claims.append(_shears(section, prefix))
    return claims, failed


def _integrators(module: ModuleType, failed: list[tuple[str, str]]) -> Iterator[ReleasedIntegrator]:
    """Its integrators, up to where the library fails: most fail when they are imported."""
    try:
        if module.LIBRARY is not None:
            import_module(module.LIBRARY)
        yield from module.integrators()
    except FAILURES as error:
        if module.LIBRARY is None:
            raise
        failed.append((module.TITLE, f"is installed and fails: {last_line(error)}"))


def _shears(section: str, prefix: str) -> ClaimResult:
    """What holds of all tables at once, whatever their coefficients are."""
    conditions: Sequence[Condition] = Splitting(
        (("kick", S.One), ("drift", S.One))
    ).area_conditions()
    proved = all(c.holds for c in conditions)
    return ClaimResult(
        id=f"{prefix}/all/area",
        kind="area",
        source="all of them",
        section=section,
        statement=prose("kicks and drifts are symplectic, whatever their coefficients are"),
        scene="",
        verdict=Verdict.PROVED if proved else Verdict.UNDECIDED,
        evidence=prose(
            "every kick and every drift has determinant 1, for all a h V″ and a h T″; so "
            "every composition of them has; a wrong coefficient costs order, not area"
        ),
    )


def _preface(
    found: dict[str, str],
    missing: Sequence[str],
    broken: Sequence[str],
    claims: Sequence[ClaimResult],
) -> list[str]:
    installed = ", ".join(f"{name} {version}" for name, version in found.items()) or "none"
    lines = [f"Installed here: {installed}; printed tables need no library."]
    if missing:
        lines.append(f"Left out, as not installed: {', '.join(missing)}.")
    if broken:
        lines.append(f"Left out, all or in part, as they fail here: {', '.join(broken)}.")
    wrong = [c for c in claims if c.verdict is Verdict.REFUTED]
    sections = dict.fromkeys(c.section for c in wrong)
    unlike_claims = []
    for section in sections:
        own = [c for c in wrong if c.section == section]
        digits = sum(c.kind.endswith("digits") for c in own)
        names = list(dict.fromkeys(c.source for c in own if not c.kind.endswith("digits")))
        if digits:
            names.append(f"the last digits of {digits} tables")
        unlike_claims.append(f"{section}: {', '.join(names)}")
    if unlike_claims:
        lines.append(f"Not as claimed: {'; '.join(unlike_claims)}.")
    counts = Counter(c.severity or "not told" for c in wrong)
    if counts:
        each = ", ".join(f"{n} of {kind}" for kind, n in counts.most_common())
        lines.append(f"Of {len(wrong)} that are refuted: {each}.")
    return lines
