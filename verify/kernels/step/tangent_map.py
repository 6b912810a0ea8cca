"""The tangent map carried along an orbit in float64: how a small error of the state grows.

M₀ = 1 and M_{k+1} = A_k M_k, with A_k the Jacobian of one step at the orbit's k-th state. A_k − 1
is evaluated at the state rounded to float64, and its product with M is added in twice the precision
(Knuth's two-sum), so that one step's error is about h·2⁻⁵³ of M. `verify.runs.a_posteriori` bounds
the orbit's error by what is summed here: `growth` Σ ‖M‖², `growth_top` its greatest term, `det_low`
the least det M, and the box that the orbit has visited; the kernel adds `least` and `most`, between
which Λ has been. In n degrees of freedom det M is Pf(MᵀΩM)/Pf Ω, and `form_top` is the greatest sum
of squares of MᵀΩM's entries above the diagonal.
"""

from collections.abc import Callable, Collection, Sequence
from itertools import combinations

from verify.hamiltonians.coordinates import PLANE
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.program import Program

_SUMS = ("growth", "growth_top", "det_low", "form_top", "least", "most")


def names_of(coordinates: Sequence[str]) -> tuple[str, ...]:
    """What is noted of it, where it is carried."""
    return (*_SUMS, *(f"{name}_{end}" for name in coordinates for end in ("low", "high")))


def carried(coordinates: Sequence[str]) -> list[tuple[str, int | str]]:
    """Names and initial values, float64 all; a coordinate's name is its initial value."""
    size = len(coordinates)
    entries = [row + column for row in coordinates for column in coordinates]
    found: list[tuple[str, int | str]] = [
        (f"m_{entry}", int(k % (size + 1) == 0)) for k, entry in enumerate(entries)
    ]
    found += [(f"m_{entry}_rest", 0) for entry in entries]
    found += [("growth", size), ("growth_top", size), ("det_low", 1)]
    if size > 2:
        found.append(("form_top", size // 2))
    return found + [(f"{name}_{end}", name) for name in coordinates for end in ("low", "high")]


class Tangent:
    """A − 1 of the whole step, row by row, in a float64 program of its own."""

    def __init__(self, main: Program) -> None:
        self.main, self.program = main, Program()
        self.needed: list[int] = []  # values of the main program that are read
        self.change: list[int] = []

    def take(self, change: Sequence[int], points: Collection[int] = ()) -> None:
        """The change as values of the main program: its sums and products are made again in
        float64; all else is read, and so are the coordinates of the points that it is made at."""
        known: dict[int, int] = {}
        program = self.program
        again: dict[str, Callable[..., int]] = {
            "add": program.add, "mul": program.mul, "neg": program.neg,
            "sub": lambda x, y: program.add(x, program.neg(y)),
        }  # fmt: skip
        for index in self.main.live(change):
            op = self.main.ops[index]
            if op.kind == "const":
                known[index] = program.constant(op.value)
            elif index not in points and op.kind in again and all(a in known for a in op.args):
                known[index] = again[op.kind](*(known[a] for a in op.args))
            else:
                known[index] = self._read(index)
        self.change = [known[index] for index in change]
        read = (program.ops[at] for at in program.live(self.change))
        used = {op.name for op in read if op.kind == "input"}
        self.needed = [at for at in self.needed if _read_as(at) in used]

    def _read(self, at: int) -> int:
        """A value of the main program as one of its own."""
        self.needed.append(at)
        return self.program.input(_read_as(at), static=self.main.static[at])

    @property
    def lowering(self) -> Lowering:
        return Lowering(self.program, (), "slope")


def _read_as(at: int) -> str:
    return f"approx(v{at})"


def statements(change: Sequence[str], coordinates: Sequence[str] = PLANE) -> list[str]:
    """M ← M + (A − 1) M and what is summed; `change` names the entries of A − 1, row by row."""
    size = len(coordinates)
    lines = [
        *(f"f{n} = approx({n})" for n in coordinates),
        *(f"if f{n} < {n}_low: {n}_low = f{n}" for n in coordinates),
        *(f"if f{n} > {n}_high: {n}_high = f{n}" for n in coordinates),
    ]
    for i, row in enumerate(coordinates):
        own = change[size * i : size * (i + 1)]
        for column in coordinates:
            parts = (f"{x} * m_{c}{column}" for x, c in zip(own, coordinates, strict=True))
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
        *(_form(coordinates) if size > 2 else [_determinant(*coordinates)]),
        "growth = growth + f_size",
        "if f_size > growth_top: growth_top = f_size",
        "if f_det < det_low: det_low = f_det",
    ]


def _determinant(p: str, q: str) -> str:
    return f"f_det = m_{p}{p} * m_{q}{q} - m_{p}{q} * m_{q}{p}"


def _form(coordinates: Sequence[str]) -> list[str]:
    """MᵀΩM and its Pfaffian, by expansion along the first row that is left."""
    n, lines = len(coordinates) // 2, []
    pairs = list(zip(coordinates[:n], coordinates[n:], strict=True))
    above = list(combinations(coordinates, 2))
    for a, b in above:
        parts = (f"m_{p}{a} * m_{q}{b} - m_{q}{a} * m_{p}{b}" for p, q in pairs)
        lines.append(f"f_form_{a}{b} = {' + '.join(parts)}")
    known: dict[tuple[str, ...], str] = {}

    def minor(rows: tuple[str, ...]) -> str:
        first, *rest = rows
        if len(rest) == 1:
            ascending = (first, rest[0]) in above
            return f"f_form_{first}{rest[0]}" if ascending else f"(-f_form_{rest[0]}{first})"
        if rows not in known:
            total = ""
            for k, other in enumerate(rest):
                term = f"{minor((first, other))} * {minor((*rest[:k], *rest[k + 1 :]))}"
                total += f" {'-' if k % 2 else '+'} {term}" if total else term
            known[rows] = f"f_minor{len(known)}"
            lines.append(f"{known[rows]} = {total}")
        return known[rows]

    lines.append(f"f_det = {minor(tuple(name for pair in pairs for name in pair))}")
    squares = (f"f_form_{a}{b} * f_form_{a}{b}" for a, b in above)
    return [*lines, f"f_all = {' + '.join(squares)}", "if f_all > form_top: form_top = f_all"]
