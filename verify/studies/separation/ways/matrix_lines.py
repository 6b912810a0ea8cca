"""What a kernel carries of matrices, at each float64 state z̃ of a run in n degrees of freedom.

With K = J − 1 of the step, by the derivatives of the step's own operations, and the symplectic
defect S of the step, as the float64 kernel of `verify run` has them, bit for bit:

    w_trajectory  M ← M + K M with K exactly at z̃
    w_clock       the same of a wide state that steps by float64's clock
    w_factors     M ← J̃ M exactly, J̃ the float64 matrix 1 + K̃, each entry rounded once (plain)
    f_plain       M ← J̃ M in float64: products of rows and columns, added from the left (plain)
    w_m     M ← M + K̃ M exactly, and w_closed  W ← W + MᵀS̃M exactly (closed form)
    f_m     M ← M + K̃ M, and f_closed  W ← W + MᵀS̃M in float64 (closed form)

Of the first four W = MᵀΩM − Ω, which holds exactly for exact products and so cancels nothing that
more digits do not give back; the fourth takes it in float64, as a program would.

Names of entries end in their row and column, M₁₂ of w_trajectory is w_trajectory_0_1.
"""

from collections.abc import Callable, Sequence
from itertools import combinations

from verify.studies.separation.stepper.way import FOLLOWED, Lines, Side

Rows = Sequence[Sequence[str]]  # of names; an empty one is 0


def matrix_lines(narrow: Side, wide: Side | None, clocked: Side | None) -> Lines:
    """The lines of the matrices; `wide` and `clocked` where K is followed exactly."""
    names, closed = narrow.step.coordinates, bool(narrow.step.defect)
    sides = {"trajectory": wide, "clock": clocked}
    products = [f"w_{name}" for name, side in sides.items() if side]
    inside = [x for n, side in sides.items() if side for x in _moved(f"w_{n}", side.slopes)]
    products += ["w_factors", *["w_m"] * closed]
    inside += _plain(narrow) + (_closed(narrow) if closed else [])
    watched = [name for name in products if name != "w_clock"]
    tops, more = _watched(narrow, watched, closed)
    matrices = [*products, "f_plain", *["f_m"] * closed]
    start = {f"{matrix}_{a}_{b}": int(a == b) for matrix in matrices for a, b in _places(names)}
    sums = ("f_closed", "w_closed") * closed
    start |= {f"{w}_{a}_{b}": 0 for w in sums for a, b in _places(names) if a < b}
    followed = tuple(name for name in FOLLOWED if f"w_{name}_0_1" in start)
    return Lines(inside + more, start | dict.fromkeys(tops, 0), followed, closed)


def _places(names: Sequence[str]) -> list[tuple[int, int]]:
    every = range(len(names))
    return [(a, b) for a in every for b in every]


def _sum(row: Sequence[str], column: Sequence[str]) -> str:
    """The sum of products, from the left; terms that are 0 for certain are left out."""
    pairs = zip(row, column, strict=True)
    return " + ".join(f"{a} * {b}" for a, b in pairs if a and b)


def _product(rows: Rows, matrix: str) -> list[list[str]]:
    every = range(len(rows))
    columns = [[f"{matrix}_{c}_{b}" for c in every] for b in every]
    return [[_sum(row, column) for column in columns] for row in rows]


def _moved(matrix: str, slopes: Rows) -> list[str]:
    """M ← M + K M."""
    changed = _product(slopes, matrix)
    return _assigned(matrix, changed, lambda name, change: f"{name} + ({change})")


def _assigned(
    matrix: str, entries: Sequence[Sequence[str]], made: Callable[[str, str], str]
) -> list[str]:
    """All entries are made before the first is assigned; those that do not change are left."""
    places = [(a, b) for a, row in enumerate(entries) for b, entry in enumerate(row) if entry]
    kind = matrix[:2]
    return [
        *(f"{kind}new_{a}_{b} = {made(f'{matrix}_{a}_{b}', entries[a][b])}" for a, b in places),
        *(f"{matrix}_{a}_{b} = {kind}new_{a}_{b}" for a, b in places),
    ]


