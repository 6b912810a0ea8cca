"""The integrators of others → a Report: what each claims, held against what is found."""

import time
from collections.abc import Callable, Sequence
from typing import Any

from sympy import S

from verify import others
from verify.conditions import Condition
from verify.keeping import machine, versions
from verify.proof.splitting_conditions import Splitting
from verify.results import ClaimResult
from verify.scene_results import Provenance, Report
from verify.subject_claims import claims_of
from verify.verdict import Verdict

TITLE = "The integrators of others, verified"
_Told = Callable[[str], None]


def make_integrators_report(command: str, told: _Told | None = None) -> Report:
    """The report of all libraries that are installed, and of the printed tables.

    `told` is called with what each library is called before it is looked at.
    """
    begun = time.perf_counter()
    claims: list[ClaimResult] = []
    left_out: list[tuple[str, str]] = []
    found: dict[str, str] = {}
    missing: list[str] = []
    for name in others.names():
        module, version = others.get(name), others.installed(name)
        if version is None:
            missing.append(module.TITLE)
            left_out.append((module.TITLE, "is not installed: pip install 'areaproof[peers]'"))
            continue
        if told is not None:
            told(module.TITLE)
        if module.LIBRARY is not None:
            found[module.TITLE] = version
        section = f"{module.TITLE} {version}".strip()
        claims += _claims(module, section)
        left_out += [(f"{module.TITLE}: {what}", why) for what, why in module.LEFT_OUT]
    return Report(
        title=TITLE,
        claims=tuple(claims),
        scenes=(),
        left_out=tuple(left_out),
        preface=tuple(_preface(found, missing, claims)),
        provenance=Provenance(
            command=command,
            versions=versions() | found,
            machine=machine(),
            seconds=time.perf_counter() - begun,
            kept=0,
            computed=len(claims),
        ),
    )


def _claims(module: Any, section: str) -> list[ClaimResult]:
    prefix = str(module.TITLE).replace(" ", "-")
    claims: list[ClaimResult] = []
    for subject in module.subjects():
        claims += claims_of(subject, section, prefix)
    if module.LIBRARY is None:
        claims.append(_shears(section, prefix))
    return claims


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
        statement="kicks and drifts are symplectic, whatever their coefficients are",
        scene="",
        verdict=Verdict.PROVED if proved else Verdict.UNDECIDED,
        evidence="every kick and every drift has determinant 1, for all a h V″ and a h T″; so "
        "every composition of them has; a wrong coefficient costs order, not area",
    )


def _preface(
    found: dict[str, str], missing: Sequence[str], claims: Sequence[ClaimResult]
) -> list[str]:
    installed = ", ".join(f"{name} {version}" for name, version in found.items()) or "none"
    lines = [f"Installed here: {installed}; printed tables need no library."]
    if missing:
        lines.append(f"Left out, as not installed: {', '.join(missing)}.")
    wrong = [c for c in claims if c.verdict is Verdict.REFUTED]
    sections = dict.fromkeys(c.section for c in wrong)
    told = []
    for section in sections:
        own = [c for c in wrong if c.section == section]
        digits = sum(c.kind == "digits" for c in own)
        names = [c.source for c in own if c.kind != "digits"]
        if digits:
            names.append(f"the last digits of {digits} tables")
        told.append(f"{section}: {', '.join(names)}")
    if told:
        lines.append(f"Not as claimed: {'; '.join(told)}.")
    return lines
