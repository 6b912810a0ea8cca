"""Truncation and rounding in Λ as they were found, and how they show themselves in a notebook."""

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Literal, TypeVar

from verify.frames import library, nearest_float
from verify.notebook import html_table
from verify.scenes.frozen import Frozen, OfScheme, Said, Seconds, WithProse
from verify.scenes.results.bounded_value import Value

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

ROUNDING = ("input", "trajectory", "determinant", "product")  # the parts of it
SHOWN = {"lambda_working": "Λ in float64", "truncation": "truncation", "total": "rounding"}
WAYS = {"plain": "the plain way", "closed_form": "closed form"}


class Chain(Frozen):
    """The parts of what float64 finds, which the chain's kinds of rounding end."""

    rounding: ClassVar[tuple[str, ...]]

    @property
    def of_rounding(self) -> tuple[str, ...]:
        """The names of the parts of rounding, in the chain's order."""
        first, *others = self.rounding
        return first, *(["clock"] if hasattr(self, "clock") else []), *others


class Parts(Chain):
    """truncation + input + trajectory + determinant + product = lambda_working (one equation of
    exact rationals, of which these are the known digits); total is the sum of the last four."""

    rounding: ClassVar = ROUNDING
    lambda_working: Value
    truncation: Value
    total: Value
    input: Value
    trajectory: Value
    determinant: Value
    product: Value


class PartsInTime(Parts):
    """Of an H that depends on time: what float64's clock does stands between input and
    trajectory."""

    clock: Value


class PartsAt(Frozen):
    """The parts after `steps` steps, as decimals of a few digits, for a figure."""

    steps: int
    truncation: str
    total: str
    input: str
    trajectory: str
    determinant: str
    product: str


class PartsInTimeAt(PartsAt):
    """The same of an H that depends on time."""

    clock: str


class GrowthResult(WithProse):
    """A `verify.studies.separation.growth.Growth`."""

    exponent: str | None
    standard_error: str | None
    name: Literal["random walk", "drift", "undecided"]
    reason: Said
    first: int
    last: int
    points: int


class EvaluationResult(Frozen):
    """Λ of a float64 run, split, for one way to evaluate it; `growth`: of total and of each part.

    `largest`: the greatest |truncation| and |total| at the checkpoints of the run.
    """

    parts: PartsInTime | Parts
    largest: dict[str, str]
    growth: dict[str, GrowthResult]
    series: tuple[PartsInTimeAt | PartsAt, ...]
    error_kind: Literal["enclosed", "estimated"]


class SeparationResult(OfScheme):
    """Truncation and rounding in Λ of one run in float64; see `verify.studies.separation.separate`.

    `plain` and `closed_form` are None where `status` is not "finished" (`reason` says why), and
    `closed_form` also where some det J ≤ 0, whose logarithm it would take. `arithmetic` is what
    stood for exact arithmetic; `seconds` is the stepping of all runs.
    """

    arithmetic: str
    digits: int
    step_size: str
    steps: int
    q: str
    p: str
    t0: str = "0"
    status: Literal["finished", "left range", "unresolved"]
    failed_step: int | None
    reason: str
    plain: EvaluationResult | None
    closed_form: EvaluationResult | None
    error_method: str
    seconds: Seconds

    def __repr__(self) -> str:
        what = f"{self.scheme}, {self.steps} steps of h = {self.step_size}"
        if self.plain is None:
            return f"SeparationResult({what}: {self.status})"
        parts = self.plain.parts
        return f"SeparationResult({what}: truncation {parts.truncation}, rounding {parts.total})"

    def _repr_html_(self) -> str:
        """The parts of Λ for each way to evaluate it, with their bounds."""
        return parts_table(self, "Λ", SHOWN, str, grows=lambda way: way.growth["total"].name)


