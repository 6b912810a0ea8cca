"""The caption of a figure of truncation against rounding, all of it from the grid's data."""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction

from verify.pages.text.typography import NBSP, between, interval, number, step, whole
from verify.scenes.results.separation import WAYS, CrossoverResult, Separation, SeparationGrid

PLAIN, CLOSED_FORM = "plain", "closed_form"
# The reason of a missing crossover begins so.
_NONE = "none in this range: "


def lines_of_ways(grid: SeparationGrid) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield the lines of the figure: label, and points (step size, greatest size in the run)."""
    for way, key, label in (
        (PLAIN, "truncation", "truncation"),
        (PLAIN, "total", "rounding, the plain way"),
        (CLOSED_FORM, "total", "rounding, closed form and log1p summation"),
    ):
        evaluations = ((point.step_size, getattr(point, way)) for point in grid.points)
        yield label, [(h, each.largest[key]) for h, each in evaluations if each]


def caption(grid: SeparationGrid, provenance: str) -> str:
    """Return the caption: the crossovers of each way, N, and how they were computed."""
    crossovers = {name: getattr(grid, way) for way, name in WAYS.items()}
    sentences = [_crossover(each, name) for name, each in crossovers.items()]
    # The same reason for both ways is given once.
    if len(set(crossovers.values())) == 1 and not grid.plain.step_size:
        sentences = [_crossover(grid.plain, "either way")]
    steps = sorted(point.steps for point in grid.points)
    count = between(whole(steps[0]), whole(steps[-1]), " … ")
    return " ".join(
        [
            "Rounding is the larger part left of its dashed line h*, where smaller steps make Λ no "
            "better; truncation is right of it."
            if any(sentences.step_size for sentences in crossovers.values())
            else "Where rounding lies below truncation, a smaller step size still helps.",
            *sentences,
            f"N = {count} steps.",
            provenance,
        ]
    )


def _crossover(result: CrossoverResult, way: str) -> str:
    way = way[0].upper() + way[1:]
    place = ""
    if result.bracket:
        low, high = (step(end) for end in result.bracket)
        place = f"between {low} and {high}"
    if result.step_size:
        return f"{way}: h* ≈{NBSP}{round_crossover(result.step_size)}, {place}."
    reason = result.reason.removeprefix(_NONE)
    return f"{way}: {place or 'no crossover'}; {reason}."


def round_crossover(step_size: str) -> str:
    """Return a crossover to two digits, as it is interpolated between distant step sizes."""
    return number(f"{Decimal(step_size):.1e}").replace(" ", NBSP)


def end_of(points: Sequence[Separation]) -> str:
    """Return `, over [t₀, t₀ + T]` where all runs end at one time; else ""."""
    lengths = {Fraction(point.step_size) * point.steps for point in points}
    if len(lengths) != 1:
        return ""
    return f", over {interval(points[0].t0, max(lengths), number)}"
