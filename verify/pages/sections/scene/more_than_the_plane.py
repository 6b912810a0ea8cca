"""The defect S of the symplectic form in n degrees of freedom, compared with det J − 1.

S has n(2n − 1) entries and det J is one number: at its lowest order det J − 1 is the sum of n of
them. Along a run W = Σ MᵀSM grows with the tangent map M, and Λ = Π det J − 1 does not.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from verify.pages.figures.captioned_plot import known_digits
from verify.pages.sections.section import ReportSection
from verify.pages.sections.table_rows import Group, TableRow
from verify.pages.text import legend
from verify.pages.text.typography import (
    count_noun,
    join_and,
    number,
    power_of_h,
    start,
    step,
    whole,
)
from verify.scenes.results.report import SceneResult
from verify.scenes.results.work_precision import WorkLine, WorkPoint, WorkPrecisionResult
from verify.structures import SYMPLECTIC


@dataclass(frozen=True)
class BeyondView:
    """Sentences, and a table of the runs by scheme."""

    finding: tuple[str, ...]
    groups: tuple[Group, ...]
    caption: str


def _view(scene: SceneResult, _: str) -> BeyondView | None:
    result = scene.work_precision
    if result is None or result.structure is not SYMPLECTIC:
        return None
    schemes = [line for line in result.lines if not line.peer]
    caption = f"float64 runs to T = {number(result.time)} from {start(result)}"
    groups = tuple(
        Group(line.name, list(map(_row, line.points)), _describe_proof(line)) for line in schemes
    )
    sentences = (*_compare_orders(scene), *_finding(result, schemes))
    return BeyondView(sentences, groups, caption)


def _describe_proof(line: WorkLine) -> str:
    return "S ≡ 0 is proved" if line.area_preserving else ""


def _row(point: WorkPoint) -> TableRow:
    label, steps = step(point.step_size or ""), whole(point.steps or 0)
    if point.limited_by == "failed":
        return TableRow(label, (steps,), f"failed: {point.reason}")
    values = (point.error, point.energy, point.symplectic_defect, point.lam)
    seconds = "–" if point.seconds_median is None else number(f"{point.seconds_median:.2e}")
    return TableRow(label, (steps, *map(known_digits, values), seconds))


# -- sentences ------------------------------------------------------------------------------------


def _compare_orders(scene: SceneResult) -> Iterator[str]:
    """Yield a sentence on each scheme whose det J − 1 begins with a higher power of h than S."""
    for proof in scene.proofs:
        form = proof.form
        if form is None or form.volume_order is None or proof.order is None:
            continue
        if form.volume_order > proof.order:
            yield (
                f"S of {proof.scheme_title} begins with {power_of_h(proof.order)} and det J − 1 "
                f"with {power_of_h(form.volume_order)}: by det J alone it would seem to be "
                f"{count_noun(form.volume_order - proof.order, 'order')} better than it is."
            )


def _finding(result: WorkPrecisionResult, schemes: list[WorkLine]) -> Iterator[str]:
    symplectic = [line.name for line in schemes if line.area_preserving]
    if symplectic:
        yield (
            f"{join_and(symplectic)}: every step is symplectic, S ≡ 0, by proof; so are all N of "
            "them."
        )
    other_lines = [line for line in schemes if not line.area_preserving]
    pairs = [
        (line, point) for line in other_lines for point in line.points if _can_be_compared(point)
    ]
    if not pairs:
        return
    line, point = max(pairs, key=lambda pair: _ratio_of_defects(pair[1]))
    yield (
        f"What det J alone would have said: of {line.name} at h = {step(point.step_size or '')} "
        f"that {whole(point.steps or 0)} steps change volume by Λ = {_few(point.lam)}, while "
        f"the symplectic form is off by max |W| = {_few(point.symplectic_defect)}, "
        f"{number(f'{_ratio_of_defects(point):.1e}')} times as much."
    )
    yield (
        "det J is one number where S has n(2n − 1) entries, and says nothing of how errors of the "
        "form are carried on: W grows with the tangent map, as Mᵀ S M, Λ does not."
    )
    off_orbit = [p.name for p in other_lines if any(_is_beyond_orbit(x, result) for x in p.points)]
    if off_orbit:
        yield (
            f"Of {join_and(off_orbit)} some solutions are farther off than the orbit is wide: "
            "there no scheme follows this orbit, and the energy and the form are what is left to "
            "compare."
        )


def _can_be_compared(point: WorkPoint) -> bool:
    defects = point.lam, point.symplectic_defect
    return all(x is not None and Fraction(x.value) for x in defects)


def _ratio_of_defects(point: WorkPoint) -> float:
    lam, form = point.lam, point.symplectic_defect
    return abs(float(form.value) / float(lam.value)) if lam and form else 0.0


def _is_beyond_orbit(point: WorkPoint, result: WorkPrecisionResult) -> bool:
    return point.error is not None and Fraction(point.error.value) > Fraction(result.scale)


def _few(value: object) -> str:
    return str(known_digits(value))  # type: ignore[arg-type]


SECTION = ReportSection(
    order=9,
    title="More than the plane",
    anchor="beyond",
    view=_view,
    terms=lambda _: legend.terms_of("form"),
)
