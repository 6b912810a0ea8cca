"""One loop in which float64 and exact arithmetic stand side by side, in n degrees of freedom.

At each float64 state z̃ of a run it has K = J − 1 of the step, by the derivatives of the step's own
operations, and the symplectic defect S of the step, as the float64 kernel of `verify run` has them,
bit for bit, and the links of `verify.studies.separation.form_chain`:

    w_t  M ← M + K M with K exactly at z̃ (trajectory)
    w_n  M ← J̃ M exactly, J̃ the float64 matrix 1 + K̃, each entry rounded once (derivatives, plain)
    f_n  M ← J̃ M in float64: products of rows and columns, added from the left (plain)
    w_m  M ← M + K̃ M exactly, and w_w  W ← W + MᵀS̃M exactly (derivatives, closed form)
    f_m  M ← M + K̃ M, and f_w  W ← W + MᵀS̃M in float64 (closed form)

Of the first three W = MᵀΩM − Ω, which holds exactly for exact products and so cancels nothing that
more digits do not give back; the third takes it in float64, as a program would.

Where H depends on time float64 has a clock, f_t ← f_t + f_h; a wide state of its own that steps by
it (names that begin with `w_at_`) has the product w_c.

The source's language is that of `verify.studies.separation.kernel`; names of entries end in their
row and column, M₁₂ of w_t is w_t_0_1.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import Computation, Observed, computed, step_map_of
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.program import Program
from verify.observables.observable import Need
from verify.studies.separation.kernel import AT, Mixed, assemble, box_of, prefixed_lines, scope_of

Rows = Sequence[Sequence[str]]  # of names; an empty one is 0


@dataclass(frozen=True)
class FormKernel(Mixed):
    """`products`: the letters of the matrices that are carried, as `w_t`. `wide`: what the wide
    lines compute at z̃, with K's entries `slopes`."""

    coordinates: tuple[str, ...]
    products: tuple[str, ...]
    wide: "Step"


@dataclass(frozen=True)
class Step:
    """A step's program, with the indices of K's entries."""

    made: Computation
    program: Program
    slopes: tuple[tuple[int, ...], ...]

    @classmethod
    def of(cls, hamiltonian: Hamiltonian, scheme: str, *, pipelined: bool, form: bool) -> "Step":
        """The step of a scheme; `form`: with S, M and W.

        Raises NotImplementedError where a step solves equations."""
        step = step_map_of(hamiltonian, scheme)
        needs: frozenset[Need] = frozenset({"symplectic", "carried"} if form else ())
        asked = Observed(pipelined=pipelined, scaled=False, tangent=False, needs=needs, slopes=True)
        made = computed(step, asked)
        return cls(made, made.program, tuple(map(tuple, made.slopes)))

    def names(self, prefix: str) -> Rows:
        """K's entries by their names in the source."""
        zero = self.program.is_constant
        return [["" if zero(at, 0) else f"{prefix}v{at}" for at in row] for row in self.slopes]

    def roots(self) -> list[int]:
        return [at for row in self.slopes for at in row]


@lru_cache(maxsize=16)
def form_kernel(
    hamiltonian: Hamiltonian, scheme: str, arithmetic: Arithmetic, follow: bool
) -> FormKernel:
    """The kernel for a generic Hamiltonian; `follow`: with K exactly at the float64 states.

    Raises NotImplementedError where a step solves equations.
    """
    working, closed = float64.make(17), not step_map_of(hamiltonian, scheme).preserves_area
    narrow = Step.of(hamiltonian, scheme, pipelined=working.pipelined, form=closed)
    wide = Step.of(hamiltonian, scheme, pipelined=arithmetic.pipelined, form=False)
    names, timed = narrow.made.coordinates, hamiltonian.time_dependent
    outputs = narrow.made.outputs
    roots = [*narrow.roots(), *outputs.values(), *narrow.made.defect.values()]
    before, inside = prefixed_lines(narrow.program, roots, working, "f_")
    products = ["f_n", "w_n"]
    moves: list[str] = []
    if follow:
        static, dynamic = prefixed_lines(wide.program, wide.roots(), arithmetic, "w_")
        before += static
        inside += [f"w_{n} = wide(f_{n})" for n in (*names, *("t" * timed))] + dynamic
        moves += _moved("w_t", wide.names("w_"))
        products.append("w_t")
    if follow and timed:
        before += [f"{AT}{n} = w_{n}" for n in _given(narrow)]
        roots = [*wide.roots(), *(wide.made.outputs[f"d{n}"] for n in names)]
        static, dynamic = prefixed_lines(wide.program, roots, arithmetic, AT)
        before, inside = before + static, [*inside, f"{AT}t = w_t", *dynamic]
        moves += _moved("w_c", wide.names(AT))
        moves += [f"{AT}{n} = {AT}{n} + ({AT}v{wide.made.outputs[f'd{n}']})" for n in names]
        products.append("w_c")
    moves += _plain(narrow)
    if closed:
        moves += _closed(narrow)
        products += ["f_m", "w_m"]
    moves += [f"f_{n} = f_{n} + (f_v{outputs[f'd{n}']})" for n in names]
    moves += ["f_t = f_t + f_h"] * timed
    tops, watched = _watched(narrow, [x for x in products if x in ("w_n", "w_t", "w_m")], closed)
    regions = [f"f_{n}" for n in names]
    inside = [line for name in regions for line in box_of(name)] + inside
    moves += watched
    start = {f"{matrix}_{a}_{b}": int(a == b) for matrix in products for a, b in _places(names)}
    sums = ("f_w", "w_w") * closed
    start |= {f"{w}_{a}_{b}": 0 for w in sums for a, b in _places(names) if a < b}
    states = (
        *(f"f_{n}" for n in (*names, *("t" * timed))),
        *(f"{AT}{n}" for n in names if follow and timed),
        *start,
        *(f"{name}_{side}" for name in regions for side in ("low", "high")),
        *tops,
    )
    source = assemble(len(narrow.made.parameters), (), states, before, [*inside, *moves])
    constants = _constants(narrow, working), _constants(wide, arithmetic)
    scope = scope_of(working, constants[0], arithmetic, constants[1])
    function = arithmetic.compile(source, "kernel", scope)
    return FormKernel(
        function, narrow.made.parameters, states, start | dict.fromkeys(tops, 0), closed, source,
        names, tuple(products), wide,
    )  # fmt: skip


