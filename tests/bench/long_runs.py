"""Long runs at high precision against their targets, in fresh processes.

    python tests/bench/long_runs.py [cost] [first-call] [tables] [figure10]
                                    [--arithmetic fixed] [--digits 33] [--shrink 1]

cost        a step costs the same at N = 10⁵ and 10⁸, and so does memory
first-call  the first call of a kernel, compilation included
tables      the paper's Tables 1 and 2 with at least 30 digits, on 2 cores
figure10    the run of the paper's Figure 10: pendulum, lie2, h = 0.0001, 2·10⁸ steps, on one core

Without a name all four, which takes minutes. `--shrink 1000` makes the long runs a thousand times
shorter, to try this out with a slow arithmetic; the targets are then not judged.
"""

import argparse
import multiprocessing
import resource
import statistics
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from typing import Any

# `verify` is imported in the fresh processes only: their peak memory starts from this one's.

SHORT, LONG, ROUNDS, CORES, TABLE_DIGITS = 10**5, 10**8, 3, 2, 30
OBSERVABLES = ("delta_j_max", "mse", "lambda")
SYSTEMS = {"duffing": {"delta": "1"}, "pendulum": {}}
NEW = {  # Hamiltonians whose kernels are compiled for the first time
    "Duffing": "p**2/2 + q**2/2 + delta*q**4/4",
    "pendulum": "p**2/2 - cos(q)",
    "not separable": "p**2/2 + q**2/2 + p**2*q**2/4 + cos(p*q)/3",
}


def fresh(function: Callable[..., Any], *arguments: Any) -> Any:
    """What the function returns, called in a process of its own."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as executor:
        return executor.submit(function, *arguments).result()


def show(what: str, value: str, target: str, met: bool, judged: bool = True) -> None:
    verdict = ("" if met else "MISSED") if judged else "not judged: shortened"
    print(f"{what:62} {value:>12}   target {target:10} {verdict}", flush=True)


# -- what is done in the fresh processes ----------------------------------------------------------


def _job(hamiltonian: str, parameters: dict[str, str], steps: int) -> Any:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.kernels.stepping import KernelRun

    start = {"h": Fraction("0.001"), "q": Fraction("1.5"), "p": Fraction(0)}
    chosen = Hamiltonian.parse(hamiltonian, parameters)
    return KernelRun(chosen, "lie2", start, steps, frozenset(OBSERVABLES), points=0)


def step_costs(system: str, name: str, digits: int, long: int) -> tuple[float, float]:
    """Median seconds of a step in short and in long runs, taken in turn."""
    from verify import arithmetic
    from verify.hamiltonians import systems

    made, formula = arithmetic.get(name, digits), systems.get(system).formula
    kernel_runs = {n: _job(formula, SYSTEMS[system], n) for n in (SHORT, long)}
    taken: dict[int, list[float]] = {n: [] for n in kernel_runs}
    kernel_runs[SHORT].run(made)
    for _ in range(ROUNDS):
        for steps, times in ((SHORT, 10), (long, 1)):
            taken[steps] += [kernel_runs[steps].run(made).seconds / steps for _ in range(times)]
    return statistics.median(taken[SHORT]), statistics.median(taken[long])


def peak_memory(system: str, name: str, digits: int, steps: int) -> int:
    """KiB at the most, after a run of so many steps."""
    from verify import arithmetic
    from verify.hamiltonians import systems

    _job(systems.get(system).formula, SYSTEMS[system], steps).run(arithmetic.get(name, digits))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def first_call(formula: str, name: str, digits: int) -> float:
    """Seconds of one step, from the step map to the compiled kernel's result."""
    from verify import arithmetic

    parameters = {"delta": "1"} if "delta" in formula else {}
    begun = time.perf_counter()
    _job(formula, parameters, 1).run(arithmetic.get(name, digits))
    return time.perf_counter() - begun


