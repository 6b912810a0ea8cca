"""Hénon–Heiles by lie2 with W, the symplectic defect of all steps, against the same loop in C.

    python tests/bench/henon_heiles.py [--rounds 7]

`fixed` at 33, 53 and 72 digits against C with MPFR, and float64 against C with doubles, compiled
here with `cc -O3 -march=native` (doubles with -ffp-contract=off, as the kernel rounds). The loop in
C is the kernel's own source as mpfr and float64 have it, line by line: one call or operation a
line, nothing allocated in the loop, squares by mpfr_sqr. All run in turn, and what counts is the
ratio of the medians within this run. Before that fixed and MPFR are held against a run with 100
digits; doubles have to end in the same bits.
"""

import argparse
import ast
import shutil
import statistics
import subprocess
import tempfile
import time
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

from schemes_against_c import translated

from verify import arithmetic
from verify.hamiltonians import systems
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.stepping import KernelRun

HAMILTONIAN, SCHEME = systems.get("henon-heiles").hamiltonian(), "lie2"
ASKED = frozenset({"symplectic_defect"})
START = {"p1": Fraction(1, 10), "p2": Fraction(1, 5), "q1": Fraction(3, 10), "q2": Fraction(-1, 10),
         "h": Fraction(1, 100), "t": Fraction(0)}  # fmt: skip
BITS = {33: 113, 53: 170, 72: 240}
STEPS, COMPARED_STEPS, STEPS_OF_DOUBLES = 60_000, 2000, 5_000_000
TARGET, TARGET_OF_DOUBLES = 6, 1.2
FLAGS = ["-O3", "-march=native", "-ffp-contract=off"]
MAIN = """#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <mpfr.h>
int main(int argc, char **argv) {
  long steps = atol(argv[1]), bits = atol(argv[2]);
  mpfr_set_default_prec(bits);
"""
CALLS = {ast.Add: "mpfr_add", ast.Sub: "mpfr_sub", ast.Mult: "mpfr_mul"}


def in_mpfr(kernel: Kernel) -> str:
    """The kernel's source as a program in C with MPFR: `steps bits h state…` are its arguments."""
    (function,) = ast.parse(kernel.source).body
    assert isinstance(function, ast.FunctionDef)
    given = [a.arg for a in function.args.args][1:]
    *before, loop, _ = function.body
    assert isinstance(loop, ast.For)
    same: dict[str, str] = {}  # a value that is another one
    made: list[str] = []

    def line(statement: ast.stmt) -> Iterator[str]:
        assert isinstance(statement, ast.Assign), "one operation a line is all that is expected"
        (target,), value = statement.targets, statement.value
        assert isinstance(target, ast.Name)
        if isinstance(value, ast.Name):
            same[target.id] = same.get(value.id, value.id)
            return
        if target.id not in (*given, *made):
            made.append(target.id)
        operands = [x.id for x in ast.walk(value) if isinstance(x, ast.Name)]
        x, *rest = [same.get(name, name) for name in operands]
        if isinstance(value, ast.UnaryOp):
            yield f"mpfr_neg({target.id}, {x}, MPFR_RNDN);"
        elif isinstance(value, ast.BinOp) and isinstance(value.op, ast.Mult) and rest == [x]:
            yield f"mpfr_sqr({target.id}, {x}, MPFR_RNDN);"
        else:
            assert isinstance(value, ast.BinOp)
            yield f"{CALLS[type(value.op)]}({target.id}, {x}, {rest[0]}, MPFR_RNDN);"

    first = [text for s in before for text in line(s)]
    body = [text for s in loop.body if not isinstance(s, ast.If) for text in line(s)]
    constants = kernel.lowering.named_constants(str)
    lines = [f"mpfr_t {name}; mpfr_init({name});" for name in (*given, *made, *constants)]
    lines += [f"mpfr_set_str({n}, argv[{k}], 10, MPFR_RNDN);" for k, n in enumerate(given, start=3)]
    for name, number in constants.items():
        x = Fraction(str(number))
        lines.append(f"mpfr_set_si({name}, {x.numerator}, MPFR_RNDN);")
        lines.append(f"mpfr_div_si({name}, {name}, {x.denominator}, MPFR_RNDN);")
    return MAIN + "\n".join([
        *lines, *first,
        "struct timespec begun, ended; clock_gettime(CLOCK_MONOTONIC, &begun);",
        "for (long k = 0; k < steps; k++) {", *body, "}",
        "clock_gettime(CLOCK_MONOTONIC, &ended);",
        'printf("%.9f\\n", ended.tv_sec - begun.tv_sec + 1e-9 * (ended.tv_nsec - begun.tv_nsec));',
        *(f'mpfr_printf("{name} %.90Re\\n", {name});' for name in kernel.state_names), "}", "",
    ])  # fmt: skip


