"""What the points of error against run time say: orders, and schemes compared at equal run time.

Order: the least-squares slope of lg error over lg h, over the points that truncation limits, from
the smallest step up to where the slopes between neighbours leave that of the two smallest by more
than `SETTLED`: beyond, the leading term is not yet the error.

Equal run time: between two of its points a scheme is followed along the straight line on
logarithmic axes, over the run times that both schemes cover.

A run whose error is larger than the orbit itself takes no part in either: it says nothing of how
good the scheme is.
"""

from collections.abc import Iterable, Sequence
from decimal import Decimal
from itertools import combinations, pairwise

from verify.arithmetic.arb import slope
from verify.prose import read_prose
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import (
    ComparisonResult,
    CostResult,
    RatioResult,
    SlopeResult,
    WorkLine,
    WorkPoint,
)
from verify.schemes.scheme import Scheme
from verify.structures import AREA, SYMPLECTIC, Structure

SETTLED = 0.1
ALIKE = 1.1  # a ratio within this both ways is within what run times are known to
FEWEST = 3  # points of a slope
_ANY = "Infinity"  # the size of an orbit that no error is too large for
_NOTHING = SlopeResult(value=None, standard_error=None, points=0, reason="not of a peer")
_PHRASES = {  # of what is kept, of two that keep it, and of one
    AREA: ("In area", "preserve area exactly", "In area {} makes no error"),
    SYMPLECTIC: ("Of the symplectic form", "are symplectic", "{} is symplectic"),
}
Place = tuple[float, float]  # lg of one quantity and of another


def line(
    points: Sequence[WorkPoint],
    scheme: Scheme | str,
    preserves_area: bool | None,
    cost: CostResult | None,
    compile_seconds: float,
    scale: str = _ANY,
    structure: Structure = AREA,
) -> WorkLine:
    """A scheme's line, or with only a name a peer's; `scale` is the orbit's size."""
    peer = isinstance(scheme, str)
    return WorkLine(
        name=points[0].scheme,
        peer=peer,
        order=None if isinstance(scheme, str) else scheme.order,
        area_preserving=bool(preserves_area),
        error_slope=_NOTHING if peer else error_slope(points, scale),
        lambda_slope=_NOTHING
        if peer
        else lambda_slope(points, bool(preserves_area), scale, structure),
        cost=cost,
        compile_seconds=compile_seconds,
        points=tuple(points),
    )


# -- orders ---------------------------------------------------------------------------------------


def error_slope(points: Sequence[WorkPoint], scale: str = _ANY) -> SlopeResult:
    """The order of the error in h; `scale` is the orbit's size."""
    limited = [x for x in points if x.limited_by == "truncation"]
    return _order_within_orbit(limited, [(x, x.error) for x in within_orbit(limited, scale)])


def lambda_slope(
    points: Sequence[WorkPoint],
    preserves_area: bool,
    scale: str = _ANY,
    structure: Structure = AREA,
) -> SlopeResult:
    """The order of |Λ| in h; in n degrees of freedom that of max |W|."""
    if preserves_area:
        why = f"{structure.identity} is proved: {structure.accumulated} is exactly 0"
        return SlopeResult(value=None, standard_error=None, points=0, reason=why)
    limited = [x for x in points if x.lambda_limited_by == "truncation"]
    return _order_within_orbit(limited, [(x, x.area_error) for x in within_orbit(limited, scale)])


def _order_within_orbit(
    limited: Sequence[WorkPoint], found: Sequence[tuple[WorkPoint, Value | None]]
) -> SlopeResult:
    """The order over those that are near; it says how many are not."""
    slope, far = fitted(found), len(limited) - len(found)
    if not far:
        return slope
    reason = f"{slope.reason}; " if slope.reason else ""
    reason += f"with {far} more the error is larger than the orbit"
    return slope.model_copy(update={"reason": reason})


def within_orbit(points: Iterable[WorkPoint], scale: str) -> list[WorkPoint]:
    """The runs whose error is not larger than the orbit."""
    return [x for x in points if x.error and Decimal(x.error.value) <= Decimal(scale)]


def fitted(found: Sequence[tuple[WorkPoint, Value | None]]) -> SlopeResult:
    places = sorted(
        (lg(point.step_size), lg(value.value))
        for point, value in found
        if point.step_size and value and Decimal(value.value)
    )
    settled = _settled(places)
    if len(settled) < FEWEST:
        count = len(places)
        few = f"{count} point{' is' if count == 1 else 's are'} limited by truncation"
        if len(places) >= FEWEST:
            few += f", and the slopes of only the {len(settled)} smallest have settled"
        return SlopeResult(value=None, standard_error=None, points=len(settled), reason=few)
    value, error = slope(settled)
    reason = ""
    if len(settled) < len(places):
        reason = f"of {len(places)}: at larger h it has not settled"
    return SlopeResult(
        value=f"{value:.3f}", standard_error=f"{error:.3f}", points=len(settled), reason=reason
    )


def _settled(places: Sequence[Place]) -> list[Place]:
    """From the smallest step as far as neighbours have the slope of the first two."""
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(places)]
    count = next((k for k, s in enumerate(slopes) if abs(s - slopes[0]) > SETTLED), len(slopes))
    return list(places[: count + 1])


def lg(text: str) -> float:
    """lg |x| of a decimal or a quotient that is not 0, however small."""
    above, _, below = text.partition("/")
    return float(abs(Decimal(above)).log10() - abs(Decimal(below or 1)).log10())


# -- at equal run time ----------------------------------------------------------------------------


