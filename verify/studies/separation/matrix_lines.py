"""The matrices that a kernel carries at each float64 state z̃ of a run in n degrees of freedom.

K = J − 1 of the step comes from the derivatives of the step's own operations, S = JᵀΩJ − Ω is its
symplectic defect; K̃ and S̃ are those of the float64 kernel of `verify run`, bit for bit. Names that
begin with w are wide numbers, of many digits, and those that begin with f are float64:

    w_trajectory  M ← M + K M with K exactly at z̃
    w_clock       the same of a wide state that steps by float64's clock
    w_factors     M ← J̃ M exactly, J̃ the float64 matrix 1 + K̃, each entry rounded once (plain)
    f_plain       M ← J̃ M in float64: products of rows and columns, added from the left (plain)
    w_m           M ← M + K̃ M exactly, and w_closed  W ← W + MᵀS̃M exactly (closed form)
    f_m           M ← M + K̃ M, and f_closed  W ← W + MᵀS̃M in float64 (closed form)

The first four are matrices M, and W = MᵀΩM − Ω is computed from each. That is exact for an exact
product: the difference cancels digits, which more digits give back. W of f_plain is computed in
float64, as a program would.

Names of entries end in their row and column, from 0: M₁₂ of w_trajectory is w_trajectory_0_1.
"""

from collections.abc import Sequence
from itertools import combinations, product

from verify.studies.separation.way import FOLLOWED, KernelLines, Side

Rows = Sequence[Sequence[str]]  # a matrix of names; an empty name is the entry 0


def matrix_lines(narrow: Side, wide: Side | None, clocked: Side | None) -> KernelLines:
    """Return the lines of the matrices.

    `narrow`: the step in float64; `wide`: with K in wide numbers at float64's states; `clocked`:
    with K along the wide state that steps at the times of float64's clock.
    """
    names, closed = narrow.step.coordinates, bool(narrow.step.defect)
    sides = {"trajectory": wide, "clock": clocked}
    products = [f"w_{name}" for name, side in sides.items() if side]
    inside = [x for n, side in sides.items() if side for x in _update_lines(f"w_{n}", side.slopes)]
    products += ["w_factors", *["w_m"] * closed]
    inside += _plain_lines(narrow.slopes) + (_closed_form_lines(narrow) if closed else [])
    watched_products = [name for name in products if name != "w_clock"]
    tops, watch_lines = _watch_lines(narrow, watched_products, closed)
    matrices = [*products, "f_plain", *["f_m"] * closed]
    start = {f"{matrix}_{a}_{b}": int(a == b) for matrix in matrices for a, b in _places(names)}
    sums = ("f_closed", "w_closed") * closed
    start |= {f"{w}_{a}_{b}": 0 for w in sums for a, b in _places(names) if a < b}
    followed = tuple(name for name in FOLLOWED if f"w_{name}_0_1" in start)
    return KernelLines(inside + watch_lines, start | dict.fromkeys(tops, 0), followed, closed)


def _places(rows: Sequence[object]) -> list[tuple[int, int]]:
    return [(a, b) for a, b in product(range(len(rows)), repeat=2)]


def _sum(row: Sequence[str], column: Sequence[str]) -> str:
    """Return the sum of products, from the left, without terms that are 0 for certain."""
    pairs = zip(row, column, strict=True)
    return " + ".join(f"{a} * {b}" for a, b in pairs if a and b)


def _product(rows: Rows, matrix: str) -> list[list[str]]:
    every = range(len(rows))
    columns = [[f"{matrix}_{c}_{b}" for c in every] for b in every]
    return [[_sum(row, column) for column in columns] for row in rows]


def _update_lines(matrix: str, slopes: Rows) -> list[str]:
    """Return the lines of M ← M + K M."""
    return _assign_lines(matrix, _product(slopes, matrix), "{name} + ({entry})")


def _assign_lines(matrix: str, entries: Rows, template: str = "{entry}") -> list[str]:
    """Return lines that compute all entries before they assign the first.

    An entry with an empty formula is left out, and keeps its value. `template`: the new value's
    formula, by the entry's `name` and its formula `entry`.
    """
    # The prefix f_ or w_ of the new names follows that of the matrix: it selects the arithmetic.
    kind, places = matrix[:2], [(a, b) for a, b in _places(entries) if entries[a][b]]
    after = (template.format(name=f"{matrix}_{a}_{b}", entry=entries[a][b]) for a, b in places)
    return [
        *(f"{kind}new_{a}_{b} = {x}" for (a, b), x in zip(places, after, strict=True)),
        *(f"{matrix}_{a}_{b} = {kind}new_{a}_{b}" for a, b in places),
    ]


