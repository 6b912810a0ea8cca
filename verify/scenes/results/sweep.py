"""Runs over a product of schemes, step sizes, initial values and parameters, as one table."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

from verify.frames import library, nearest_float
from verify.notebook import html_table
from verify.scenes.results.run import RunResult

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    import xarray as xr

_SHOWN = 40  # rows in a notebook


@dataclass(frozen=True)
class Sweep:
    """`axes`: what was varied or given, with its values as exact texts; `runs`: one for each
    combination of them, the last axis fastest. `observables`: what each run has values of.
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
        """The table as exact texts; one is empty where a run gave no value."""
        return [
            (*at, *self._values(run), run.status)
            for at, run in zip(product(*self.axes.values()), self.runs, strict=True)
        ]

    def _values(self, run: RunResult) -> list[str]:
        found = (run.values.get(name) for name in self.observables)
        return [text for x in found for text in ((x.value, x.bound) if x else ("", ""))]

    def column(self, name: str) -> "np.ndarray":
        """A column as float64, nan where a run gave no value; ValueError for one of words."""
        import numpy as np

        place = self.columns.index(name)
        return np.array([nearest_float(row[place]) for row in self.rows], dtype=np.float64)

    def to_dataframe(self) -> "pd.DataFrame":
        """A row a run, numbers as float64; InputError where pandas is not installed."""
        pandas = library("pandas", "to_dataframe()")
        read = {name: self._as_numbers(name) for name in self.columns}
        found: pd.DataFrame = pandas.DataFrame(read)
        return found

    def to_xarray(self) -> "xr.Dataset":
        """A variable an observable and its bound, over the axes; InputError without xarray."""
        xarray = library("xarray", "to_xarray()")
        shape = tuple(len(values) for values in self.axes.values())
        names = [name for name in self.columns if name not in self.axes]
        data = {n: ([*self.axes], _shaped(self._as_numbers(n), shape)) for n in names}
        coordinates = {name: _numbers(values) for name, values in self.axes.items()}
        found: xr.Dataset = xarray.Dataset(data, coords=coordinates)
        return found

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
            (*(row[self.columns.index(name)] for name in varied), *self._shown(run))
            for row, run in zip(self.rows[:_SHOWN], self.runs, strict=False)
        ]
        foot = ", ".join(f"{name} = {value}" for name, value in fixed.items())
        more = len(self) - len(rows)
        return html_table(repr(self), heads, rows, f"{foot}; {more} more rows" if more else foot)

    def _shown(self, run: RunResult) -> list[str]:
        return [str(run.values.get(name, run.status)) for name in self.observables]


def _numbers(texts: Sequence[str]) -> Any:
    """Floats where all are numbers, else the texts."""
    try:
        return [nearest_float(text) for text in texts]
    except ValueError:
        return list(texts)


def _shaped(values: Any, shape: tuple[int, ...]) -> Any:
    import numpy as np

    reshape: Callable[..., Any] = np.array(values).reshape
    return reshape(shape)
