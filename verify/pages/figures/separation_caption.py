"""What a figure of truncation against rounding says in words, all of it from the grid's data."""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction

from verify.pages.text.typography import NBSP, between, interval, number, step, whole
from verify.scenes.results.separation import WAYS, CrossoverResult, Separation, SeparationGrid

PLAIN, CLOSED_FORM = "plain", "closed_form"
_NONE = "none in this range: "  # how a crossover's reason begins where there is none


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
    crossovers = {name: getattr(grid, way) for way, name in WAYS.items()}
    found = [_crossover(each, name) for name, each in crossovers.items()]
    if len(set(crossovers.values())) == 1 and not grid.plain.step_size:
        found = [_crossover(grid.plain, "either way")]
    steps = sorted(point.steps for point in grid.points)
    count = between(whole(steps[0]), whole(steps[-1]), " … ")
    return " ".join(
        [
            "Rounding is the larger part left of its dashed line h*, where smaller steps make Λ no "
            "better; truncation is right of it."
            if any(found.step_size for found in crossovers.values())
            else "Where rounding lies below truncation, a smaller step size still helps.",
            *found,
            f"N = {count} steps.",
            computed,
        ]
    )


def _crossover(found: CrossoverResult, way: str) -> str:
    way = way[0].upper() + way[1:]
    between = ""
    if found.bracket:
        low, high = (step(end) for end in found.bracket)
        between = f"between {low} and {high}"
    if found.step_size:
        return f"{way}: h* ≈{NBSP}{short(found.step_size)}, {between}."
    reason = found.reason.removeprefix(_NONE)
    return f"{way}: {between or 'no crossover'}; {reason}."


def short(step_size: str) -> str:
    """A crossover to two digits: it is interpolated between step sizes that lie far apart."""
    return number(f"{Decimal(step_size):.1e}").replace(" ", NBSP)


def end_of(points: Sequence[Separation]) -> str:
    """`, over [t₀, t₀ + T]` where all runs end at one time."""
    lengths = {Fraction(point.step_size) * point.steps for point in points}
    if len(lengths) != 1:
        return ""
    return f", over {interval(points[0].t0, max(lengths), number)}"
