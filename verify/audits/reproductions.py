"""Reproductions: a few lines of Python that show a finding on another library's code or table.

They need nothing of this package.
"""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.splitting_claims import timed_parts
from verify.schemes.printed.splitting_table import PrintedTable

Point = tuple[Fraction, ...]  # p, then q
_DIGITS = 45
_WIDTH = 88
_INTEGER = re.compile(r"(?<![\w.])\d+(?![\w.])")

_SERIES = """\


def mul(x, y):  # of series in h, cut off after h^ORDER
    return [sum(x[i] * y[k - i] for i in range(k + 1)) for k in range(ORDER + 1)]


def force(q):  # V = q²/2 + q³/3
    return [-a - b for a, b in zip(q, mul(q, q))]


def speed(p):  # T = {kinetic}
    return {speed}


def begin():
    return [F(1)] + ORDER * [F(0)], [F(1, 2)] + ORDER * [F(0)]


def step(sizes):
    p, q = begin()
    for kind, size in sizes:
        if kind == "kick":
            p = [a + size * b for a, b in zip(p, [0, *force(q)])]
        else:
            q = [a + size * b for a, b in zip(q, [0, *speed(p)])]
    return p + q


def flow():
    p, q = begin()
    for k in range(ORDER):
        p[k + 1], q[k + 1] = force(q)[k] / (k + 1), speed(p)[k] / (k + 1)
    return p + q


# the largest coefficient of 1 … h^ORDER by which a step differs from the flow: 0 for exact numbers
for name, numbers in ({shown}):
    print(name, float(max(abs(a - b) for a, b in zip(step(parts(*numbers)), flow()))))"""

_ORDER = """


def error(h{begin}):  # of one step, against 64 steps of h / 64
    x, y = step({p}, {q}, {at}h), ({p}, {q})
    for {turn} in range(64):
        y = step(*y, {moment}h / 64)
    return {distance}


# the error of one step is O(h^r), r = order + 1{claimed}
print([(h, math.log2(error(h) / error(h / 2))) for h in ({sizes})])"""
_STILL = {"begin": "", "at": "", "turn": "_", "moment": "", "sizes": "1.0, 0.5, 0.25"}
_IN_TIME = {"begin": ", t=0.75", "at": "t, ", "turn": "k", "moment": "t + k * h / 64, ",
            "sizes": "0.5, 0.25, 0.125"}  # fmt: skip

_AREA = """


def det_j(p, q, h, d=2.0**-10):  # by differences of the second order, so that d² is its error
    a, b = step(p + d, q, h), step(p - d, q, h)
    e, f = step(p, q + d, h), step(p, q - d, h)
    return ((a[0] - b[0]) * (e[1] - f[1]) - (a[1] - b[1]) * (e[0] - f[0])) / (4 * d * d)


# claimed: 1
print([(h, det_j({p}, {q}, h)) for h in (1.0, 0.5, 0.25)])"""

_SYMPLECTIC = """


def defect(p, q, h, d=2.0**-10):  # of J^T W J = W, by differences of the second order
    z, n = np.concatenate([p, q]), len(p)
    ends = [[np.concatenate(step(*np.split(z + s * d * e, 2), h)) for s in (1, -1)]
            for e in np.eye(2 * n)]
    J = np.array([(a - b) / (2 * d) for a, b in ends]).T
    W = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    return np.abs(J.T @ W @ J - W).max()


# claimed: 0
print([(h, defect({p}, {q}, h)) for h in (1.0, 0.5, 0.25)])"""


def write_digits_program(
    table: PrintedTable, nearest: Mapping[str, Fraction] | None, order: int
) -> str:
    """Write a program that prints by how much one step with the printed digits, and one with the
    nearest exact numbers where they are known, differ from the flow of one H, in exact
    fractions."""
    quadratic = table.kind == "nystrom"
    names = ", ".join(table.printed.units)
    printed = _wrap_items(
        [f'F("{table.printed.numbers[name].strip()}")' for name in table.printed.units], "    "
    )
    nearest_texts = ",\n    ".join(
        f'F("{decimal(nearest[n], _DIGITS)}")' for n in table.printed.units if nearest
    )
    exact_lines = [
        f"    {n} = {_with_fractions(x)}"
        for n, x in table.printed.numbers.items()
        if n not in table.printed.units
    ]
    lines = [
        "from fractions import Fraction as F",
        "",
        f"ORDER = {order}",
        f"printed = [\n{printed}\n]",
        *([f"nearest = [\n    {nearest_texts},\n]"] if nearest else []),
        "",
        "",
        f"def parts({names}):",
        *exact_lines,
        *_parts(table),
    ]
    kinetic = "p²/2" if quadratic else "p²/2 + p³/3"
    speed = "p" if quadratic else "[a + b for a, b in zip(p, mul(p, p))]"
    compared_rows = (
        '("printed", printed), ("nearest exact", nearest)' if nearest else '("printed", printed),'
    )
    return (
        "\n".join(lines) + "\n" + _SERIES.format(kinetic=kinetic, speed=speed, shown=compared_rows)
    )


