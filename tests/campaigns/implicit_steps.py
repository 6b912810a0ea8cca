"""Implicit steps that stop at a tolerance: what is said of their ΔJ, beside what it is by mpmath.

    python -m tests.campaigns.implicit_steps --count 200 --seed 1 --jobs 2 --keep DIR

Four methods, solved by fixed point, Newton (with the Jacobian of each iterate, or the first) and
scipy, to 10⁻³ … 10⁻¹⁴, for ten H. ΔJ is that of the program's own operations in 60 digits, at the
place that the answer names; where it names none, at p = 1/7, q = 6/5, h = 1/8, which every command
asks about. Where |ΔJ| exceeds four times the noise that the answer names it has
to be REFUTED, its size within a factor of 2; else the answer may say that it lies within the noise,
or is undecided, and never that it is 0.
"""

import argparse
import importlib.util
import random
import re
import shlex
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath

from tests.campaigns.stepping.asked import Answer, asked
from tests.campaigns.stepping.implicit import METHODS, SOLVERS, SYSTEMS, Implicit, source_of
from tests.campaigns.stepping.truth import DIGITS, in_mpmath

PLACE = {"p": "1/7", "q": "6/5"}
STEP = "1/8"  # where the answer names none
_BEYOND, _WITHIN = 4, 2
_SHOWN = 1e-33  # of a difference in 60 digits, what is no rounding
_ZERO = re.compile(
    r"ΔJ (?:≡|=|is) (?:0|zero|the zero function)\b(?![.,]\d)|det J ≡ 1(?! is claimed)"
)
_ORDERS = range(3, 15)


@dataclass(frozen=True)
class Judged:
    """`delta`: the program's ΔJ at that place, None where the number of iterations changes, or in
    floats nothing is clear; then it is at most `most`, where that is known."""

    step: Implicit
    answer: Answer
    delta: float | None
    command: str
    most: float | None = None

    @property
    def outcome(self) -> str:
        """What is right: "refuted", "in the noise". Wrong: "missed", "size", "zero", "accused".
        "unknown" where no truth, or no noise, is known."""
        said, defect = self.answer.outcome, self.answer.defect
        if said == "error":
            return "error"
        if self.delta is None:
            small = self.most is not None and defect.noise is not None
            below = small and (self.most or 0) <= _BEYOND * (defect.noise or 0)
            return "in the noise" if below and said != "refuted" else "unknown"
        if self.delta and said != "refuted" and self._says_zero:
            return "zero"
        if defect.noise is None:
            return "unknown"
        seen, size = abs(self.delta) > _BEYOND * defect.noise, defect.size or 0
        if said != "refuted":
            return "missed" if seen else "in the noise"
        if abs(self.delta) / _WITHIN <= size <= _WITHIN * abs(self.delta):
            return "refuted" if self.delta else "accused"
        return "size" if seen else "accused"

    @property
    def _says_zero(self) -> bool:
        leading = {str(self.answer.said.get(x)) for x in ("delta_j", "leading")}
        return "0" in leading or _ZERO.search(str(self.answer.said.get("reason"))) is not None

    def __str__(self) -> str:
        defect, delta = self.answer.defect, "unknown" if self.delta is None else f"{self.delta:.2e}"
        return (
            f"{self.outcome}: {self.step}; ΔJ {delta} at {defect.place or PLACE}, "
            f"said {defect.size}, noise {defect.noise}\n    {self.command}\n"
            f"    {self.answer.verdict}: {self.answer.text[:400]}"
        )


def delta_by_mpmath(step: Implicit, place: dict[str, str]) -> float | None:
    """Of the program's own operations, by a difference too small to change its decisions; None
    where it changes them nonetheless."""
    with mpmath.workdps(DIGITS):
        program = in_mpmath(source_of(step))
        p, q, h = (_number(place.get(x, PLACE.get(x, STEP))) for x in "pqh")
        width, counts, iteration, calls = mpmath.mpf(10) ** -22, set[int](), program["g"], [0]

        def counted(*numbers: Any) -> Any:
            calls[0] += 1
            return iteration(*numbers)

        program["g"] = counted

        def end(dp: int, dq: int) -> tuple[Any, Any]:
            calls[0] = 0
            result: tuple[Any, Any] = program["step"](p + dp * width, q + dq * width, h)
            counts.add(calls[0])
            return result

        by_p, by_q = ((end(a, b), end(-a, -b)) for a, b in ((1, 0), (0, 1)))
        (a, c), (b, d) = (
            [(x - y) / (2 * width) for x, y in zip(*ends, strict=True)] for ends in (by_p, by_q)
        )
        delta = a * d - b * c - 1
        if len(counts) > 1:
            return None
        return float(delta) if abs(delta) > _SHOWN else 0.0


