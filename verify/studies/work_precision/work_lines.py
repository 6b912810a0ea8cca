"""Orders and comparisons at equal run time, from the points of error against run time.

Order: the least-squares slope of lg error over lg h, over points that truncation limits: those from
the smallest step size up to the first at which the slope between neighbours differs from that of
the two smallest by more than `SETTLED`. Beyond it the error is not yet the leading term.

Equal run time: between two of its points a scheme's error is interpolated by a straight line on
logarithmic axes, over the run times that both schemes cover.

A run whose error is larger than the orbit itself takes no part in either: it tells nothing of the
scheme's quality.
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
from verify.structures import AREA, SYMPLECTIC, CanonicalForm

SETTLED = 0.1  # the greatest difference of slopes in the asymptotic range
ALIKE = 1.1  # a ratio between 1/ALIKE and this is within the error of run times
FEWEST = 3  # the least number of points of a slope
_NO_LIMIT = "Infinity"  # an orbit's size; no error is larger
_NO_SLOPE = SlopeResult(value=None, standard_error=None, points=0, reason="not of a peer")
_PHRASES = {  # for: the structure; two schemes that keep it; one that does
    AREA: ("In area", "preserve area exactly", "In area {} makes no error"),
    SYMPLECTIC: ("Of the symplectic form", "are symplectic", "{} is symplectic"),
}
LogPoint = tuple[float, float]  # lg of a quantity and of another; sorted by the first


def build_line(
    points: Sequence[WorkPoint],
    scheme: Scheme | str,
    preserves_area: bool | None,
    cost: CostResult | None,
    compile_seconds: float,
    scale: str = _NO_LIMIT,
    structure: CanonicalForm = AREA,
) -> WorkLine:
    """Build a scheme's line, or a peer's if `scheme` is a name; `scale` is the orbit's size."""
    peer, keeps_area = isinstance(scheme, str), bool(preserves_area)
    return WorkLine(
        name=points[0].scheme,
        peer=peer,
        order=None if isinstance(scheme, str) else scheme.order,
        area_preserving=keeps_area,
        error_slope=_NO_SLOPE if peer else error_slope(points, scale),
        lambda_slope=_NO_SLOPE if peer else lambda_slope(points, keeps_area, scale, structure),
        cost=cost,
        compile_seconds=compile_seconds,
        points=tuple(points),
    )


# -- orders ---------------------------------------------------------------------------------------


def error_slope(points: Sequence[WorkPoint], scale: str = _NO_LIMIT) -> SlopeResult:
    """Fit the order of the error in h; `scale` is the orbit's size."""
    limited_points = [x for x in points if x.limited_by == "truncation"]
    return _order_within_orbit(
        limited_points, [(x, x.error) for x in select_within_orbit(limited_points, scale)]
    )


def lambda_slope(
    points: Sequence[WorkPoint],
    preserves_area: bool,
    scale: str = _NO_LIMIT,
    structure: CanonicalForm = AREA,
) -> SlopeResult:
    """Fit the order of |Λ| in h; in n degrees of freedom that of max |W|."""
    if preserves_area:
        reason = f"{structure.identity} is proved: {structure.accumulated} is exactly 0"
        return SlopeResult(value=None, standard_error=None, points=0, reason=reason)
    limited_points = [x for x in points if x.lambda_limited_by == "truncation"]
    return _order_within_orbit(
        limited_points, [(x, x.area_error) for x in select_within_orbit(limited_points, scale)]
    )


def _order_within_orbit(
    limited_points: Sequence[WorkPoint], points: Sequence[tuple[WorkPoint, Value | None]]
) -> SlopeResult:
    """Fit the order over `points`, those within the orbit; the reason counts the others."""
    slope, outside = fit_slope(points), len(limited_points) - len(points)
    if not outside:
        return slope
    reason = f"{slope.reason}; " if slope.reason else ""
    reason += f"with {outside} more the error is larger than the orbit"
    return slope.model_copy(update={"reason": reason})


def select_within_orbit(points: Iterable[WorkPoint], scale: str) -> list[WorkPoint]:
    """Select the runs whose error is not larger than the orbit."""
    return [x for x in points if x.error and Decimal(x.error.value) <= Decimal(scale)]


