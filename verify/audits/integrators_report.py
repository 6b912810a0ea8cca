"""The report on the integrators of other libraries: their claims, each with its verdict.

A part is a library's own code, or a file of printed tables. With several workers each part is
judged in a process of its own.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from sympy import S

from verify.audits import libraries, library_claims
from verify.audits.library_claims import claims_of
from verify.audits.methods.float_step import FAILURES
from verify.audits.methods.integrator import ReleasedIntegrator
from verify.execution.executors import Placement, open_place
from verify.execution.provenance import provenance
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.table_file import read_tables
from verify.integrators.user_code.step import contain_effects, last_line
from verify.prose import prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.verdict import Verdict

_NOT_INSTALLED = "is not installed: pip install 'areaproof[{}]'"
TITLE = "The integrators of others, verified"


@dataclass(frozen=True)
class PartResult:
    """The claims of one part.

    `version`: that of the library, None if it is not installed, and "" for a part that needs none;
    `broken`: True if a part of it fails here.
    """

    title: str
    version: str | None
    claims: tuple[ClaimResult, ...] = ()
    left_out: tuple[tuple[str, str], ...] = ()
    broken: bool = False


def make_integrators_report(
    command: str, on_library: Callable[[str], None] = lambda _: None, workers: int = 1
) -> Report:
    """Build the report on all libraries that are installed, and on the printed tables.

    `on_library` is called with the title of each part before it is judged. `workers`: the number of
    processes; 1 means this process itself.
    """
    start = time.perf_counter()
    parts = look_at_each(workers, on_library)
    claims = [claim for part in parts for claim in part.claims]
    origin = provenance(command, start, kept=0, computed=len(claims))
    versions = {part.title: part.version for part in parts if part.version}
    return Report(
        title=TITLE,
        claims=tuple(claims),
        scenes=(),
        left_out=tuple(row for part in parts for row in part.left_out),
        preface=tuple(_preface(parts, claims)),
        provenance=origin.model_copy(update={"versions": origin.versions | versions}),
    )


def _preface(parts: Sequence[PartResult], claims: Sequence[ClaimResult]) -> Iterator[str]:
    installed = ", ".join(f"{x.title} {x.version}" for x in parts if x.version) or "none"
    yield f"Installed here: {installed}; printed tables need no library."
    missing = [x.title for x in parts if x.version is None and not x.broken]
    if missing:
        yield f"Left out, as not installed: {', '.join(missing)}."
    broken = [x.title for x in parts if x.broken]
    if broken:
        yield f"Left out, all or in part, as they fail here: {', '.join(broken)}."
    wrong = [c for c in claims if c.verdict is Verdict.REFUTED]
    counts = Counter(c.severity or "not told" for c in wrong)
    if counts:
        ordered = [x for x in (*Severity, "not told") if x in counts]
        yield (
            f"Of {len(claims)} claims {len(wrong)} are refuted: "
            + ", ".join(f"{counts[kind]} of {kind}" for kind in ordered) + "."
        )  # fmt: skip


# -- its parts ------------------------------------------------------------------------------------


def names() -> list[str]:
    """Return the names of all parts: readers of libraries, then files of tables, the longest
    first."""
    # The longest files are begun first, so that no worker is left alone with one at the end.
    files = sorted(library_claims.files(), key=lambda path: (-path.stat().st_size, path.name))
    return [*libraries.names(), *map(str, files)]


def title_of(name: str) -> str:
    """Return the title of a part."""
    return Path(name).stem if name.endswith(".toml") else str(libraries.get(name).TITLE)


def look_at(name: str) -> PartResult:
    """Judge one part. Raises what our own tables raise, and nothing of a library."""
    return _tables(Path(name)) if name.endswith(".toml") else _library(name)


def look_at_each(workers: int, on_part: Callable[[str], None]) -> list[PartResult]:
    """Judge all parts, in their order. A process that is lost is one whose library ends it."""
    every = names()
    if workers == 1:
        results = []
        for name in every:
            on_part(title_of(name))
            results.append(look_at(name))
        return results
    by_name, waiting = dict[str, PartResult](), [*every]
    running: dict[Future[PartResult], str] = {}
    with open_place(Placement(workers)) as processes:
        while waiting or running:
            while waiting and len(running) < workers:
                name = waiting.pop(0)
                on_part(title_of(name))
                running[processes.submit(look_at, name)] = name
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                name, error = running.pop(future), future.exception()
                processes.release(future)
                # A process that died did so by a library's fault, which must not end the report; an
                # exception of ours must.
                if error is not None and not processes.is_worker_loss(error):
                    raise error
                by_name[name] = _report_lost(name) if error is not None else future.result()
    return [by_name[name] for name in every]


def _report_lost(name: str) -> PartResult:
    title = title_of(name)
    return PartResult(title, None, (), ((title, "ends the process that it is looked at in"),), True)


def _tables(path: Path) -> PartResult:
    tables = read_tables(path)
    left_out = tuple((f"{tables.title}: {part}", reason) for part, reason in tables.left_out)
    return PartResult(tables.title, "", tuple(library_claims.claims_of_tables(tables)), left_out)


def _library(name: str) -> PartResult:
    module, version = libraries.get(name), libraries.installed_version(name)
    if version is None:
        reason = _NOT_INSTALLED.format(getattr(module, "EXTRA", "peers"))
        return PartResult(module.TITLE, None, (), ((module.TITLE, reason),))
    with contain_effects():
        claims, failed = _claims(module, f"{module.TITLE} {version}".strip())
    left_out = (*failed, *((f"{module.TITLE}: {part}", reason) for part, reason in module.LEFT_OUT))
    return PartResult(module.TITLE, version, tuple(claims), left_out, bool(failed))


def _claims(module: ModuleType, section: str) -> tuple[list[ClaimResult], list[tuple[str, str]]]:
    """Return the claims of one file; and what of it could not be looked at since the library fails,
    each with its error: that refutes nothing, and does not end the report."""
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
    """Yield its integrators, up to where the library fails: most fail when they are imported."""
    try:
        if module.LIBRARY is not None:
            import_module(module.LIBRARY)
        yield from module.integrators()
    except FAILURES as error:
        if module.LIBRARY is None:
            raise
        failed.append((module.TITLE, f"is installed and fails: {last_line(error)}"))


def _shears(section: str, prefix: str) -> ClaimResult:
    """Build the claim that holds of all tables at once, whatever their coefficients are."""
    conditions: Sequence[Condition] = Splitting(
        (("kick", S.One), ("drift", S.One))
    ).area_conditions()
    all_hold = all(c.holds for c in conditions)
    return ClaimResult(
        id=f"{prefix}/all/area",
        kind="area",
        source="all of them",
        section=section,
        statement=prose("kicks and drifts are symplectic, whatever their coefficients are"),
        scene="",
        verdict=Verdict.PROVED if all_hold else Verdict.UNDECIDED,
        evidence=prose(
            "every kick and every drift has determinant 1, for all a h V″ and a h T″; so "
            "every composition of them has; a wrong coefficient costs order, not area"
        ),
    )