def delta_in_floats(step: Implicit, place: dict[str, str]) -> float | None:
    """Of a solver that computes in doubles alone: by differences of three widths, which have to
    agree to a third."""
    least, middle, most = sorted(deltas_in_floats(step, place))
    return middle if most - least < abs(middle) / 3 else None


def deltas_in_floats(step: Implicit, place: dict[str, str]) -> list[float]:
    """By differences of order 6 of three widths."""
    program: dict[str, Any] = {}
    exec(source_of(step), program)  # noqa: S102 - it is written here
    p, q, h = (float(Fraction(place.get(x, PLACE.get(x, STEP)))) for x in "pqh")

    def slope(width: float, a: int, b: int) -> list[float]:
        weights = {1: 45 / 60, 2: -9 / 60, 3: 1 / 60}
        ends = [
            (w * s, program["step"](p + s * k * width * a, q + s * k * width * b, h))
            for k, w in weights.items() for s in (1, -1)
        ]  # fmt: skip
        return [sum(w * end[i] for w, end in ends) / width for i in (0, 1)]

    deltas = []
    for width in (2**-5, 2**-6, 2**-7):
        (a, c), (b, d) = slope(width, 1, 0), slope(width, 0, 1)
        deltas.append(a * d - b * c - 1)
    return deltas


def _number(text: str) -> Any:
    x = Fraction(text)
    return mpmath.mpf(x.numerator) / x.denominator


def judged(step: Implicit, folder: Path, more: Sequence[str] = ()) -> Judged:
    """Writes the program, and asks the command line about it."""
    path = folder / f"{step.name}.py"
    path.write_text(source_of(step), encoding="utf-8")
    energy = ["--hamiltonian", SYSTEMS[step.system]]
    looked_at = [f"--{name}={x}" for name, x in PLACE.items()] + [f"--step-size={STEP}"]
    arguments = ["check-integrator", f"{path}:step", *energy, "--symplectic", *looked_at, *more]
    answer = asked(arguments)
    truth = delta_by_mpmath if step.traceable else delta_in_floats
    place = answer.defect.place
    delta = truth(step, place)
    most = None if step.traceable else min(map(abs, deltas_in_floats(step, place)))
    return Judged(step, answer, delta, shlex.join(["verify", *arguments]), most)


def cases(count: int, seed: int) -> list[Implicit]:
    """Each method with each solver and tolerance in turn, of an H that is drawn."""
    solvers = [x for x in SOLVERS if x != "scipy" or importlib.util.find_spec("scipy")]
    every = [(m, s, k) for m in METHODS for s in solvers for k in _ORDERS]
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    drawn = [draw.choice(every) for _ in range(max(0, count - len(every)))]
    chosen = [*draw.sample(every, min(count, len(every))), *drawn]
    return [Implicit(m, s, k, draw.choice(sorted(SYSTEMS))) for m, s, k in chosen]


def campaign(
    count: int, seed: int, folder: Path, jobs: int = 1, more: Sequence[str] = ()
) -> Iterator[Judged]:
    """Each case as it is judged."""
    work = [(step, folder, more) for step in cases(count, seed)]
    if jobs == 1:
        yield from map(_one, work)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(_one, work)


def _one(work: tuple[Implicit, Path, Sequence[str]]) -> Judged:
    return judged(*work)


RIGHT = ("refuted", "in the noise")
OUTCOMES = (*RIGHT, "unknown", "error", "missed", "size", "zero", "accused")


def main() -> int:
    """The status: 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="where the programs stay")
    parser.add_argument("--more", default="", help="further arguments of the command")
    options = parser.parse_args()
    folder = options.keep or Path(tempfile.mkdtemp(prefix="implicit-"))
    folder.mkdir(parents=True, exist_ok=True)
    table: dict[str, Counter[str]] = defaultdict(Counter)
    slowest = 0.0
    more = shlex.split(options.more)
    for each in campaign(options.count, options.seed, folder, options.jobs, more):
        for sort in (each.step.solver, each.step.method, f"1e-{each.step.digits:02}"):
            table[sort][each.outcome] += 1
        slowest = max(slowest, each.answer.seconds)
        if each.outcome not in RIGHT:
            print(each, flush=True)
    print(f"{'':22}", *(f"{x:>12}" for x in OUTCOMES))
    for sort, row in sorted(table.items()):
        print(f"{sort:22}", *(f"{row[x]:12}" for x in OUTCOMES))
    print(f"slowest: {slowest:.1f} s")
    return int(any(row[x] for row in table.values() for x in OUTCOMES[4:]))


if __name__ == "__main__":
    sys.exit(main())