def fit_slope(points: Sequence[tuple[WorkPoint, Value | None]]) -> SlopeResult:
    """Fit the slope of lg of the values over lg h, over the smallest steps; see the module."""
    # Sorted by lg h, so that the smallest steps, where the leading term rules, come first.
    log_points = sorted(
        (log10_of(point.step_size), log10_of(value.value))
        for point, value in points
        if point.step_size and value and Decimal(value.value)
    )
    asymptotic = _select_asymptotic(log_points)
    if len(asymptotic) < FEWEST:
        count = len(log_points)
        few = f"{count} point{' is' if count == 1 else 's are'} limited by truncation"
        if len(log_points) >= FEWEST:
            few += f", and the slopes of only the {len(asymptotic)} smallest have settled"
        return SlopeResult(value=None, standard_error=None, points=len(asymptotic), reason=few)
    value, error = slope(asymptotic)
    reason = ""
    if len(asymptotic) < len(log_points):
        reason = f"of {len(log_points)}: at larger h it has not settled"
    return SlopeResult(
        value=f"{value:.3f}", standard_error=f"{error:.3f}", points=len(asymptotic), reason=reason
    )


def _select_asymptotic(log_points: Sequence[LogPoint]) -> list[LogPoint]:
    """Select the points up to the first neighbours' slope that differs from that of the first two.

    The points are sorted by step size.
    """
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(log_points)]
    count = next((k for k, s in enumerate(slopes) if abs(s - slopes[0]) > SETTLED), len(slopes))
    return list(log_points[: count + 1])


def log10_of(text: str) -> float:
    """Return lg |x| of a decimal or a quotient that is not 0, however small."""
    above, _, below = text.partition("/")
    return float(abs(Decimal(above)).log10() - abs(Decimal(below or 1)).log10())


# -- at equal run time ----------------------------------------------------------------------------


def compare_all(
    lines: Sequence[WorkLine], scale: str, structure: CanonicalForm = AREA
) -> tuple[ComparisonResult, ...]:
    """Compare every two schemes that claim the same order; `scale` is the orbit's size."""
    pairs = combinations([line for line in lines if not line.peer], 2)
    return tuple(compare_lines(a, b, scale, structure) for a, b in pairs if a.order == b.order)


def compare_lines(
    line: WorkLine, other_line: WorkLine, scale: str, structure: CanonicalForm = AREA
) -> ComparisonResult:
    """Compare two lines at equal run time; see the module's text."""
    errors = _log_points(line, "error", scale), _log_points(other_line, "error", scale)
    span = _overlap(errors)
    seconds = first = last = error = area = None
    if span is None:
        sentence = (
            f"{_quoted_name(line)} and {_quoted_name(other_line)} have no run time in common: "
        )
        sentence += "nothing is compared."
    else:
        seconds, first, last = (_two_digits(10**x) for x in (sum(span) / 2, *span))
        error = _compute_ratio(*errors, span)
        if not (line.area_preserving or other_line.area_preserving):
            areas = (
                _log_points(line, "area_error", scale),
                _log_points(other_line, "area_error", scale),
            )
            common_span = _overlap(areas)
            area = _compute_ratio(*areas, common_span) if common_span else None
        times = f"`{first}` to `{last}` s"
        smaller = _describe_smaller(_quoted_name(line), _quoted_name(other_line), error, times)
        sentence = f"At equal run time (`{seconds}` s) the solution error of {smaller}. "
        sentence += _describe_structure(line, other_line, area, scale, structure)
    return ComparisonResult(
        one=line.name,
        other=other_line.name,
        seconds=seconds,
        first=first,
        last=last,
        error=error,
        area=area,
        sentence=read_prose(sentence),
    )


def _log_points(line: WorkLine, quantity: str, scale: str) -> list[LogPoint]:
    """Return (lg run time, lg quantity) by run time."""
    log_points = []
    for point in select_within_orbit(line.points, scale):
        value: Value | None = getattr(point, quantity)
        if value and Decimal(value.value) and point.seconds_median:
            log_points.append((log10_of(repr(point.seconds_median)), log10_of(value.value)))
    return sorted(log_points)


def _overlap(lines: Sequence[list[LogPoint]]) -> LogPoint | None:
    if not all(lines):
        return None
    first = max(log_points[0][0] for log_points in lines)
    last = min(log_points[-1][0] for log_points in lines)
    return (first, last) if first < last else None


