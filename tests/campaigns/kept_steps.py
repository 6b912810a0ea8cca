"""Drawn steps in floats, in any units, beside what mpmath says of the structures that they keep.

    python -m tests.campaigns.kept_steps --count 500 --seed 1
    python -m tests.campaigns.kept_steps --count 100 --seed 2 --maps

A step has three to five claims; with --maps it is judged as a map, for one h. Wrong is a claim that
is true and REFUTED, or false and PROVED, or false and MEASURED though the defect is beyond what
floats hide. Any ends with status 1. What is left undecided is counted, but for defects in the
noise, of which nothing can be said.
"""

import argparse
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

import verify
from tests.helpers.sampled.kept_steps import MAP_EXPONENT, DrawnStep, Structure, drawn_step
from verify.integrators.results import KeptStructure
from verify.verdict import Verdict

# Defects, in units in which all is near 1, that floats show at some h; and the factor by which one
# at a small h is larger than the power of h that is claimed lets it be.
VISIBLE, VISIBLE_AT_SMALL_H, FACTOR = 1e-9, 1e-10, 10


@dataclass(frozen=True)
class Judged:
    """A claim: `order` of the defect by the oracle, and what is said of it."""

    step: DrawnStep
    structure: Structure
    claimed: int | None
    order: int | None
    kept: KeptStructure

    @property
    def true(self) -> bool:
        return self.order is None or (self.claimed is not None and self.order >= self.claimed)

    @property
    def visible(self) -> bool:
        """Whether a claim that is false is false by more than what floats hide."""
        if self.claimed is None:
            return self.step.defect(self.structure.kept, MAP_EXPONENT) > VISIBLE
        large, *small = (self.step.defect(self.structure.kept, n) for n in (2, 6, 9, 12))
        limits = (FACTOR * large * 2.0 ** (-n * self.claimed) for n in (4, 7, 10))
        return any(x > max(VISIBLE_AT_SMALL_H, y) for x, y in zip(small, limits, strict=True))

    @property
    def outcome(self) -> str:
        verdict = self.kept.verdict
        if verdict is Verdict.UNDECIDED:
            return "undecided" if self.true or self.visible else "in the noise"
        if self.true:
            return "wrong" if verdict is Verdict.REFUTED else "decided"
        if verdict is Verdict.MEASURED:
            return "wrong" if self.visible else "in the noise"
        return "wrong" if verdict is Verdict.PROVED else "decided"

    def __str__(self) -> str:
        step = self.step
        name = step.request(self.structure)[0] + (f": {self.claimed}" if self.claimed else "")
        return (
            f"{self.outcome}: {name} of {step.method}, {step.mistake or 'right'} {step.size:.0e}, "
            f"{step.probe}, order {self.order}\n    {step.system_text}\n"
            f"    {self.kept.verdict} by {self.kept.how}: {self.kept.reason}"
        )


def judged(seed: int, number: int, is_map: bool = False) -> Iterator[Judged]:
    """Each claim on a step; on a map, that it is kept."""
    step, claims = drawn_step(seed, number)
    if is_map:
        # Where its loop does not converge the midpoint rule is another map, far away.
        method = "rk4" if step.method == "implicit-midpoint" else step.method
        step = replace(step, is_map=True, method=method)
        claims = [(x, None) for x, _ in claims if x.kept.kind != "symmetric"]
    requests = [step.request(structure) for structure, _ in claims]
    keeps = [
        text + (f": {claimed}" if claimed else "")
        for (text, _), (_, claimed) in zip(requests, claims, strict=True)
    ]
    more = {"point": step.point} | {k: x for _, texts in requests for k, x in texts.items()}
    if is_map:
        names = ",".join(step.system.names)
        finding = verify.check_map(step.function, coordinates=names, keeps=keeps, **more)
    else:
        finding = verify.check(step.system_text, step.function, keeps=keeps, **more)
    for (structure, claimed), kept in zip(claims, finding.keeps, strict=True):
        yield Judged(step, structure, claimed, step.order(structure.kept), kept)


def main() -> int:
    """The status: 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=500, help="of steps")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--begin", type=int, default=0, help="the number of the first step")
    parser.add_argument("--maps", action="store_true", help="judge them as maps")
    options = parser.parse_args()
    outcomes, truths, slowest = Counter[str](), Counter[bool](), 0.0
    for number in range(options.begin, options.begin + options.count):
        began = time.perf_counter()
        for each in judged(options.seed, number, options.maps):
            outcomes[each.outcome] += 1
            truths[each.true] += 1
            if each.outcome in ("wrong", "undecided"):
                print(f"{number} {each}", flush=True)
        slowest = max(slowest, time.perf_counter() - began)
    total = outcomes.total()
    print(f"{total} claims, {truths[True]} true, {truths[False]} false: {dict(outcomes)}; "
          f"{outcomes['undecided'] / max(total, 1):.1%} undecided; a step with its claims "
          f"{slowest:.1f} s at most")  # fmt: skip
    return int(bool(outcomes["wrong"]))


if __name__ == "__main__":
    sys.exit(main())
