"""The integrators of others → a Report: what each claims, held against what is found."""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

from verify.execution.provenance import provenance
from verify.integrators.others.parts import Found, look_at_each
from verify.integrators.tables.cost import Severity
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report
from verify.verdict import Verdict

TITLE = "The integrators of others, verified"


def make_integrators_report(
    command: str, on_library: Callable[[str], None] = lambda _: None, workers: int = 1
) -> Report:
    """The report of all libraries that are installed, and of the printed tables.

    `on_library` is called with what each part is called before it is looked at. `workers`:
    processes; with one, all is looked at here.
    """
    begun = time.perf_counter()
    parts = look_at_each(workers, on_library)
    claims = [claim for part in parts for claim in part.claims]
    told = provenance(command, begun, kept=0, computed=len(claims))
    versions = {part.title: part.version for part in parts if part.version}
    return Report(
        title=TITLE,
        claims=tuple(claims),
        scenes=(),
        left_out=tuple(row for part in parts for row in part.left_out),
        preface=tuple(_preface(parts, claims)),
        provenance=told.model_copy(update={"versions": told.versions | versions}),
    )


def _preface(parts: Sequence[Found], claims: Sequence[ClaimResult]) -> Iterator[str]:
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