def _plain(narrow: Side) -> list[str]:
    """J̃ = 1 + K̃ and its products, in float64 and exactly."""
    lines, slopes, rows = [], narrow.slopes, []
    for a, row in enumerate(slopes):
        own = []
        for b, entry in enumerate(row):
            if a == b or entry:
                lines.append(f"f_j_{a}_{b} = " + (f"1.0 + {entry or '0.0'}" if a == b else entry))
                lines.append(f"w_j_{a}_{b} = wide(f_j_{a}_{b})")
            own.append(f"j_{a}_{b}" if a == b or entry else "")
        rows.append(own)
    for matrix in ("w_factors", "f_plain"):
        named = [[name and matrix[:2] + name for name in row] for row in rows]
        lines += _assigned(matrix, _product(named, matrix), lambda _, entry: entry)
    return lines


def _closed(narrow: Side) -> list[str]:
    """M ← M + K̃ M and W ← W + MᵀS̃M, exactly and in float64."""
    slopes, defect = narrow.slopes, narrow.step.defect
    size = len(slopes)
    lines, exact = [], [["" for _ in range(size)] for _ in range(size)]
    for a, row in enumerate(slopes):
        for b, entry in enumerate(row):
            if entry:
                lines.append(f"w_k_{a}_{b} = wide({entry})")
                exact[a][b] = f"w_k_{a}_{b}"
    form = [["" for _ in range(size)] for _ in range(size)]
    for name, at in defect.items():
        i, k = map(int, name.split("_")[1:])
        if not narrow.step.program.is_constant(at, 0):
            form[i][k], form[k][i] = f"w_s_{i}_{k}", f"w_s_{k}_{i}"
            lines += [f"{form[i][k]} = wide({narrow.name(at)})", f"{form[k][i]} = -{form[i][k]}"]
    right, every = _product(form, "w_m"), range(size)
    lines += [f"w_r_{a}_{b} = {right[a][b]}" for a in every for b in every if right[a][b]]
    for a in every:
        for b in range(a + 1, size):
            terms = [f"w_m_{c}_{a} * w_r_{c}_{b}" for c in range(size) if right[c][b]]
            if terms:
                lines.append(f"w_closed_{a}_{b} = w_closed_{a}_{b} + ({' + '.join(terms)})")
            lines.append(f"f_closed_{a}_{b} = f_closed_{a}_{b} + ({narrow.output(f'dw_{a}_{b}')})")
    lines += _moved("w_m", exact)
    lines += [
        f"f_m_{a}_{b} = f_m_{a}_{b} + ({narrow.output(f'dm_{a}_{b}')})"
        for a in every
        for b in every
    ]
    return lines


def _watched(narrow: Side, products: Sequence[str], closed: bool) -> tuple[list[str], list[str]]:
    """What a bound needs of every step, in float64: the greatest ‖M‖² of each product and
    ‖MᵀΩM − Ω‖², and the greatest ‖J̃‖², ‖K̃‖² and ‖S̃‖². The names that carry it, and lines."""
    names, tops, lines = narrow.step.coordinates, list[str](), list[str]()
    size, half = len(names), len(names) // 2

    def keep(name: str, value: str) -> None:
        tops.append(name)
        lines.append(f"f_seen = {value}")
        lines.append(f"if not f_seen <= {name}: {name} = f_seen")

    def squares(entries: Sequence[str]) -> str:
        return " + ".join(f"{x} * {x}" for x in entries if x) or "0.0"

    for matrix in products:
        lines += [f"f_x_{a}_{b} = approx({matrix}_{a}_{b})" for a, b in _places(names)]
        keep(f"f_{matrix[2:]}_norm", squares([f"f_x_{a}_{b}" for a, b in _places(names)]))
        places = list(combinations(range(size), 2))
        for a, b in places:
            areas = (
                f"f_x_{i}_{a} * f_x_{half + i}_{b} - f_x_{half + i}_{a} * f_x_{i}_{b}"
                for i in range(half)
            )
            lines.append(f"f_y_{a}_{b} = {' + '.join(areas)}{' - 1.0' * (b == half + a)}")
        # In chaos W may be as large as its root is float64's range: there is no bound then anyway.
        form = squares([f"f_y_{a}_{b}" for a, b in places])
        keep(f"f_{matrix[2:]}_form", f"min(2.0 * ({form}), 1e300)")
    slopes = narrow.slopes
    jacobian = [f"f_j_{a}_{b}" for a, b in _places(names) if a == b or slopes[a][b]]
    keep("f_j_norm", squares(jacobian))
    if closed:
        keep("f_k_norm", squares([x for row in slopes for x in row]))
        defect = [narrow.name(at) for at in narrow.step.defect.values()]
        keep("f_s_norm", f"2.0 * ({squares(defect)})")
    return tops, lines
