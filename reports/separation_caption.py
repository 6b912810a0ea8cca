"""What a figure of truncation against rounding says in words, all of it from the grid's data."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from reports.typography import number, whole
from verify.exact import text
from verify.results import CrossoverResult, SeparationGrid, SeparationResult

PLAIN, CLOSED_FORM = "plain", "closed_form"
WAYS = {PLAIN: "the plain way", CLOSED_FORM: "closed form"}


def ways_of(grid: SeparationGrid) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Each line of the figure: its label, and (step size, greatest size along the run)."""
    for way, key, label in (
        (PLAIN, "truncation", "truncation"),
        (PLAIN, "total", "rounding, the plain way"),
        (CLOSED_FORM, "total", "rounding, closed form and log1p summation"),
    ):
        held = ((point.step_size, getattr(point, way)) for point in grid.points)
        yield label, [(h, each.largest[key]) for h, each in held if each]


def caption(grid: SeparationGrid, computed: str) -> str:
    """Where rounding overtakes truncation, each way; N; how it was computed."""
    found = [_crossover(getattr(grid, way), name) for way, name in WAYS.items()]
    steps = sorted(point.steps for point in grid.points)
    count = whole(steps[0]) if steps[0] == steps[-1] else f"{whole(steps[0])} … {whole(steps[-1])}"
    return " ".join(
        [
            "Left of a dashed line h* rounding is the greater, right of it truncation: below h* "
            "smaller steps make Λ no better."
            if any(getattr(grid, way).step_size for way in WAYS)
            else "Where a line of rounding lies below that of truncation, smaller steps still help.",
            *found,
            f"N = {count} steps.",
            computed,
        ]
    )


def _crossover(found: CrossoverResult, way: str) -> str:
    way = way[0].upper() + way[1:]
    between = ""
    if found.bracket:
        low, high = (number(end) for end in found.bracket)
        between = f"between {low} and {high}"
    if found.step_size:
        return f"{way}: h* ≈ {number(found.step_size)}, {between}."
    return f"{way}: {between}{': ' if between else 'no crossover, '}{found.reason}."


def end_of(points: Sequence[SeparationResult]) -> str:
    """`, t from 0 to T` where all runs end at one time."""
    ends = {Fraction(point.step_size) * point.steps for point in points}
    return f", over [0, {number(text(max(ends)))}]" if len(ends) == 1 else ""