def both_tables(name: str, shrink: int) -> tuple[float, int, int, dict[str, int]]:
    """Wall seconds, steps, the fewest digits that are known, and how often each kind of bound."""
    from verify.commands.shared.input import load_target
    from verify.execution.execute import Store, execute
    from verify.execution.executors import Placement
    from verify.scenes.results.run import RunResult
    from verify.studies.tasks_of_scenes import plan_scenes

    _, scenes, _ = load_target("paper")
    asked = {"arithmetic": name, "digits": TABLE_DIGITS, "observables": OBSERVABLES}
    chosen = []
    for scene in scenes:
        assert scene.grid is not None
        assert scene.grid.time is not None
        shorter = {"time": scene.grid.time / shrink, "separate": False}
        grid = scene.grid.model_copy(update=asked | shorter)
        chosen.append(scene.with_only(schemes=("lie2",), grid=grid))
    begun = time.perf_counter()
    results = execute(plan_scenes(chosen), Store(None), where=Placement(CORES)).values()
    seconds = time.perf_counter() - begun
    runs = [r for r in results if isinstance(r, RunResult)]
    digits = min((known_digits(r.values[x].value) for r in runs for x in r.values), default=0)
    kinds: Counter[str] = Counter(r.error_kind if r.values else r.status for r in runs)
    return seconds, sum(r.steps for r in runs), digits, dict(kinds)


def figure10_run(name: str, digits: int, steps: int) -> tuple[float, float, Any]:
    """Wall seconds of the run as a user gets it, seconds of its stepping, and the result.

    The paper does not say from where it starts; q = 1.5, p = 0 is one of its five initial values.
    """
    from verify.hamiltonians import systems
    from verify.runs.requested_run import run

    begun = time.perf_counter()
    found = run(
        systems.get("pendulum").hamiltonian(), "lie2", q=Fraction("1.5"), p=0,
        step_size=Fraction("0.0001"), steps=steps, arithmetic=name, digits=digits,
    )  # fmt: skip
    return time.perf_counter() - begun, found.seconds, found


def known_digits(value: str) -> int:
    """How many significant digits are printed."""
    return len(value.partition("e")[0].replace("-", "").replace(".", "").lstrip("0"))


# -- what is asked --------------------------------------------------------------------------------


def cost(name: str, digits: int, shrink: int) -> None:
    long = LONG // shrink
    for system in SYSTEMS:
        short_ns, long_ns = (1e9 * x for x in fresh(step_costs, system, name, digits, long))
        ratio = long_ns / short_ns
        what = f"{system}: {short_ns:.1f} ns a step at N = {SHORT:.0e}, {long_ns:.1f} at {long:.0e}"
        show(what, f"{ratio:.3f}", "1 ± 0.05", abs(ratio - 1) <= 0.05, shrink == 1)
        small, great = (fresh(peak_memory, system, name, digits, n) for n in (SHORT, long))
        what = f"{system}: peak memory {small / 1024:.0f} MiB and {great / 1024:.0f} MiB"
        show(what, f"{great / small:.3f}", "≤ 1.05", great <= 1.05 * small, shrink == 1)


def first_calls(name: str, digits: int, shrink: int) -> None:
    for title, formula in NEW.items():
        seconds = statistics.median(fresh(first_call, formula, name, digits) for _ in range(ROUNDS))
        show(f"first call, {title}, {digits} digits", f"{seconds:.2f} s", "< 1.5 s", seconds < 1.5)


def tables(name: str, digits: int, shrink: int) -> None:
    seconds, steps, known, kinds = fresh(both_tables, name, shrink)
    how = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
    what = f"Tables 1 and 2, {steps:.2e} steps on {CORES} cores"
    show(what, f"{seconds:.1f} s", "< 180 s", seconds < 180, shrink == 1)
    met = known >= TABLE_DIGITS
    show(f"the fewest digits of a value in them ({how})", f"{known}", f"≥ {TABLE_DIGITS}", met)


def figure10(name: str, digits: int, shrink: int) -> None:
    steps = 2 * LONG // shrink
    seconds, stepping, found = fresh(figure10_run, name, digits, steps)
    what = f"Figure 10's run, {steps:.0e} steps, {digits} digits ({stepping:.1f} s of stepping)"
    show(what, f"{seconds:.1f} s", "< 60 s", seconds < 60, shrink == 1)
    for observable, value in found.values.items():
        print(f"    {observable:12} {value.value} ± {value.bound} ({found.error_kind})")


def main() -> None:
    named = {"cost": cost, "first-call": first_calls, "tables": tables, "figure10": figure10}
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("what", nargs="*", choices=[*named, "all"], default="all")
    parser.add_argument("--arithmetic", default="fixed")
    parser.add_argument("--digits", type=int, default=33)
    parser.add_argument("--shrink", type=int, default=1)
    asked = parser.parse_args()
    for name in named if "all" in asked.what else asked.what:
        named[name](asked.arithmetic, asked.digits, asked.shrink)


if __name__ == "__main__":
    main()
