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
array has nan there. The arrays hold the float64 numbers nearest to the texts; a number below their
range, such as 1e-400, is 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from verify.errors import unknown_name
from verify.frames import import_library, nearest_float
from verify.notebook import html_table

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

# The columns in one degree of freedom.
COLUMNS = ("t", "p", "q", "energy_error", "delta_j", "lambda")
_HEADS = {"energy_error": "H − H₀", "delta_j": "ΔJ", "lambda": "Λ", "symplectic_defect": "max |W|"}
MOST_POINTS = 10_000
# The number of rows at either end that a notebook shows.
_VISIBLE_ROWS = 5


@dataclass(frozen=True)
class OrbitTable:
    """The rows, each with the texts of its `columns`.

    `every`: the number of steps between two rows; the last row may be nearer. `digits`: a sentence
    on the digits of the texts.
    """

    rows: tuple[tuple[str, ...], ...]
    every: int
    digits: str
    coordinates: tuple[str, ...] = ("p", "q")
    observables: tuple[str, ...] = ("delta_j", "lambda")

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        return ("t", *self.coordinates, "energy_error", *self.observables)

    def texts(self, name: str) -> tuple[str, ...]:
        """Return the exact texts of one of the `columns`; InputError for another name."""
        if name not in self.columns:
            raise unknown_name("column", name, self.columns)
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
        names = [name for name in self.coordinates if name[0] == letter]
        return np.column_stack([self._array(name) for name in names])

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
        """Return the columns as float64; InputError where pandas is not installed."""
        pandas = import_library("pandas", "to_dataframe()")
        frame: pd.DataFrame = pandas.DataFrame({name: self._array(name) for name in self.columns})
        return frame

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        last = f", t = 0 … {self.rows[-1][0]}" if self.rows else ""
        return f"OrbitTable({len(self)} states{last}; {', '.join(self.columns)})"

    def _repr_html_(self) -> str:
        """Return the first and the last rows as a table."""
        caption = f"{len(self)} states, one every {self.every} steps"
        rows: Sequence[Sequence[str]] = self.rows
        if len(rows) > 2 * _VISIBLE_ROWS:
            rows = [*rows[:_VISIBLE_ROWS], ("…",) * len(self.columns), *rows[-_VISIBLE_ROWS:]]
        heads = [_HEADS.get(name, name) for name in self.columns]
        return html_table(caption, heads, rows, self.digits)