def _parts(table: PrintedTable) -> list[str]:
    """Write the kicks and drifts; a composition is one of kick–drift–kick."""
    if table.kind != "composition":
        items = _wrap_items(
            [f'("{kind}", {_with_fractions(size)})' for kind, size in table.parts], " " * 8
        )
        return [f"    return [\n{items}\n    ]"]
    items = _wrap_items([_with_fractions(size) for _, size in table.parts], " " * 8)
    return [
        f"    w = [\n{items}\n    ]",
        '    kdk = ("kick", F(1, 2)), ("drift", F(1)), ("kick", F(1, 2))',
        "    return [(kind, share * x) for x in w for kind, share in kdk]",
    ]


def _wrap_items(items: Sequence[str], indent: str) -> str:
    """Join the items with commas, on lines that are not too long."""
    lines = [indent]
    for item in items:
        if len(lines[-1]) + len(item) > _WIDTH and lines[-1] != indent:
            lines.append(indent)
        lines[-1] += f"{item}, "
    return "\n".join(line.rstrip() for line in lines)


def _with_fractions(size: str) -> str:
    """Write a formula whose quotients are no floats."""
    return _INTEGER.sub(r"F(\g<0>)", size)


def write_order_program(code: str, point: Point, order: int, timed: bool = False) -> str:
    """Append the slopes of its error to `code`, which defines step(p, q, h), or step(p, q, t,
    h)."""
    clock, claimed = _IN_TIME if timed else _STILL, f"; claimed: order {order}"
    return _with(code, _ORDER.format(**_start(point), **clock, claimed=claimed))


def _start(point: Point) -> dict[str, str]:
    """Write p and q, of several degrees of freedom as arrays, and the distance of two states x and
    y."""
    half = len(point) // 2
    if half == 1:
        p, q = map(float, point)
        apart = "max(abs(x[0] - y[0]), abs(x[1] - y[1]))"
        return {"p": repr(p), "q": repr(q), "distance": apart}
    momenta, displacements = ([float(x) for x in part] for part in (point[:half], point[half:]))
    apart = "np.abs(np.subtract(x, y)).max()"
    return {"p": f"np.array({momenta})", "q": f"np.array({displacements})", "distance": apart}


def write_time_program(code: str, point: Point) -> str:
    """Append the slopes to `code`, which defines step(p, q, t, h), where no order is claimed."""
    return _with(code, _ORDER.format(**_start(point), **_IN_TIME, claimed=""))


def write_area_program(code: str, point: Point) -> str:
    """Append to `code`, which defines step(p, q, h), the determinant of its Jacobian, or of several
    degrees of freedom the largest entry of JᵀΩJ − Ω."""
    tail = _AREA if len(point) == 2 else _SYMPLECTIC
    return _with(code, tail.format(**_start(point)))


def write_clock_program(entry: TableEntry) -> str:
    """Write the step of a splitting with its printed clock, for a driven pendulum, and the slopes
    of its error; empty for a table without one."""
    parts = timed_parts(entry)
    if not parts:
        return ""
    rows = ",\n".join(f'    ("{kind}", {size!r}, {time!r})' for kind, size, time in parts)
    code = f"""\
import math

parts = [  # kick or drift, its size, and the time that it reads, in parts of h
{rows},
]


def step(p, q, t, h):  # H = (1 + cos(t)/4) (p**4/4 + p**2/2) - (1 + cos(2*t)/2) cos(q)
    for kind, a, s in parts:
        if kind == "kick":
            p -= a * h * (1 + math.cos(2 * (t + s * h)) / 2) * math.sin(q)
        else:
            q += a * h * (1 + math.cos(t + s * h) / 4) * (p + p**3)
    return p, q
"""
    return write_time_program(code, (Fraction(1, 3), Fraction(3, 5)))


def _with(code: str, tail: str) -> str:
    if not code:
        return ""
    imported = "" if re.search(r"^import math$", code, re.MULTILINE) else "import math\n"
    return f"{imported if 'math.' in tail else ''}{code.rstrip()}\n{tail}"
