"""Regions carried by maps, against the targets.

    python tests/bench/flow.py [float64] [digits] [loop] [probe]

`float64` and `digits`: the cat's face with 2,000 outline points by 20,000 steps (under 1 s, and
under 30 s with 33 digits), from nothing compiled and again. `loop`: against numpy, which takes the
same steps for all points together, within one run. `probe`: how far the bound of the probe's error
is below the change of area that it measures, for the h and N of the paper (100 times and more).
"""

import sys
import time
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from verify import arithmetic
from verify.arithmetic.float_context import FLOAT
from verify.execution.keeper import NOTHING
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.many_points import PointMap, waypoints_of
from verify.scenes.region_sections import PlacedShape
from verify.scenes.shapes import named as shapes
from verify.studies.kinds.regions import FlowTask

SYSTEMS = {"duffing": "p**2/2 + q**2/2 + q**4/4", "pendulum": "p**2/2 - cos(q)"}
POINTS, STEPS, H = 2_000, 20_000, Fraction(1, 100)
GOALS = {"float64": 1.0, "digits": 30.0}
PAPER = [(Fraction(1, 100), n) for n in (5_000, 10_000, 20_000)]
PAPER += [(Fraction(1, 1000), n) for n in (5_000, 10_000, 20_000)]


def face() -> tuple[np.ndarray, np.ndarray]:
    """2,000 points of all outlines of the face, about (1, 0)."""
    outlines = shapes.get("cat").place_at(Fraction(1), Fraction(0), Fraction(1, 2)).outlines
    curves = []
    for k, outline in enumerate(outlines):
        count = POINTS // len(outlines) + (k < POINTS % len(outlines))
        curves.append(outline.arcs[0](FLOAT, np.arange(count) / count))
    x, y = (
        np.concatenate([np.broadcast_to(z, np.shape(z)) for z in zs])
        for zs in zip(*curves, strict=True)
    )
    return y, x


def timed(work: Callable[[], Any]) -> float:
    """Its seconds, from the points' starts: it is not remembered where they have got to."""
    waypoints_of.cache_clear()
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def carrying(formula: str, name: str, digits: int) -> list[float]:
    """Seconds from nothing compiled, and the least of three more."""
    system = arithmetic.get(name, digits)
    p, q = face()
    given: Any = (p, q)
    if name != "float64":
        given = [[system.number(Fraction(x)) for x in z] for z in (p, q)]

    def work() -> None:
        hamiltonian = Hamiltonian.parse(formula)
        made = PointMap(hamiltonian, "lie2", step_size=H, steps=STEPS, arithmetic=system)
        made(p=given[0], q=given[1])

    repeats = 3 if name == "float64" else 1
    return [timed(work), min(timed(work) for _ in range(repeats))]


def speed(kind: str, name: str, digits: int) -> bool:
    good = True
    for system, formula in SYSTEMS.items():
        first, again = carrying(formula, name, digits)
        good &= again <= GOALS[kind]
        print(f"{kind:8} {system:9} {first:7.2f} s, compiled {again:7.2f} s "
              f"(target {GOALS[kind]:g} s)", flush=True)  # fmt: skip
    return good


def loop() -> bool:
    """Symplectic Euler's steps in numpy, so that both do the same."""
    p, q = face()
    slopes: dict[str, Callable[[Any], Any]] = {
        "duffing": lambda x: x + x * x * x,
        "pendulum": np.sin,
    }
    for system, slope in slopes.items():
        made = PointMap(
            Hamiltonian.parse(SYSTEMS[system]), "symplectic-euler", step_size=H, steps=STEPS,
            arithmetic=arithmetic.get("float64", 17),
        )  # fmt: skip
        made(p=p, q=q)
        own = min(timed(lambda made=made: made(p=p, q=q)) for _ in range(3))  # type: ignore[misc]

        def plain(slope: Callable[[Any], Any] = slope) -> None:
            x, y = q.copy(), p.copy()
            for _ in range(STEPS):
                y -= 0.01 * slope(x)
                x += 0.01 * y

        theirs = timed(plain)
        print(f"loop     {system:9} {own:7.2f} s, numpy {theirs:7.2f} s: {theirs / own:.1f} times")
    return True


def probe() -> bool:
    shape = PlacedShape(shape="cat", centre={"q": 1, "p": 0}, scale="0.5")  # type: ignore[arg-type]
    good = True
    for system, formula in SYSTEMS.items():
        for h, steps in PAPER:
            task = FlowTask(
                hamiltonian=formula, parameters={}, map="lie2", shape=shape, step_size=h,
                steps=steps, digits=17, mean_lambda=True, distance=False,
            )  # fmt: skip
            found = task.compute(NOTHING)
            if found.area_change is None:
                print(f"probe    {system} h = {float(h)} N = {steps}: {found.problem}")
                good = False
                continue
            times = abs(float(found.area_change)) / float(found.probe_error or 0)
            good &= times >= 100 and bool(found.agree)
            print(f"probe    {system:9} h = {float(h):5} N = {steps:5}: {found.area_change} "
                  f"± {found.probe_error} ({times:.0f} times below), mean {found.mean_lambda} "
                  f"± {found.mean_lambda_error}, {found.outlines[0].nodes} nodes, "
                  f"{found.seconds:.1f} s", flush=True)  # fmt: skip
    return good


def main() -> int:
    known = {
        "float64": lambda: speed("float64", "float64", 17),
        "digits": lambda: speed("digits", "fixed", 33),
        "loop": loop,
        "probe": probe,
    }
    return int(min(known[name]() for name in sys.argv[1:] or known) is False)


if __name__ == "__main__":
    sys.exit(main())