def _compute_ratio(
    log_points: list[LogPoint], other_log_points: list[LogPoint], span: LogPoint
) -> RatioResult:
    """Return the ratio other/one at the middle, and its range over the span."""
    # The ratio of two broken lines is extreme at a point of either.
    times = {*span, *(x for x, _ in (*log_points, *other_log_points) if span[0] <= x <= span[1])}
    ratios = [
        10 ** (_interpolate(other_log_points, x) - _interpolate(log_points, x)) for x in times
    ]
    middle = sum(span) / 2
    at_middle = 10 ** (_interpolate(other_log_points, middle) - _interpolate(log_points, middle))
    return RatioResult(
        at=_two_digits(at_middle), least=_two_digits(min(ratios)), most=_two_digits(max(ratios))
    )


def _interpolate(log_points: list[LogPoint], x: float) -> float:
    """Interpolate between two of the points; beyond the ends return the end's value."""
    for (x0, y0), (x1, y1) in pairwise(log_points):
        if x0 <= x <= x1 and x1 > x0:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return log_points[0][1] if x <= log_points[0][0] else log_points[-1][1]


def _quoted_name(line: WorkLine) -> str:
    """Return the line's name, quoted if it is the formulas of a user's scheme."""
    return f"`{line.name}`" if "=" in line.name else line.name


def _describe_structure(
    line: WorkLine,
    other_line: WorkLine,
    ratio: RatioResult | None,
    scale: str,
    structure: CanonicalForm,
) -> str:
    """Compare two lines in the structure that a step should keep."""
    subject, both_keep, keeps = _PHRASES[structure]
    exact_names = [_quoted_name(x) for x in (line, other_line) if x.area_preserving]
    if len(exact_names) == 2:
        names = " and ".join(exact_names)
        return f"Both {both_keep}: {names} have {structure.identity} by proof."
    if exact_names:
        inexact_line, exact_line = (
            (line, other_line) if other_line.area_preserving else (other_line, line)
        )
        errors = _sizes(x.area_error for x in select_within_orbit(inexact_line.points, scale))
        rounding_errors = _sizes(x.lam_plain for x in select_within_orbit(exact_line.points, scale))
        other_text = rounding_text = ""
        if errors:
            size = f"{structure.size} of {_span(errors)}"
            other_text = f", where {_quoted_name(inexact_line)} has {size}"
        if rounding_errors:
            rounding_text = f"; what float64’s rounding shows of it is {_span(rounding_errors)}"
        keeping = f"{keeps.format(exact_names[0])} ({structure.identity} is proved)"
        return f"{keeping}{other_text}{rounding_text}."
    if ratio is None:
        return f"{subject} there is nothing to compare."
    comparison = _describe_smaller(_quoted_name(line), _quoted_name(other_line), ratio, "")
    return f"{subject}, {structure.size} of {comparison}."


def _sizes(values: Iterable[Value | None]) -> list[float]:
    return sorted(abs(float(value.value)) for value in values if value)


def _span(sizes: Sequence[float]) -> str:
    low, high = f"`{_two_digits(sizes[0])}`", f"`{_two_digits(sizes[-1])}`"
    return low if low == high else f"{low} to {high}"


def _describe_smaller(name: str, other_name: str, ratio: RatioResult, times: str) -> str:
    """Return `x is 3.2 times smaller than that of y`, with its range."""
    middle, least, most = (float(x) for x in (ratio.at, ratio.least, ratio.most))
    if middle < 1:
        name, other_name = other_name, name
        middle, least, most = 1 / middle, 1 / most, 1 / least
    over = f" over {times}" if times else ""
    if most <= ALIKE and least >= 1 / ALIKE:
        return f"{name} is that of {other_name} (both within {ALIKE - 1:.0%} of each other{over})"
    comparison = f"{name} is `{_two_digits(middle)}` times smaller than that of {other_name}"
    if least >= 1:
        return f"{comparison} (`{_two_digits(least)}` to `{_two_digits(most)}` times{over})"
    return (
        f"{comparison}, but which of the two is smaller changes{over} "
        f"(`{_two_digits(most)}` times smaller to `{_two_digits(1 / least)}` times larger)"
    )


def _two_digits(x: float) -> str:
    """Format x with two significant digits."""
    return f"{float(f'{x:.2g}'):g}"
