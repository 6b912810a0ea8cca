"""The result of one run, the states of its orbit, and the drift of an energy along it.

The states are exact text and numpy arrays. Row k is the state after k steps of h, the initial state
first and the last state always there:

| column | what it is |
|---|---|
| `t` | k h |
| `p`, `q` | the state; in n degrees of freedom `p1` … `qn`; of equations its own names |
| `energy_error` | H − H₀ at the state, 0 in the first row |
| `delta_j` | ΔJ at the state: of the step that begins there, which Λ of the next row has in it |
| `lambda` | Λ of the k steps that led there, 0 in the first row |
| `symplectic_defect` | in n degrees of freedom, max |W| of these k steps |

The text is decimal, but for a `t` such as 1/3; it is empty if ΔJ or H is not defined, and the
array has nan there. The arrays hold the float64 numbers nearest to the texts; a number below their
range, such as 1e-400, is 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Self

from pydantic import Field, PrivateAttr

from verify import observables
from verify.errors import InputError, unknown_name
from verify.notebook import aligned_latex, html_table, import_library, nearest_float, number_latex
from verify.scenes.frozen import Frozen, OfScheme, Seconds
from verify.scenes.results.bounded_value import Value

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
    has_energy: bool = True

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        energy = ("energy_error",) if self.has_energy else ()
        return ("t", *self.coordinates, *energy, *self.observables)

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
        """Return the columns as float64; InputError if pandas is not installed."""
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


@dataclass(frozen=True)
class EnergyDrift:
    """H̃ − H̃₀ at the times of `t`, for H̃ up to h^`power`; None if H̃ is not defined.

    `power` 0 is H itself. All without units; the values are the nearest float64 numbers.
    """

    power: int
    t: tuple[Fraction, ...]
    values: tuple[float | None, ...]

    @property
    def largest(self) -> float:
        """The largest |H̃ − H̃₀|."""
        return max((abs(x) for x in self.values if x is not None), default=0.0)


class SeriesPoint(Frozen):
    """The least and greatest ΔJ and Λ over the steps first … last.

    `energy`: H − H₀ at the run's numbers after the last of them, where the run asks for energy.
    """

    first: int
    last: int
    delta_j: tuple[str, str]
    lam: tuple[str, str]
    energy: str | None = None


class RunResult(OfScheme):
    """One run of N steps of a scheme in one arithmetic.

    `values` holds q, p and the requested observables. It is empty if the orbit left the
    arithmetic's range (`status` "left range"; `failed_step` is the first step out of it), and where
    no digit could be confirmed ("unresolved"). `error_kind` is "enclosed" where every bound is
    rigorous, else "estimated", by `error_method`. `fallback` says why another arithmetic was used
    than the requested one; `left_domain` names the step by which the orbit has left the domain of
    H, if that is seen: the scheme continues there, but no solution does. `exact` names the
    observables that follow from a proof, without a run. `t0` is the time at which it started, where
    H depends on time. Of equations q and p are empty, and `start` has the initial values by name.
    `source` is the part of a paper that the run repeats, as the scene says.
    """

    arithmetic: str
    fallback: str = ""
    left_domain: str = ""
    digits: int
    step_size: str
    steps: int
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    start: dict[str, str] = Field(default_factory=dict)
    t0: str = "0"
    status: Literal["finished", "left range", "unresolved"]
    failed_step: int | None
    values: dict[str, Value]
    error_kind: Literal["enclosed", "estimated"]
    error_method: str
    exact: tuple[str, ...]
    series: tuple[SeriesPoint, ...]
    seconds: Seconds
    source: str = ""

    _points: int = PrivateAttr(MOST_POINTS)

    def with_points(self, points: int) -> Self:
        """Return the run with an `orbit` of at most so many states; of as many as it can for 0."""
        copy = self.model_copy()
        # A private attribute, which is no key of the result and is not compared.
        copy._points = points or MOST_POINTS
        return copy

    def start_text(self, letter: str) -> str:
        """Return the initial q or p; in n degrees of freedom all of its numbers, in brackets."""
        start = self.q if letter == "q" else self.p
        return start if isinstance(start, str) else f"({', '.join(start)})"

    @property
    def plane_start(self) -> tuple[str, str]:
        """The initial q and p of a run in one degree of freedom; InputError for any other run."""
        if isinstance(self.q, str) and isinstance(self.p, str):
            return self.q, self.p
        problem = "has more degrees of freedom; what is asked for takes p and q"
        raise InputError("run", self.scheme, problem)

    @property
    def orbit(self) -> OrbitTable:
        """The states as arrays and exact texts: every step up to 10,000 or `points`, else thinned.

        The run is done again for it when it is first looked at; see `verify.runs.orbit_table`.
        """
        raise self._only_values()

    def solution_errors(self, points: int = 200) -> tuple[tuple[Fraction, Value], ...]:
        """Return (t, |z − φ_t(z₀)|), the distance from the exact solution, at so many states.

        See `verify.runs.run_errors`. Raises InputError if no exact solution is found.
        """
        raise self._only_values()

    def energy_drifts(self, order: int = 4, points: int = 1000) -> list[EnergyDrift]:
        """Return H̃ − H̃₀ at most at so many states, for H and for H̃ with each term up to h^order.

        See `verify.runs.run_errors`. Raises InputError if the scheme has no H̃ other than H.
        """
        raise self._only_values()

    def _only_values(self) -> InputError:
        """Return the error of a run that cannot be repeated here; see `verify.calls.run_result`."""
        return InputError("run", self.scheme, "has its values alone; verify.RunResult has more")

    def __repr__(self) -> str:
        aside = {each.name for each in observables.select(self.values) if each.aside}
        shown = ((name, value) for name, value in self.values.items() if name not in aside)
        values = ", ".join(f"{name} = {value}" for name, value in shown)
        heading = f"{self.scheme}, {self.steps} steps of h = {self.step_size}, {self.arithmetic}"
        return f"RunResult({heading}: {values or self.status})"

    def _repr_html_(self) -> str:
        """Return the values, each with its error bound, as a table."""
        first = self.start or {letter: self.start_text(letter) for letter in ("q", "p")}
        start = ", ".join(f"{name} = {x}" for name, x in first.items())
        caption = f"{self.scheme}: {self.steps} steps of h = {self.step_size} from {start}"
        bounds = f"bounds {self.error_kind}: {self.error_method}"
        foot = f"{self.arithmetic}, {self.digits} digits; {bounds}"
        if self.fallback:
            foot += f"; taken instead of what was asked for: {self.fallback}"
        if self.left_domain:
            foot += f"; {self.left_domain}"
        if self.status != "finished":
            place = f" at step {self.failed_step}" if self.failed_step is not None else ""
            return html_table(caption, (), [("outcome", self.status + place)], foot)
        rows = [
            (label, "|·|", f"≤ {value.bound}") if value.unknown else
            (label, value.value, f"± {value.bound}")
            for label, _, value in self._labelled_values()
        ]  # fmt: skip
        return html_table(caption, ("", "value", "error bound"), rows, foot)

    def _repr_latex_(self) -> str:
        """Return the values with their error bounds in LaTeX."""
        lines = [
            rf"{symbol} &: |\cdot| \le {number_latex(value.bound)}" if value.unknown else
            rf"{symbol} &= {number_latex(value.value)} \pm {number_latex(value.bound)}"
            for _, symbol, value in self._labelled_values()
        ]  # fmt: skip
        return aligned_latex(lines or [rf"\Lambda &: \text{{{self.status}}}"])

    def _labelled_values(self) -> list[tuple[str, str, Value]]:
        """Return the values with their labels as text and in LaTeX; coordinates come last."""
        labels = {x.name: (x.label, x.tex) for x in observables.select(self.values)}
        labels |= {"q": ("q", "q"), "p": ("p", "p")}
        labels |= {name: (name, rf"\text{{{name}}}") for name in self.start}
        labels |= {n: (n, f"{n[0]}_{{{n[1:]}}}") for n in self.values if n[1:].isdigit()}
        return [(*names, self.values[n]) for n, names in labels.items() if n in self.values]