def parts_table(
    point: Any,
    whole: str,
    labels: Mapping[str, str],
    cell: Callable[[Any], str],
    said: str = "",
    grows: Callable[[Any], str] | None = None,
) -> str:
    """What was split, of Λ or W, for each way to evaluate it, and how rounding `grows` with N;
    `said` at its foot, first."""
    caption = f"{point.scheme}: {point.steps} steps of h = {point.step_size}, {whole} in float64"
    if point.plain is None:
        return html_table(caption, (), [(point.status, point.reason)])
    ways = {label: getattr(point, way) for way, label in WAYS.items() if getattr(point, way)}
    parts = {**labels, **{name: f"– {name}" for name in point.plain.parts.of_rounding}}
    rows = [
        (label, *(cell(getattr(way.parts, name)) for way in ways.values()))
        for name, label in parts.items()
    ]
    if grows:
        rows.append(("rounding with N", *map(grows, ways.values())))
    foot = f"{said}{point.arithmetic} as exact arithmetic; bounds {point.plain.error_kind}: "
    return html_table(caption, ("", *ways), rows, foot + point.error_method)


class CrossoverResult(Frozen):
    """A `verify.studies.separation.growth.Crossover`."""

    step_size: str | None
    bracket: tuple[str, str] | None
    reason: str


P = TypeVar("P")  # a separation


class GridOf(Frozen, Generic[P]):
    """Separations for several step sizes, in the order given, and the crossover of each way."""

    points: tuple[P, ...]
    plain: CrossoverResult
    closed_form: CrossoverResult

    def __repr__(self) -> str:
        sizes = ", ".join(point.step_size for point in list[Any](self.points))
        return f"{type(self).__name__}({len(self.points)} step sizes: {sizes})"


class SeparationGrid(GridOf[SeparationResult]):
    """The separation for several step sizes, in the order given, and the crossover of each way."""

    @property
    def rows(self) -> list[dict[str, str]]:
        """A row a step size and way to evaluate Λ, its parts and their bounds as exact texts."""
        return [
            {"step_size": point.step_size, "steps": str(point.steps), "way": way, **_texts(found)}
            for point in self.points
            for way in WAYS
            if (found := getattr(point, way)) is not None
        ]

    def to_dataframe(self) -> "pd.DataFrame":
        """The rows, numbers as float64; InputError where pandas is not installed."""
        pandas = library("pandas", "to_dataframe()")
        rows = [{k: x if k == "way" else nearest_float(x) for k, x in r.items()} for r in self.rows]
        found: pd.DataFrame = pandas.DataFrame(rows)
        return found

    def to_xarray(self) -> "xr.Dataset":
        """The parts over way and step size; InputError where xarray or pandas is not installed."""
        library("xarray", "to_xarray()")
        found: xr.Dataset = self.to_dataframe().set_index(["way", "step_size"]).to_xarray()
        return found

    def _repr_html_(self) -> str:
        """Truncation and rounding of each step size, and where they cross; one alone in full."""
        if len(self.points) == 1:
            return self.points[0]._repr_html_()
        heads = ("h", "N", "truncation", *(f"rounding, {label}" for label in WAYS.values()))
        rows = [(point.step_size, str(point.steps), *_sizes(point)) for point in self.points]
        crossed = (f"{label}: {_crossing(getattr(self, way))}" for way, label in WAYS.items())
        foot = "rounding overtakes truncation, " + "; ".join(crossed)
        return html_table("Truncation and rounding in Λ", heads, rows, foot)


def _texts(way: EvaluationResult) -> dict[str, str]:
    parts = {name: getattr(way.parts, name) for name in type(way.parts).model_fields}
    bounds = {f"{name}_bound": value.bound for name, value in parts.items()}
    return {name: value.value for name, value in parts.items()} | bounds


def _sizes(point: SeparationResult) -> Iterator[str]:
    if point.plain is None:
        yield f"{point.status}: {point.reason}"
        return
    yield str(point.plain.parts.truncation)
    for way in (point.plain, point.closed_form):
        yield _rounding(way)


def _rounding(way: EvaluationResult | None) -> str:
    return str(way.parts.total) if way else "–"


def _crossing(way: CrossoverResult) -> str:
    return f"below h = {way.step_size}" if way.step_size else way.reason
