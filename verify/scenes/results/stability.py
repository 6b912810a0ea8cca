"""Results on a scheme's stability."""

from collections import Counter
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from verify.scenes.frozen import Frozen, OfScheme, ProseText, TitledScheme, WithProse

Kind = Literal[
    "stable", "drifts", "unstable: scheme", "unstable: arithmetic", "escapes", "overflow",
    "underflow", "sensitive", "undecided",
]  # fmt: skip
KINDS: tuple[Kind, ...] = Kind.__args__  # type: ignore[attr-defined]
OrbitKind = Literal["regular", "sensitive", "undecided", "leaves"]
ORBIT_KINDS: tuple[OrbitKind, ...] = OrbitKind.__args__  # type: ignore[attr-defined]
Rows = Annotated[tuple[tuple[str | None, ...], ...], Field(min_length=1)]


class StabilityResult(TitledScheme, WithProse):
    """One run's verdict, which says what it is due to; `id` is the run's name in its scene, `t0`
    when it starts where H depends on time.

    `step`: where it leaves its bounds, parts from the same scheme in other arithmetic, or leaves
    float64's range. `rate`: of a drift, the energy's change in a unit of time in parts of the
    orbit's own energy scale. `energy_error`: the greatest |H − H(z0)| seen, in the same parts.
    `h_omega`: the step size times the orbit's greatest frequency; `linear_limit`: up to where the
    scheme is stable on the harmonic oscillator; None if either is not known. `lyapunov`: in n
    degrees of freedom, the finite-time Lyapunov exponent of the exact motion.
    """

    id: str = ""
    hamiltonian: str
    parameters: dict[str, str]
    scheme: str
    step_size: str
    steps: int
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    t0: str | None = None
    kind: Kind
    step: int | None = None
    rate: str | None = None
    energy_error: str | None = None
    h_omega: str | None = None
    linear_limit: str | None = None
    lyapunov: str | None = None
    exact_orbit: ProseText
    detail: ProseText

    @property
    def verdict(self) -> str:
        """The verdict in words, with the step or the rate that belongs to it."""
        if self.kind == "overflow":
            return f"overflow at step {self.step}"
        if self.kind == "drifts":
            return f"drifts ({self.rate} of its energy scale per unit time)"
        return self.kind


class LargestStepResult(OfScheme, WithProse):
    """The largest step size with bounded motion, measured, against linear theory.

    `bounded`: the motion stays bounded with it; `unbounded`: with this next one, a thousandth
    greater, it does not; None if no step size looked at is of that kind. `linear`: the step size
    that linear theory allows where the orbit is stiffest; "0" where it allows none. `energy_error`
    and `symplectic_defect`: the further limits that the motion had to respect, if any.
    """

    time: str
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    t0: str | None = None
    bounded: str | None
    unbounded: str | None
    linear: str | None
    h_omega: str | None
    energy_error: str | None = None
    symplectic_defect: str | None = None
    exact_orbit: ProseText
    detail: ProseText


class MapCell(Frozen):
    """One run of a map: its verdict, and the step that it belongs to."""

    kind: Kind
    step: int | None = None


class StabilityMapResult(OfScheme):
    """Verdicts in the plane of step size and stiffness, of one scheme.

    `cells[i][j]`: at the i-th value of the parameter and the j-th step size. `linear[i]`: the step
    size that linear theory allows there; None if it does not say.
    """

    parameter: str
    values: Annotated[tuple[str, ...], Field(min_length=1)]
    step_sizes: Annotated[tuple[str, ...], Field(min_length=1)]
    steps: int
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    t0: str | None = None
    cells: tuple[tuple[MapCell, ...], ...]
    linear: tuple[str | None, ...]

    def counted(self) -> dict[Kind, int]:
        """Return the number of cells of each kind that occurs."""
        counts = Counter(cell.kind for row in self.cells for cell in row)
        return {kind: counts[kind] for kind in KINDS if counts[kind]}


class OrbitMapResult(OfScheme):
    """Orbits of one scheme over two initial values, in float64: measured, over so many steps.

    `rows` hold a list for each value of the second axis, with an entry for each of the first.
    `kinds`: regular, where neighbours part no faster than a power of t; sensitive, where they part
    exponentially; undecided, where the time does not tell, or H is not defined there; leaves, where
    a coordinate is beyond `beyond` or float64's range, seen after `left` steps, which are looked at
    every `every` steps. `lyapunov`: the rate at which a neighbour parts, by the distance that it
    began with, until a tenth of the greatest start. `defects`: max |W| after all steps, the
    symplectic defect, in the plane |Λ|; "0" where it is proved, None if the orbit leaves or W is
    not carried in so many degrees of freedom. `energies`: H at the start, None if H depends on
    time.
    """

    axes: tuple[str, str]
    across: tuple[str, ...]
    upwards: tuple[str, ...]
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    t0: str | None = None
    step_size: str
    steps: int
    beyond: str
    every: int
    kinds: tuple[tuple[OrbitKind, ...], ...]
    left: tuple[tuple[int | None, ...], ...]
    lyapunov: Rows
    defects: Rows
    energies: Rows

    def counted(self) -> dict[OrbitKind, int]:
        """Return the number of orbits of each kind that occurs."""
        counts = Counter(kind for row in self.kinds for kind in row)
        return {kind: counts[kind] for kind in ORBIT_KINDS if counts[kind]}

    def places(self) -> Iterator[tuple[int, int]]:
        """Yield the indices of all cells: row, then column."""
        for i in range(len(self.upwards)):
            for j in range(len(self.across)):
                yield i, j