def compiled(source: str, folder: Path, name: str, *libraries: str) -> Path:
    path, program = folder / f"{name}.c", folder / name
    path.write_text(source, encoding="utf-8")
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        raise SystemExit("no C compiler here: there is nothing to compare with")
    subprocess.run([compiler, *FLAGS, path, "-o", program, *libraries], check=True)
    return program


def carried(kernel: Kernel) -> list[str]:
    """What the state starts with, in decimals."""
    values = [START[x] for x in kernel.coordinates] + [Fraction(x) for x in kernel.start]
    return [str(float(x)) for x in (START["h"], *values)]


def of_c(program: Path, kernel: Kernel, bits: int, steps: int) -> tuple[float, dict[str, Fraction]]:
    command = [str(program), str(steps), str(bits), *carried(kernel)]
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    found = dict(text.split() for text in out[1:])
    state = {name: Fraction(found[name]) for name in ("p1", "p2", "q1", "q2")}
    form = max(abs(Fraction(x)) for name, x in found.items() if name.startswith("w_"))
    return float(out[0]), state | {"symplectic_defect": form}


def ours(name: str, digits: int, steps: int) -> tuple[float, dict[str, Fraction]]:
    outcome = KernelRun(HAMILTONIAN, SCHEME, START, steps, ASKED, 0).run(
        arithmetic.get(name, digits)
    )
    return outcome.seconds, dict(outcome.values)


def of_mpfr(folder: Path, rounds: int) -> None:
    kernel = kernel_for(HAMILTONIAN, SCHEME, arithmetic.get("mpfr", 33), ASKED)
    program = compiled(in_mpfr(kernel), folder, "mpfr", "-lmpfr", "-lgmp")
    _, true = ours("mpfr", 100, COMPARED_STEPS)
    print(f"{'digits':>8}{'ours ns':>10}{'C ns':>9}{'faster':>8}   target {TARGET}")
    for digits, bits in BITS.items():
        for found in (ours("fixed", digits, COMPARED_STEPS)[1],
                      of_c(program, kernel, bits, COMPARED_STEPS)[1]):  # fmt: skip
            worst = max(abs(found[x] - true[x]) for x in true)
            if worst * 2**bits > 64 * COMPARED_STEPS:
                raise SystemExit(f"{digits} digits: off by {float(worst):.3g}")
        taken = [(ours("fixed", digits, STEPS)[0], of_c(program, kernel, bits, STEPS)[0])
                 for _ in range(rounds)]  # fmt: skip
        own, c = (statistics.median(x) / STEPS * 1e9 for x in zip(*taken, strict=True))
        print(f"{digits:8}{own:10.1f}{c:9.0f}{c / own:8.1f}", flush=True)


def of_doubles(folder: Path, rounds: int) -> None:
    kernel = kernel_for(HAMILTONIAN, SCHEME, arithmetic.get("float64", 17), ASKED)
    program = compiled(translated(kernel), folder, "doubles", "-lm")
    arguments = [float(x) for x in carried(kernel)]
    kernel.function(1_000_000, *arguments)  # compiles
    taken: list[tuple[float, float]] = []
    for _ in range(rounds):
        kernel.function(STEPS_OF_DOUBLES // 4, *arguments)
        begun = time.perf_counter()
        _, *end = kernel.function(STEPS_OF_DOUBLES, *arguments)
        spent = time.perf_counter() - begun
        command = [str(program), str(STEPS_OF_DOUBLES), *map(repr, arguments)]
        out = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
        if [float.fromhex(x) for x in out[1:3]] != end[:2]:
            raise SystemExit(f"other bits in C: {out[1:]}, {end[:2]}")
        taken.append((spent, float(out[0])))
    own, c = (statistics.median(x) / STEPS_OF_DOUBLES * 1e9 for x in zip(*taken, strict=True))
    print(f"{'float64':>8}{own:10.1f}{c:9.1f}{own / c:8.2f}   times C; target {TARGET_OF_DOUBLES}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=7)
    rounds = parser.parse_args().rounds
    with tempfile.TemporaryDirectory() as folder:
        of_mpfr(Path(folder), rounds)
        of_doubles(Path(folder), rounds)


if __name__ == "__main__":
    main()
