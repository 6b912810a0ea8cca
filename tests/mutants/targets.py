"""Which modules are mutated, and a sample of their mutants."""

import random

from tests.mutants.mutate import ROOT, Mutant, mutants

# What the battery of properties is tried on.
PATTERNS = (
    "algebra/jets.py",
    "algebra/linear_algebra.py",
    "algebra/power_series.py",
    "arithmetic/*.py",
    "arithmetic/systems/*.py",
    "flows/closed_orbit.py",
    "flows/extrapolation.py",
    "flows/orbit_average.py",
    "proof/**/*.py",
    "schemes/**/*.py",
    "studies/separation/**/*.py",
)
# Where a mistake makes a wrong verdict, or a bound that does not hold.
SOUNDNESS = (
    "runs/*.py",
    "kernels/**/*.py",
    "proof/*.py",
    "proof/certificates/*.py",
    "proof/symplectic/*.py",
    "algebra/identities/*.py",
    "algebra/*zero*.py",
    "arithmetic/exact.py",
    "arithmetic/systems/*.py",
    "arithmetic/wide/*.py",
    "arithmetic/lanes/*.py",
    "schemes/printed/*.py",
    "integrators/tables/**/*.py",
    "integrators/measures/*.py",
    "integrators/clocks.py",
    "integrators/measured_finding.py",
    "integrators/places/*.py",
    "integrators/tracing/*.py",
    "reference/compare/*.py",
    "studies/regions/*.py",
)
# What released libraries are judged by, and pages' pictures, have no verdict of their own.
ROOMS = ("**/*.py",)
_NOT_MUTATED = ("verify/audits/", "verify/pages/figures/", "verify/__")


def modules(patterns: tuple[str, ...] = PATTERNS) -> tuple[str, ...]:
    """The modules of these patterns that have something to change."""
    found = {p for pattern in patterns for p in (ROOT / "verify").glob(pattern)}
    paths = {p for p in found if not str(p.relative_to(ROOT)).startswith(_NOT_MUTATED)}
    names = (p.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".") for p in paths)
    names = (name.removesuffix(".__init__") for name in names)
    return tuple(sorted(name for name in names if mutants(name)))


def shares(counts: dict[str, int], size: int) -> dict[str, int]:
    """`size` distributed over modules in proportion to their counts, each with one at least.

    A module gives no more than it has.
    """
    total = sum(counts.values())
    given = dict.fromkeys(counts, 1)
    for _ in range(min(size, total) - len(counts)):
        wanting = [name for name in sorted(counts) if given[name] < counts[name]]
        given[max(wanting, key=lambda name: counts[name] * size / total - given[name])] += 1
    return given


def sample(size: int, seed: int, chosen: tuple[str, ...] | None = None) -> list[Mutant]:
    """A random sample, the same for the same source: stratified over the modules.

    The order is mixed, so that a first part of it is a sample, too.
    """
    names = chosen or modules()
    share = shares({name: len(mutants(name)) for name in names}, size)
    drawn: list[tuple[float, Mutant]] = []
    for name in names:
        draw = random.Random(f"{seed} {name}")  # noqa: S311 - a sample, not a secret
        mixed = list(mutants(name))
        draw.shuffle(mixed)
        drawn += [
            ((k + draw.random()) / share[name], m) for k, m in enumerate(mixed[: share[name]])
        ]
    return [m for _, m in sorted(drawn, key=lambda pair: (pair[0], pair[1].key))]