def _given(narrow: Step) -> list[str]:
    return ["h", *(f"x{k}" for k in range(len(narrow.made.parameters)))]


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


def _plain(narrow: Step) -> list[str]:
    """J̃ = 1 + K̃ and its products, in float64 and exactly."""
    lines, slopes, rows = [], narrow.names("f_"), []
    for a, row in enumerate(slopes):
        own = []
        for b, entry in enumerate(row):
            if a == b or entry:
                lines.append(f"f_j_{a}_{b} = " + (f"1.0 + {entry or '0.0'}" if a == b else entry))
                lines.append(f"w_j_{a}_{b} = wide(f_j_{a}_{b})")
            own.append(f"j_{a}_{b}" if a == b or entry else "")
        rows.append(own)
    for kind in ("w_", "f_"):
        named = [[name and kind + name for name in row] for row in rows]
        lines += _assigned(f"{kind}n", _product(named, f"{kind}n"), lambda _, entry: entry)
    return lines


def _closed(narrow: Step) -> list[str]:
    """M ← M + K̃ M and W ← W + MᵀS̃M, exactly and in float64."""
    slopes, outputs, defect = narrow.names("f_"), narrow.made.outputs, narrow.made.defect
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
        if not narrow.program.is_constant(at, 0):
            form[i][k], form[k][i] = f"w_s_{i}_{k}", f"w_s_{k}_{i}"
            lines += [f"{form[i][k]} = wide(f_v{at})", f"{form[k][i]} = -{form[i][k]}"]
    right, every = _product(form, "w_m"), range(size)
    lines += [f"w_r_{a}_{b} = {right[a][b]}" for a in every for b in every if right[a][b]]
    for a in every:
        for b in range(a + 1, size):
            terms = [f"w_m_{c}_{a} * w_r_{c}_{b}" for c in range(size) if right[c][b]]
            if terms:
                lines.append(f"w_w_{a}_{b} = w_w_{a}_{b} + ({' + '.join(terms)})")
            lines.append(f"f_w_{a}_{b} = f_w_{a}_{b} + (f_v{outputs[f'dw_{a}_{b}']})")
    lines += _moved("w_m", exact)
    lines += [
        f"f_m_{a}_{b} = f_m_{a}_{b} + (f_v{outputs[f'dm_{a}_{b}']})" for a in every for b in every
    ]
    return lines


def _watched(narrow: Step, products: Sequence[str], closed: bool) -> tuple[list[str], list[str]]:
    """What a bound needs of every step, in float64: the greatest ‖M‖² of each product and
    ‖MᵀΩM − Ω‖², and the greatest ‖J̃‖², ‖K̃‖² and ‖S̃‖². The names that carry it, and lines."""
    names, tops, lines = narrow.made.coordinates, list[str](), list[str]()
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
    slopes = narrow.names("f_")
    jacobian = [f"f_j_{a}_{b}" for a, b in _places(names) if a == b or slopes[a][b]]
    keep("f_j_norm", squares(jacobian))
    if closed:
        keep("f_k_norm", squares([x for row in slopes for x in row]))
        defect = [f"f_v{at}" for at in narrow.made.defect.values()]
        keep("f_s_norm", f"2.0 * ({squares(defect)})")
    return tops, lines


def _constants(step: Step, own: Arithmetic) -> dict[str, Number]:
    return Lowering(step.program, own.functions, bits=own.bits).named_constants(own.number)