def _widen_lines(matrix: str, entries: Rows) -> tuple[list[str], list[list[str]]]:
    """Return the lines that convert float64's entries to wide numbers, and the names of these."""
    names = [[x and f"{matrix}_{a}_{b}" for b, x in enumerate(r)] for a, r in enumerate(entries)]
    places = [(a, b) for a, b in _places(entries) if entries[a][b]]
    return [f"{names[a][b]} = wide({entries[a][b]})" for a, b in places], names


def _plain_lines(slopes: Rows) -> list[str]:
    """Return the lines of J̃ = 1 + K̃ and its products, in float64 and in wide numbers."""
    entries = {(a, b): slopes[a][b] for a, b in _places(slopes) if a == b or slopes[a][b]}
    for k in range(len(slopes)):
        entries[k, k] = f"1.0 + {slopes[k][k] or '0.0'}"
    rows = [["" for _ in slopes] for _ in slopes]
    for a, b in entries:
        rows[a][b] = f"f_j_{a}_{b}"
    lines, wide_names = _widen_lines("w_j", rows)
    return [
        *(f"f_j_{a}_{b} = {entry}" for (a, b), entry in entries.items()),
        *lines,
        *_assign_lines("w_factors", _product(wide_names, "w_factors")),
        *_assign_lines("f_plain", _product(rows, "f_plain")),
    ]


def _closed_form_lines(narrow: Side) -> list[str]:
    """Return the lines of M ← M + K̃ M and W ← W + MᵀS̃M, in wide numbers and in float64."""
    indices, places = range(len(narrow.slopes)), _places(narrow.slopes)
    lines, wide_names = _widen_lines("w_k", narrow.slopes)
    form = [["" for _ in indices] for _ in indices]
    for name, index in narrow.step.defect.items():
        a, b = map(int, name.split("_")[1:])
        if not narrow.step.program.is_constant(index, 0):
            form[a][b], form[b][a] = f"w_s_{a}_{b}", f"w_s_{b}_{a}"
            lines += [f"{form[a][b]} = wide({narrow.name(index)})", f"{form[b][a]} = -{form[a][b]}"]
    right = _product(form, "w_m")
    lines += [f"w_r_{a}_{b} = {right[a][b]}" for a, b in places if right[a][b]]
    for a, b in combinations(indices, 2):
        column = [f"w_r_{c}_{b}" if right[c][b] else "" for c in indices]
        term = _sum([f"w_m_{c}_{a}" for c in indices], column)
        lines += [f"w_closed_{a}_{b} = w_closed_{a}_{b} + ({term})"] if term else []
        lines.append(f"f_closed_{a}_{b} = f_closed_{a}_{b} + ({narrow.output(f'dw_{a}_{b}')})")
    lines += _update_lines("w_m", wide_names)
    return lines + [f"f_m_{a}_{b} = f_m_{a}_{b} + ({narrow.output(f'dm_{a}_{b}')})"
                    for a, b in places]  # fmt: skip


def _watch_lines(
    narrow: Side, products: Sequence[str], closed: bool
) -> tuple[list[str], list[str]]:
    """Return the names and lines of the maxima that a bound needs of every step, in float64.

    They are the greatest ‖M‖² of each product and ‖MᵀΩM − Ω‖², and the greatest ‖J̃‖², ‖K̃‖² and
    ‖S̃‖².
    """
    names, tops, lines = narrow.step.coordinates, list[str](), list[str]()
    size, half = len(names), len(names) // 2

    def keep(name: str, value: str) -> None:
        tops.append(name)
        lines.append(f"f_seen = {value}")
        # Written with `not`, so that a nan is kept and voids the bound.
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
        # In chaos ‖W‖² may overflow: it is cut, as there is no bound then anyway.
        form = squares([f"f_y_{a}_{b}" for a, b in places])
        keep(f"f_{matrix[2:]}_form", f"min(2.0 * ({form}), 1e300)")
    slopes = narrow.slopes
    jacobian = [f"f_j_{a}_{b}" for a, b in _places(names) if a == b or slopes[a][b]]
    keep("f_j_norm", squares(jacobian))
    if closed:
        keep("f_k_norm", squares([x for row in slopes for x in row]))
        defect = [narrow.name(index) for index in narrow.step.defect.values()]
        keep("f_s_norm", f"2.0 * ({squares(defect)})")
    return tops, lines
