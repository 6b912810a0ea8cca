"""The tangent map carried along an orbit in float64: how a small error of the state grows.

M₀ = 1 and M_{k+1} = A_k M_k, with A_k the Jacobian of one step at the orbit's k-th state. A_k − 1
is evaluated at the state rounded to float64, and its product with M is added in twice the precision
(Knuth's two-sum), so that one step's error is about h·2⁻⁵³ of M. `verify.runs.a_posteriori` bounds
the orbit's error by what is summed here: `growth` Σ ‖M‖², `growth_top` its greatest term, `det_low`
the least det M, and the box that the orbit has visited; the kernel adds `least` and `most`, between
which Λ has been.
"""

import math
from collections.abc import Sequence
from fractions import Fraction

from verify.kernels.lowering import Lowering
from verify.kernels.program import Evaluator, Program
from verify.schemes.step_map import Substep

NAMES = ("growth", "growth_top", "det_low", "p_low", "p_high", "q_low", "q_high", "least", "most")
_ENTRIES = ("pp", "pq", "qp", "qq")
# Names and initial values, float64 all; "p" and "q" are the initial state.
CARRIED: tuple[tuple[str, int | str], ...] = (
    ("m_pp", 1), ("m_pq", 0), ("m_qp", 0), ("m_qq", 1),
    *((f"m_{entry}_rest", 0) for entry in _ENTRIES),
    ("growth", 2), ("growth_top", 2), ("det_low", 1),
    ("p_low", "p"), ("p_high", "p"), ("q_low", "q"), ("q_high", "q"),
)  # fmt: skip


def nearest_double(value: Fraction) -> float:
    """The nearest float64; infinite beyond their range, where the run then ends."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def product(program: Program, x: Sequence[int], y: Sequence[int]) -> list[int]:
    """The 2 × 2 matrix product x y, row by row."""
    add, mul = program.add, program.mul
    return [add(mul(x[2 * i], y[j]), mul(x[2 * i + 1], y[2 + j])) for i in (0, 1) for j in (0, 1)]


class Tangent:
    """Collects A − 1 of the whole step, substep by substep."""

    def __init__(self, main: Program) -> None:
        self.main, self.program = main, Program()
        self.needed: list[int] = []  # values of the main program that are read
        self.change = [self.program.constant(Fraction(0))] * 4

    def follow(self, step: Substep, evaluator: Evaluator) -> None:
        """Composes the change with a substep's own, where `evaluator` writes the main program."""
        a, b, c, d = step.jacobian
        entries = [a - 1, b, c, d - 1]
        own = Evaluator(self.program, step.ring, {}, pipelined=True)
        for generator in step.ring.generators_in(*entries):
            at = evaluator.at(generator)
            self.needed.append(at)
            own.set(generator, self.program.input(f"approx(v{at})", static=self.main.static[at]))
        x, y = [own.evaluate(entry) for entry in entries], self.change
        add = self.program.add
        both = zip(x, y, product(self.program, x, y), strict=True)
        self.change = [add(add(a, b), c) for a, b, c in both]

    @property
    def lowering(self) -> Lowering:
        return Lowering(self.program, (), "t")


def statements(change: Sequence[str]) -> list[str]:
    """M ← M + (A − 1) M and what is summed; `change` names the entries of A − 1, row by row."""
    lines = [
        "fp = approx(p)",
        "fq = approx(q)",
        *(f"if f{n} < {n}_low: {n}_low = f{n}" for n in "pq"),
        *(f"if f{n} > {n}_high: {n}_high = f{n}" for n in "pq"),
    ]
    for i, row in enumerate("pq"):
        for column in "pq":
            moved = f"{change[2 * i]} * m_p{column} + {change[2 * i + 1]} * m_q{column}"
            lines.append(f"f_{row}{column} = m_{row}{column}_rest + ({moved})")
    for entry in _ENTRIES:
        m, move = f"m_{entry}", f"f_{entry}"
        lines += [
            f"f_total = {m} + {move}",
            f"f_part = f_total - {m}",
            f"{m}_rest = ({m} - (f_total - f_part)) + ({move} - f_part)",
            f"{m} = f_total",
        ]
    return [
        *lines,
        "f_size = (m_pp * m_pp + m_pq * m_pq) + (m_qp * m_qp + m_qq * m_qq)",
        "f_det = m_pp * m_qq - m_pq * m_qp",
        "growth = growth + f_size",
        "if f_size > growth_top: growth_top = f_size",
        "if f_det < det_low: det_low = f_det",
    ]
