"""Results on truncation and rounding, and their display in a notebook.

In the plane the number Λ is split; in n degrees of freedom W, the symplectic defect of the run,
entry by entry.
"""

from typing import TYPE_CHECKING, Any, ClassVar, Generic, Literal, TypeVar

from verify.notebook import html_table, import_library, nearest_float
from verify.scenes.frozen import Frozen, OfScheme, Seconds
from verify.scenes.results.bounded_value import largest
from verify.scenes.results.separation_parts import (
    AnyEvaluation,
    EvaluationResult,
    FormEvaluation,
    FormParts,
    Parts,
    PartsOfRun,
    TangentGrowth,
)

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

WAYS = {"plain": "the plain way", "closed_form": "closed form"}


class Separation(OfScheme):
    """Truncation and rounding of one run in float64.

    See `verify.studies.separation.truncation_and_rounding`.

    `plain` and `closed_form`, two ways to evaluate the quantity that is split, are None if
    `status` is not "finished" (`reason` says why). `arithmetic` is the number system that stood for
    exact arithmetic; `seconds` is the time of stepping all runs.
    """

    split_into: ClassVar[type[PartsOfRun]]
    greatest: ClassVar[str] = ""  # precedes the parts where each is the greatest of several entries
    arithmetic: str
    digits: int
    step_size: str
    steps: int
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    t0: str = "0"
    status: Literal["finished", "left range", "unresolved"]
    failed_step: int | None
    reason: str
    plain: AnyEvaluation | None
    closed_form: AnyEvaluation | None
    error_method: str
    seconds: Seconds

    @property
    def ways(self) -> dict[str, Any]:
        """The evaluations that exist, by the names of `WAYS`."""
        return {way: evaluation for way in WAYS if (evaluation := getattr(self, way))}

    def __repr__(self) -> str:
        heading = f"{self.scheme}, {self.steps} steps of h = {self.step_size}"
        if self.plain is None:
            return f"{type(self).__name__}({heading}: {self.status})"
        truncation, total = map(largest, (self.plain.parts.truncation, self.plain.parts.total))
        sizes = f"{self.greatest}truncation {truncation}, rounding {total}"
        return f"{type(self).__name__}({heading}: {sizes})"

    def _extra_rows(self) -> tuple[list[tuple[str, ...]], str]:
        """Return further rows of the table, and the beginning of the line at its foot."""
        grows = (way.growth["total"].name for way in self.ways.values())
        return [("rounding with N", *grows)], ""

    def _repr_html_(self) -> str:
        """Return a table of the parts, or of their greatest entries, by way, with bounds."""
        total = self.split_into.structure.accumulated
        caption = f"{self.scheme}: {self.steps} steps of h = {self.step_size}, {total} in float64"
        if self.plain is None:
            return html_table(caption, (), [(self.status, self.reason)])
        rows = [
            (label, *(str(largest(getattr(way.parts, name))) for way in self.ways.values()))
            for name, label in self.plain.parts.labels("– ").items()
        ]
        extra_rows, remark = self._extra_rows()
        bounds = f"bounds {self.plain.error_kind}: {self.error_method}"
        foot = f"{remark}{self.arithmetic} as exact arithmetic; {bounds}"
        return html_table(
            caption, ("", *(WAYS[way] for way in self.ways)), [*rows, *extra_rows], foot
        )


class SeparationResult(Separation):
    """Truncation and rounding in Λ of one run in float64.

    `closed_form` is None also where some det J ≤ 0, whose logarithm it would take.
    """

    split_into: ClassVar = Parts
    q: str
    p: str
    plain: EvaluationResult | None
    closed_form: EvaluationResult | None


class SeparationInDegrees(Separation):
    """Truncation and rounding in W of one run in float64, in n degrees of freedom; see
    `verify.studies.separation.matrix_products`.

    `coordinates` name the rows and columns of all matrices. `plain` takes W = MᵀΩM − Ω of float64's
    M, `closed_form` sums MᵀSM. `tangent` is None if they are.
    """

    split_into: ClassVar = FormParts
    greatest: ClassVar = "greatest entries: "
    coordinates: tuple[str, ...]
    q: tuple[str, ...]
    p: tuple[str, ...]
    plain: FormEvaluation | None
    closed_form: FormEvaluation | None
    tangent: TangentGrowth | None

    def name_of(self, place: tuple[int, int]) -> str:
        """Return the name of an entry as a 2-form, such as dp1∧dq1."""
        return "∧".join(f"d{self.coordinates[k]}" for k in place)

    def _extra_rows(self) -> tuple[list[tuple[str, ...]], str]:
        remark = f"the greatest entry of each; {self.tangent.meaning} " if self.tangent else ""
        return [], remark


