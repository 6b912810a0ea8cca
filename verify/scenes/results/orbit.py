"""The states of one run, as exact text and as numpy arrays.

Row k is the state after k steps of h, the initial state first and the last state always there:

| column | what it is |
|---|---|
| `t` | k h |
| `p`, `q` | the state; in n degrees of freedom `p1` … `qn` |
| `energy_error` | H − H₀ at the state, 0 in the first row |
| `delta_j` | ΔJ at the state: of the step that begins there, which Λ of the next row has in it |
| `lambda` | Λ of the k steps that led there, 0 in the first row |
| `symplectic_defect` | in n degrees of freedom, max |W| of these k steps |

The text is decimal, but for a `t` such as 1/3; it is empty where ΔJ or H is not defined, and the
array has nan there. The arrays are the texts' nearest float64 numbers; what is smaller than those
is 0 in them, as 1e-400 is.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from verify.errors import unknown
from verify.frames import library, nearest_float
from verify.notebook import html_table

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

COLUMNS = ("t", "p", "q", "energy_error", "delta_j", "lambda")  # in one degree of freedom
_HEADS = {"energy_error": "H − H₀", "delta_j": "ΔJ", "lambda": "Λ", "symplectic_defect": "max |W|"}
MOST_POINTS = 10_000
_SHOWN = 5  # rows at either end, in a notebook


@dataclass(frozen=True)
class OrbitTable:
    """The rows, each with the texts of its `columns`, and what their digits are.

    `every`: the steps between two rows; the last may be nearer. `digits`: in words, which digits
    stand in the texts.
    """

    rows: tuple[tuple[str, ...], ...]
    every: int
    digits: str
    coordinates: tuple[str, ...] = ("p", "q")
    observables: tuple[str, ...] = ("delta_j", "lambda")

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of what a row has."""
        return ("t", *self.coordinates, "energy_error", *self.observables)

    def texts(self, name: str) -> tuple[str, ...]:
        """The exact texts of one of the `columns`; InputError for another name."""
        if name not in self.columns:
            raise unknown("column", name, self.columns)
        place = self.columns.index(name)
        return tuple(row[place] for row in self.rows)

    def _array(self, name: str) -> "np.ndarray":
        import numpy as np

        return np.array([nearest_float(text) for text in self.texts(name)], dtype=np.float64)

    @cached_property
    def t(self) -> "np.ndarray":
        """The times, without a unit."""
        return self._array("t")

    @cached_property
    def p(self) -> "np.ndarray":
        """The momenta; in n degrees of freedom a column for each."""
        return self._of_kind("p")

    @cached_property
    def q(self) -> "np.ndarray":
        """The displacements; in n degrees of freedom a column for each."""
        return self._of_kind("q")

    def _of_kind(self, letter: str) -> "np.ndarray":
        import numpy as np

        if letter in self.coordinates:
            return self._array(letter)
        own = [name for name in self.coordinates if name[0] == letter]
        return np.column_stack([self._array(name) for name in own])

    @cached_property
    def energy_error(self) -> "np.ndarray":
        """H − H₀ at the states."""
        return self._array("energy_error")

    @cached_property
    def delta_j(self) -> "np.ndarray":
        """ΔJ at the states."""
        return self._array("delta_j")

    @cached_property
    def lambda_(self) -> "np.ndarray":
        """Λ of the steps that led to the states."""
        return self._array("lambda")

    def to_dataframe(self) -> "pd.DataFrame":
        """The columns as float64; InputError where pandas is not installed."""
        pandas = library("pandas", "to_dataframe()")
        found: pd.DataFrame = pandas.DataFrame({name: self._array(name) for name in self.columns})
        return found

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        last = f", t = 0 … {self.rows[-1][0]}" if self.rows else ""
        return f"OrbitTable({len(self)} states{last}; {', '.join(self.columns)})"

    def _repr_html_(self) -> str:
        """The first and the last rows."""
        caption = f"{len(self)} states, one every {self.every} steps"
        rows: Sequence[Sequence[str]] = self.rows
        if len(rows) > 2 * _SHOWN:
            rows = [*rows[:_SHOWN], ("…",) * len(self.columns), *rows[-_SHOWN:]]
        heads = [_HEADS.get(name, name) for name in self.columns]
        return html_table(caption, heads, rows, self.digits)
