"""Runs over a product of schemes, step sizes, initial values and parameters, as one table."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

from verify.notebook import html_table, import_library, nearest_float
from verify.scenes.results.run import RunResult

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    import xarray as xr

# The number of rows that a notebook shows.
_VISIBLE_ROWS = 40


@dataclass(frozen=True)
class Sweep:
    """Runs over a product of axes.

    `axes`: the names of the inputs with their values as exact texts; `runs`: one for each
    combination of them, the last axis fastest. `observables`: the names of each run's values.
    """

    axes: Mapping[str, tuple[str, ...]]
    runs: tuple[RunResult, ...]
    observables: tuple[str, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """The axes, then each value with its bound, then how the run ended."""
        values = (name for o in self.observables for name in (o, f"{o}_bound"))
        return (*self.axes, *values, "status")

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The table as exact texts; a text is empty if a run gave no value."""
        return [
            (*values, *self._values(run), run.status)
            for values, run in zip(product(*self.axes.values()), self.runs, strict=True)
        ]

    def _values(self, run: RunResult) -> list[str]:
        values = (run.values.get(name) for name in self.observables)
        return [text for x in values for text in ((x.value, x.bound) if x else ("", ""))]

    def column(self, name: str) -> "np.ndarray":
        """Return a column as float64, nan if a run gave no value; ValueError for words."""
        import numpy as np

        place = self.columns.index(name)
        return np.array([nearest_float(row[place]) for row in self.rows], dtype=np.float64)

    def to_dataframe(self) -> "pd.DataFrame":
        """Return a row for each run, numbers as float64; InputError without pandas."""
        pandas = import_library("pandas", "to_dataframe()")
        columns = {name: self._as_numbers(name) for name in self.columns}
        frame: pd.DataFrame = pandas.DataFrame(columns)
        return frame

    def to_xarray(self) -> "xr.Dataset":
        """Return the observables and their bounds over the axes; InputError without xarray."""
        xarray = import_library("xarray", "to_xarray()")
        shape = tuple(len(values) for values in self.axes.values())
        names = [name for name in self.columns if name not in self.axes]
        data = {n: ([*self.axes], _reshape(self._as_numbers(n), shape)) for n in names}
        coordinates = {name: _numbers(values) for name, values in self.axes.items()}
        dataset: xr.Dataset = xarray.Dataset(data, coords=coordinates)
        return dataset

    def _as_numbers(self, name: str) -> Any:
        place = self.columns.index(name)
        return _numbers([row[place] for row in self.rows])

    def __len__(self) -> int:
        return len(self.runs)

    def __iter__(self) -> Any:
        return iter(self.runs)

    def __repr__(self) -> str:
        sizes = " × ".join(f"{len(values)} {name}" for name, values in self.axes.items())
        return f"Sweep({len(self)} runs: {sizes}; {', '.join(self.observables)})"

    def _repr_html_(self) -> str:
        varied = [name for name, values in self.axes.items() if len(values) > 1] or [*self.axes]
        fixed = {name: values[0] for name, values in self.axes.items() if name not in varied}
        heads = (*varied, *self.observables)
        rows = [
            (*(row[self.columns.index(name)] for name in varied), *self._run_texts(run))
            for row, run in zip(self.rows[:_VISIBLE_ROWS], self.runs, strict=False)
        ]
        foot = ", ".join(f"{name} = {value}" for name, value in fixed.items())
        more = len(self) - len(rows)
        return html_table(repr(self), heads, rows, f"{foot}; {more} more rows" if more else foot)

    def _run_texts(self, run: RunResult) -> list[str]:
        return [str(run.values.get(name, run.status)) for name in self.observables]


def _numbers(texts: Sequence[str]) -> Any:
    """Return floats where all texts are numbers, else the texts."""
    try:
        return [nearest_float(text) for text in texts]
    except ValueError:
        return list(texts)


def _reshape(values: Any, shape: tuple[int, ...]) -> Any:
    import numpy as np

    reshape: Callable[..., Any] = np.array(values).reshape
    return reshape(shape)
