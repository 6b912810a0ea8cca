"""The tangent map carried along an orbit in float64: how a small error of the state grows.

M₀ = 1 and M_{k+1} = A_k M_k, with A_k the Jacobian of one step at the orbit's k-th state. A_k − 1
is evaluated at the state rounded to float64, and its product with M is added to M in twice the
precision (Knuth's two-sum), so that the error of one step is about h·2⁻⁵³ of M.

`verify.runs.a_posteriori_bound` bounds the orbit's error by these numbers:

- `growth`: Σ ‖M‖²; `growth_top`: its greatest term;
- `det_low`: the least det M; in n degrees of freedom det M is computed as Pf(MᵀΩM)/Pf Ω, and for
  coordinates that are no p and q by its minors;
- `form_top`, for n > 1 degrees of freedom: the greatest sum of squares of the entries of MᵀΩM above
  the diagonal;
- `p_low`, `p_high`, …: the box that the orbit has visited;
- `least`, `most`, which the kernel adds: bounds of Λ so far.
"""

from collections.abc import Callable, Collection, Sequence
from itertools import combinations

from verify.hamiltonians.coordinates import PLANE
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.operations import StepProgram

_NOTED_SUMS = ("growth", "growth_top", "det_low", "form_top", "least", "most")


def names_of(coordinates: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the numbers that are noted if the tangent map is carried."""
    return (*_NOTED_SUMS, *(f"{name}_{end}" for name in coordinates for end in ("low", "high")))


def entries_of(coordinates: Sequence[str]) -> tuple[str, ...]:
    """Return the names of M's entries, row by row."""
    return tuple(f"m_{row}{column}" for row in coordinates for column in coordinates)


def initial_values(
    coordinates: Sequence[str], canonical: bool = True
) -> list[tuple[str, int | str]]:
    """Return (name, initial value) of the carried numbers, which are float64; the name of a
    coordinate stands for its initial value."""
    size, entries = len(coordinates), entries_of(coordinates)
    values: list[tuple[str, int | str]] = [
        (entry, int(k % (size + 1) == 0)) for k, entry in enumerate(entries)
    ]
    values += [(f"{entry}_rest", 0) for entry in entries]
    values += [("growth", size), ("growth_top", size), ("det_low", 1)]
    # In the plane det M is computed directly, and MᵀΩM has one entry, det M itself.
    if size > 2 and canonical:
        values.append(("form_top", size // 2))
    return values + [(f"{name}_{end}", name) for name in coordinates for end in ("low", "high")]


class Tangent:
    """A − 1 of the step, row by row, in a float64 program beside the step's main program."""

    def __init__(self, main: StepProgram) -> None:
        self.main, self.program = main, StepProgram()
        self.main_values: list[int] = []  # indices of the values of `main` that are read
        self.change: list[int] = []  # indices of the entries of A − 1 in `program`

    def take(self, change: Sequence[int], points: Collection[int] = ()) -> None:
        """Write A − 1, given by its indices in the main program, into the float64 program.

        Sums and products are computed again in float64. All other values are read from the main
        program, and so are the values `points`: the coordinates of the points where f is evaluated.
        """
        index_of: dict[int, int] = {}
        program = self.program
        float_operations: dict[str, Callable[..., int]] = {
            "add": program.add, "mul": program.mul, "neg": program.neg,
            "sub": lambda x, y: program.add(x, program.neg(y)),
        }  # fmt: skip
        # Rounded inputs and float64 sums suffice: A − 1 is O(h), so an error of 2⁻⁵³ in it is
        # h·2⁻⁵³ of M.
        for index in self.main.live(change):
            op = self.main.ops[index]
            if op.kind == "const":
                index_of[index] = program.constant(op.value)
            elif (
                index not in points
                and op.kind in float_operations
                and all(a in index_of for a in op.args)
            ):
                index_of[index] = float_operations[op.kind](*(index_of[a] for a in op.args))
            else:
                index_of[index] = self._read(index)
        self.change = [index_of[index] for index in change]
        live_ops = (program.ops[index] for index in program.live(self.change))
        names = {op.name for op in live_ops if op.kind == "input"}
        self.main_values = [index for index in self.main_values if _input_name(index) in names]

    def _read(self, index: int) -> int:
        """Return a value of the main program as an input of this one."""
        self.main_values.append(index)
        return self.program.input(_input_name(index), static=self.main.static[index])

    @property
    def lowering(self) -> Lowering:
        return Lowering(self.program, (), "slope")


def _input_name(index: int) -> str:
    return f"approx(v{index})"


def statements(
    change: Sequence[str], coordinates: Sequence[str] = PLANE, canonical: bool = True
) -> list[str]:
    """Return the statements of M ← M + (A − 1) M and of the noted numbers; `change`: the names of
    the entries of A − 1, row by row; `canonical`: the coordinates are p and q."""
    size = len(coordinates)
    lines = [
        *(f"f{n} = approx({n})" for n in coordinates),
        *(f"if f{n} < {n}_low: {n}_low = f{n}" for n in coordinates),
        *(f"if f{n} > {n}_high: {n}_high = f{n}" for n in coordinates),
    ]
    for i, row in enumerate(coordinates):
        row_entries = change[size * i : size * (i + 1)]
        for column in coordinates:
            parts = (f"{x} * m_{c}{column}" for x, c in zip(row_entries, coordinates, strict=True))
            lines.append(f"f_{row}{column} = m_{row}{column}_rest + ({' + '.join(parts)})")
    for entry in (row + column for row in coordinates for column in coordinates):
        m, move = f"m_{entry}", f"f_{entry}"
        lines += [
            f"f_total = {m} + {move}",
            f"f_part = f_total - {m}",
            f"{m}_rest = ({m} - (f_total - f_part)) + ({move} - f_part)",
            f"{m} = f_total",
        ]
    squares = (" + ".join(f"m_{a}{b} * m_{a}{b}" for b in coordinates) for a in coordinates)
    return [
        *lines,
        f"f_size = {' + '.join(f'({row})' for row in squares)}",
        *(_form(coordinates) if size > 2 and canonical else _determinant(coordinates)),
        "growth = growth + f_size",
        "if f_size > growth_top: growth_top = f_size",
        "if f_det < det_low: det_low = f_det",
    ]


def _determinant(coordinates: Sequence[str]) -> list[str]:
    """Return the statements of det M, by the minors of its last rows; each is computed once."""
    lines: list[str] = []
    last = coordinates[-1]
    minors: dict[tuple[str, ...], str] = {(x,): f"m_{last}{x}" for x in coordinates}
    for count in range(2, len(coordinates) + 1):
        row, longer = coordinates[-count], dict[tuple[str, ...], str]()
        for columns in combinations(coordinates, count):
            total = ""
            for k, column in enumerate(columns):
                term = f"m_{row}{column} * {minors[*columns[:k], *columns[k + 1 :]]}"
                total += f" {'-' if k % 2 else '+'} {term}" if total else term
            name = "f_det" if count == len(coordinates) else f"f_minor{len(lines)}"
            longer[columns] = name
            lines.append(f"{name} = {total}")
        minors = longer
    return lines or [f"f_det = m_{last}{last}"]


def _form(coordinates: Sequence[str]) -> list[str]:
    """Return the statements of MᵀΩM, of its Pfaffian (by expansion along the first row), and of
    `form_top`."""
    n, lines = len(coordinates) // 2, []
    pairs = list(zip(coordinates[:n], coordinates[n:], strict=True))
    above_diagonal = list(combinations(coordinates, 2))
    for a, b in above_diagonal:
        parts = (f"m_{p}{a} * m_{q}{b} - m_{q}{a} * m_{p}{b}" for p, q in pairs)
        lines.append(f"f_form_{a}{b} = {' + '.join(parts)}")
    minors: dict[tuple[str, ...], str] = {}

    def minor(rows: tuple[str, ...]) -> str:
        row, *others = rows
        if len(others) == 1:
            ascending = (row, others[0]) in above_diagonal
            return f"f_form_{row}{others[0]}" if ascending else f"(-f_form_{others[0]}{row})"
        if rows not in minors:
            total = ""
            for k, other in enumerate(others):
                term = f"{minor((row, other))} * {minor((*others[:k], *others[k + 1 :]))}"
                total += f" {'-' if k % 2 else '+'} {term}" if total else term
            minors[rows] = f"f_minor{len(minors)}"
            lines.append(f"{minors[rows]} = {total}")
        return minors[rows]

    lines.append(f"f_det = {minor(tuple(name for pair in pairs for name in pair))}")
    squares = (f"f_form_{a}{b} * f_form_{a}{b}" for a, b in above_diagonal)
    return [*lines, f"f_all = {' + '.join(squares)}", "if f_all > form_top: form_top = f_all"]