def comparisons(
    lines: Sequence[WorkLine], scale: str, structure: Structure = AREA
) -> tuple[ComparisonResult, ...]:
    """Every two schemes that claim the same order; `scale` is the orbit's size."""
    pairs = combinations([line for line in lines if not line.peer], 2)
    return tuple(compare(a, b, scale, structure) for a, b in pairs if a.order == b.order)


def compare(
    one: WorkLine, other: WorkLine, scale: str, structure: Structure = AREA
) -> ComparisonResult:
    """The two at equal run time; see the module's text."""
    errors = _places(one, "error", scale), _places(other, "error", scale)
    span = _overlap(errors)
    seconds = first = last = error = area = None
    if span is None:
        said = f"{_called(one)} and {_called(other)} have no run time in common: "
        said += "nothing is compared."
    else:
        seconds, first, last = (_few(10**x) for x in (sum(span) / 2, *span))
        error = _ratio(*errors, span)
        if not (one.area_preserving or other.area_preserving):
            areas = _places(one, "area_error", scale), _places(other, "area_error", scale)
            shared = _overlap(areas)
            area = _ratio(*areas, shared) if shared else None
        times = f"`{first}` to `{last}` s"
        smaller = _smaller(_called(one), _called(other), error, times)
        said = f"At equal run time (`{seconds}` s) the solution error of {smaller}. "
        said += _kept_sentence(one, other, area, scale, structure)
    return ComparisonResult(
        one=one.name,
        other=other.name,
        seconds=seconds,
        first=first,
        last=last,
        error=error,
        area=area,
        sentence=read_prose(said),
    )


def _places(line: WorkLine, quantity: str, scale: str) -> list[Place]:
    """(lg run time, lg quantity) by run time."""
    found = []
    for point in within_orbit(line.points, scale):
        value: Value | None = getattr(point, quantity)
        if value and Decimal(value.value) and point.seconds_median:
            found.append((lg(repr(point.seconds_median)), lg(value.value)))
    return sorted(found)


def _overlap(both: Sequence[list[Place]]) -> Place | None:
    if not all(both):
        return None
    first, last = max(each[0][0] for each in both), min(each[-1][0] for each in both)
    return (first, last) if first < last else None


def _ratio(one: list[Place], other: list[Place], span: Place) -> RatioResult:
    """other / one at the middle, and at every point of either and both ends of the span."""
    times = {*span, *(x for x, _ in (*one, *other) if span[0] <= x <= span[1])}
    ratios = [10 ** (_at(other, x) - _at(one, x)) for x in times]
    middle = sum(span) / 2
    at = 10 ** (_at(other, middle) - _at(one, middle))
    return RatioResult(at=_few(at), least=_few(min(ratios)), most=_few(max(ratios)))


def _at(places: list[Place], x: float) -> float:
    """On the line through the points, between two of them."""
    for (x0, y0), (x1, y1) in pairwise(places):
        if x0 <= x <= x1 and x1 > x0:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return places[0][1] if x <= places[0][0] else places[-1][1]


def _called(line: WorkLine) -> str:
    """Its name, quoted where that is the formulas of a user's scheme."""
    return f"`{line.name}`" if "=" in line.name else line.name


def _kept_sentence(
    one: WorkLine, other: WorkLine, ratio: RatioResult | None, scale: str, structure: Structure
) -> str:
    """How they compare in what a step is to keep."""
    of, both, keeps = _PHRASES[structure]
    exact = [_called(line) for line in (one, other) if line.area_preserving]
    if len(exact) == 2:
        return f"Both {both}: {exact[0]} and {exact[1]} have {structure.identity} by proof."
    if exact:
        rest, kept = (one, other) if other.area_preserving else (other, one)
        errors = _sizes(x.area_error for x in within_orbit(rest.points, scale))
        rounded = _sizes(x.lam_plain for x in within_orbit(kept.points, scale))
        seen = f", where {_called(rest)} has {structure.size} of {_span(errors)}" if errors else ""
        shown = f"; what float64’s rounding shows of it is {_span(rounded)}" if rounded else ""
        return f"{keeps.format(exact[0])} ({structure.identity} is proved){seen}{shown}."
    if ratio is None:
        return f"{of} there is nothing to compare."
    return f"{of}, {structure.size} of {_smaller(_called(one), _called(other), ratio, '')}."


def _sizes(values: Iterable[Value | None]) -> list[float]:
    return sorted(abs(float(value.value)) for value in values if value)


def _span(sizes: Sequence[float]) -> str:
    low, high = f"`{_few(sizes[0])}`", f"`{_few(sizes[-1])}`"
    return low if low == high else f"{low} to {high}"


def _smaller(one: str, other: str, ratio: RatioResult, times: str) -> str:
    """`x is 3.2 times smaller than that of y`, with its range."""
    at, least, most = (float(x) for x in (ratio.at, ratio.least, ratio.most))
    if at < 1:
        one, other = other, one
        at, least, most = 1 / at, 1 / most, 1 / least
    over = f" over {times}" if times else ""
    if most <= ALIKE and least >= 1 / ALIKE:
        return f"{one} is that of {other} (both within {ALIKE - 1:.0%} of each other{over})"
    said = f"{one} is `{_few(at)}` times smaller than that of {other}"
    if least >= 1:
        return f"{said} (`{_few(least)}` to `{_few(most)}` times{over})"
    return (
        f"{said}, but which of the two is smaller changes{over} "
        f"(`{_few(most)}` times smaller to `{_few(1 / least)}` times larger)"
    )


def _few(x: float) -> str:
    """Two significant digits."""
    return f"{float(f'{x:.2g}'):g}"