AnySeparation = SeparationResult | SeparationInDegrees
# -- over step sizes ------------------------------------------------------------------------------


class CrossoverResult(Frozen):
    """A `verify.studies.separation.growth_fits.Crossover`."""

    step_size: str | None
    bracket: tuple[str, str] | None
    reason: str


P = TypeVar("P", bound=Separation)


class GridOf(Frozen, Generic[P]):
    """Separations for several step sizes, in the order given, and the crossover of each way."""

    points: tuple[P, ...]
    plain: CrossoverResult
    closed_form: CrossoverResult

    def __repr__(self) -> str:
        sizes = ", ".join(point.step_size for point in self.points)
        return f"{type(self).__name__}({len(self.points)} step sizes: {sizes})"


class SeparationGrid(GridOf[SeparationResult]):
    """The separation for several step sizes, in the order given, and the crossover of each way."""

    @property
    def rows(self) -> list[dict[str, str]]:
        """A row for each step size and way to evaluate Λ: parts and bounds as exact texts."""
        return [
            {
                "step_size": point.step_size,
                "steps": str(point.steps),
                "way": way,
                **_texts(evaluation),
            }
            for point in self.points
            for way, evaluation in point.ways.items()
        ]

    def to_dataframe(self) -> "pd.DataFrame":
        """Return the rows, with numbers as float64; InputError if pandas is not installed."""
        pandas = import_library("pandas", "to_dataframe()")
        rows = [{k: x if k == "way" else nearest_float(x) for k, x in r.items()} for r in self.rows]
        frame: pd.DataFrame = pandas.DataFrame(rows)
        return frame

    def to_xarray(self) -> "xr.Dataset":
        """Return the parts over way and step size; InputError without xarray or pandas."""
        import_library("xarray", "to_xarray()")
        dataset: xr.Dataset = self.to_dataframe().set_index(["way", "step_size"]).to_xarray()
        return dataset

    def _repr_html_(self) -> str:
        """Return a table of sizes and crossovers; for a single step size, that of all parts."""
        if len(self.points) == 1:
            return self.points[0]._repr_html_()
        heads = ("h", "N", "truncation", *(f"rounding, {label}" for label in WAYS.values()))
        rows = [(point.step_size, str(point.steps), *_sizes(point)) for point in self.points]
        crossings = (
            f"{label}: {_describe_crossing(getattr(self, way))}" for way, label in WAYS.items()
        )
        foot = "rounding overtakes truncation, " + "; ".join(crossings)
        return html_table("Truncation and rounding in Λ", heads, rows, foot)


def _texts(way: EvaluationResult) -> dict[str, str]:
    parts = {name: getattr(way.parts, name) for name in type(way.parts).model_fields}
    bounds = {f"{name}_bound": value.bound for name, value in parts.items()}
    return {name: value.value for name, value in parts.items()} | bounds


def _sizes(point: SeparationResult) -> list[str]:
    if point.plain is None:
        return [f"{point.status}: {point.reason}"]
    rounding = (
        str(evaluation.parts.total) if evaluation else "–"
        for evaluation in map(point.ways.get, WAYS)
    )
    return [str(point.plain.parts.truncation), *rounding]


def _describe_crossing(way: CrossoverResult) -> str:
    return f"below h = {way.step_size}" if way.step_size else way.reason


class SeparationGridInDegrees(GridOf[SeparationInDegrees]):
    """The separation of W for several step sizes, in the order given, and the crossover of the
    greatest entries, each way."""

    def _repr_html_(self) -> str:
        """Return the tables of all step sizes, one below the other."""
        return "".join(point._repr_html_() for point in self.points)


AnyGrid = SeparationGrid | SeparationGridInDegrees
