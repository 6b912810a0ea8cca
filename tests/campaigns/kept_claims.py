"""Drawn claims that a step keeps a structure, beside what mpmath says of them.

    python -m tests.campaigns.kept_claims --count 2000 --seed 1

Wrong is a claim that is PROVED though it is false, or REFUTED though it is true, an order that is
not that of the defect, and a structure of the flow that is refused, or one that is none and is
taken. Any ends with status 1. What is left undecided is counted, and listed.
"""

import argparse
import sys
import time
from collections import Counter
from dataclasses import dataclass

from tests.helpers.sampled.kept_claims import FAMILIES, KeptClaim, kept_claim
from verify.errors import InputError
from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_order import StructureProof, prove_structure
from verify.schemes import get
from verify.structures.reading import KeepsRequest, read_structures
from verify.verdict import Verdict

SLOW = 5  # seconds, from which a proof is listed


@dataclass(frozen=True)
class Judged:
    """What became of a claim: `wrong` says what is wrong, and is empty if nothing is."""

    wrong: str = ""
    undecided: bool = False
    true: bool = True
    seconds: float = 0.0


def prove(claim: KeptClaim) -> StructureProof | None:
    """The proof; None where the structure is refused, as one that the flow does not keep."""
    system = read_system(claim.drawn.system)
    scheme = get(claim.scheme)
    step_map = scheme.step_map(system)
    try:
        (structure,) = read_structures(KeepsRequest(**claim.request), system)
        return prove_structure(step_map, structure.structure, scheme, structure.order)
    except InputError as error:
        if "is not kept by the exact flow" in str(error):
            return None
        raise


def judged(claim: KeptClaim) -> Judged:
    began = time.perf_counter()
    proof = prove(claim)
    seconds = time.perf_counter() - began
    if (proof is None) is claim.drawn.of_flow:
        return Judged("the flow does keep it" if proof is None else "the flow does not keep it")
    if proof is None:
        return Judged(true=False, seconds=seconds)
    order = claim.order()
    true = claim.holds(order)
    wrong = ""
    if proof.verdict is not Verdict.UNDECIDED:
        if proof.verdict is not (Verdict.PROVED if true else Verdict.REFUTED):
            wrong = f"{proof.verdict}, and the order is {order}"
        elif proof.is_kept is True and order is not None:
            wrong = f"kept, and the order is {order}"
        elif proof.order is not None and proof.order != order:
            wrong = f"order {proof.order}, and it is {order}"
    return Judged(wrong, proof.verdict is Verdict.UNDECIDED, true, seconds)


def main() -> int:
    """The status: 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--begin", type=int, default=0, help="the number of the first claim")
    options = parser.parse_args()
    wrong, undecided, true = Counter[str](), Counter[str](), Counter[bool]()
    slowest = 0.0
    for number in range(options.begin, options.begin + options.count):
        claim = kept_claim(options.seed, number)
        family = FAMILIES[number % len(FAMILIES)].__name__
        result = judged(claim)
        true[result.true] += 1
        slowest = max(slowest, result.seconds)
        wrong[family] += bool(result.wrong)
        undecided[family] += result.undecided
        if result.wrong or result.undecided or result.seconds > SLOW:
            says = result.wrong or ("undecided" if result.undecided else f"{result.seconds:.1f} s")
            print(f"{number} {family}: {says}\n  {claim.drawn.system} | {claim.scheme} | "
                  f"{claim.request}", flush=True)  # fmt: skip
    print(
        f"{options.count} claims, {true[True]} true, {true[False]} false; {slowest:.1f} s at most"
    )
    for what, counts in (("wrong", wrong), ("undecided", undecided)):
        print(f"{what}: {counts.total()} {dict(+counts)}")
    return int(bool(wrong.total()))


if __name__ == "__main__":
    sys.exit(main())
