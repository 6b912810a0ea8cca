"""Drawn scenes of 2 and 3 degrees of freedom, still and in time, with every property.

    python -m tests.campaigns.drawn_in_degrees --count 5000 --seed 1

So many scenes in all, a quarter of each kind. For each kind it is told how many scenes each
property spoke of, its time, and the first scene that fails, shrunk; it ends with status 1 where
one does.
"""

import argparse
import sys
import time
from collections import Counter

from verify.exploration import properties
from verify.exploration.sample import Sample
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes_of_seed import check_sample, sample_scene, shrink

KINDS = [(degrees, timed) for degrees in (2, 3) for timed in (False, True)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--degrees", type=int, choices=(2, 3), help="only these, half of the count")
    asked = parser.parse_args()
    failed = [
        looked(degrees, timed, asked.count // len(KINDS), asked.seed)
        for degrees, timed in KINDS
        if asked.degrees in (None, degrees)
    ]
    sys.exit(any(failed))


def looked(degrees: int, timed: bool, count: int, seed: int) -> int:
    """How many properties fail."""
    space = SampleSpace(degrees=degrees, time_dependent=timed)
    spoke, seconds, first = Counter[str](), Counter[str](), dict[str, int]()
    begun = time.process_time()
    for number in range(count):
        sample = Sample.from_scene(sample_scene(space, seed, number))
        for name in properties.names():
            before = time.process_time()
            speaks, wrong = check_sample(properties.get(name), sample)
            seconds[name] += time.process_time() - before
            spoke[name] += speaks
            if wrong and name not in first:
                first[name] = number
                print(f"{name} fails at {number}: {wrong}\n  {sample.hamiltonian.formula}, "
                      f"{sample.scheme.name}", flush=True)  # fmt: skip
    kind = f"{degrees} degrees of freedom{', in time' if timed else ''}"
    print(f"{count} scenes of {kind}: {time.process_time() - begun:.0f} s", flush=True)
    for name in properties.names():
        if spoke[name]:
            print(f"  {name}: of {spoke[name]}, {seconds[name]:.1f} s", flush=True)
    for name, number in first.items():
        print(shrink(properties.get(name), space, seed, number).scene, flush=True)
    return len(first)


if __name__ == "__main__":
    main()
