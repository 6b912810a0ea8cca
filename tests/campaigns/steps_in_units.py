"""Steps in units that are drawn, right ones and ones with a planted mistake: what is said of them.

    python -m tests.campaigns.steps_in_units --count 2000 --seed 1 --jobs 2 --keep DIR

Half of them are right. Length, time and mass are from 10⁻⁶ to 10⁶ each, of 20 H and 13 methods.
What is true of each is known by mpmath and sympy alone (`stepping/truth.py`). Wrong is a right one
that is refuted, and a spoilt one that is accepted; either ends with status 1. `--more` goes to the
command, as "--time-limit 20".
"""

import argparse
import random
import shlex
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tests.campaigns.stepping.asked import Answer, asked
from tests.campaigns.stepping.methods import MISTAKES
from tests.campaigns.stepping.programs import Case, right_one, spoilt_one


@dataclass(frozen=True)
class Judged:
    """A case, what became of it ("decided", "undecided" or "wrong"), and how to run it again."""

    case: Case
    answer: Answer
    command: str

    @property
    def outcome(self) -> str:
        wrong, right = ("refuted", "accepted") if self.case.right else ("accepted", "refuted")
        names = {wrong: "wrong", right: "decided"}
        return names.get(self.answer.outcome, self.answer.outcome)

    @property
    def wrong_order(self) -> bool:
        """Whether it says an order that is not the program's."""
        return self.answer.order is not None and self.answer.order != self.case.truth.order

    @property
    def sort(self) -> str:
        return self.case.mistake or "right"

    def __str__(self) -> str:
        case, truth = self.case, self.case.truth
        kept = "symplectic" if truth.symplectic else f"not symplectic, by {truth.defect:.1e}"
        return (
            f"{self.outcome}: {case.method.name} of {case.units.system.name}, {self.sort}; "
            f"it is of order {truth.order} and {kept}\n    {self.command}\n"
            f"    {self.answer.verdict}: {self.answer.text[:400]}"
        )


def case_of(index: int, seed: int, decades: float = 6) -> Case:
    """Right ones, and as many spoilt ones, their kinds in turn."""
    draw = random.Random(f"{seed} {index}")  # noqa: S311 - nothing is secret
    name = f"step_{seed}_{index:05}"
    if index % 2 == 0:
        return right_one(name, draw, decades)
    kinds = sorted(MISTAKES)
    return spoilt_one(name, draw, kinds[index // 2 % len(kinds)], decades)


def judged(case: Case, folder: Path, more: Sequence[str] = ()) -> Judged:
    """Writes the program, and asks the command line about it."""
    path = folder / f"{case.name}.py"
    path.write_text(case.source, encoding="utf-8")
    hamiltonian = ["--hamiltonian", case.units.hamiltonian]
    arguments = ["check-integrator", f"{path}:step", *hamiltonian, *case.claims, *more]
    return Judged(case, asked(arguments), shlex.join(["verify", *arguments]))


def campaign(
    count: int, seed: int, folder: Path, jobs: int = 1, more: Sequence[str] = (), decades: float = 6
) -> Iterator[Judged]:
    """Each case as it is judged."""
    work = [(k, seed, folder, more, decades) for k in range(count)]
    if jobs == 1:
        yield from map(_one, work)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(_one, work)


def _one(work: tuple[int, int, Path, Sequence[str], float]) -> Judged:
    index, seed, folder, more, decades = work
    return judged(case_of(index, seed, decades), folder, more)


def print_table(results: Sequence[Judged]) -> None:
    """By the kind of mistake, and the method and H of what is not decided."""
    outcomes = ("decided", "undecided", "error", "wrong")
    table: dict[str, Counter[str]] = defaultdict(Counter)
    for each in results:
        table[each.sort][each.outcome] += 1
    print(f"{'':16}", *(f"{x:>10}" for x in outcomes))
    for sort in sorted(table, key=lambda x: (x != "right", x)):
        print(f"{sort:16}", *(f"{table[sort][x]:10}" for x in outcomes))
    right = [each for each in results if each.case.right]
    spoilt = [each for each in results if not each.case.right]
    for name, those in (("right", right), ("spoilt", spoilt)):
        if those:
            share = sum(x.outcome == "decided" for x in those) / len(those)
            print(f"{name}: {len(those)}, decided {share:.1%}")
    print(f"orders said that are not the program's: {sum(x.wrong_order for x in results)}")
    open_ones = [x for x in results if x.outcome in ("undecided", "error")]
    for what, names in (
        ("H", Counter(x.case.units.system.name for x in open_ones)),
        ("method", Counter(x.case.method.name for x in open_ones)),
    ):
        print(f"not decided by {what}:", ", ".join(f"{x} {n}" for x, n in names.most_common()))
    seconds = sorted(x.answer.seconds for x in results)
    print(f"seconds: median {seconds[len(seconds) // 2]:.2f}, most {seconds[-1]:.2f}")


def main() -> int:
    """The status: 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="where the programs stay")
    parser.add_argument("--decades", type=float, default=6, help="of the units, up and down")
    parser.add_argument("--more", default="", help="further arguments of the command")
    parser.add_argument("--open", action="store_true", help="print what is not decided, too")
    options = parser.parse_args()
    folder = options.keep or Path(tempfile.mkdtemp(prefix="steps-"))
    folder.mkdir(parents=True, exist_ok=True)
    results = []
    more = shlex.split(options.more)
    for each in campaign(options.count, options.seed, folder, options.jobs, more, options.decades):
        results.append(each)
        wrong = each.outcome == "wrong" or each.wrong_order
        if wrong or (options.open and each.outcome != "decided"):
            print(each, flush=True)
    print_table(results)
    return int(any(x.outcome == "wrong" for x in results))


if __name__ == "__main__":
    sys.exit(main())
