"""float64 kernels of all explicit schemes against the same loop in C, for Duffing and the pendulum.

    python tests/bench/schemes_against_c.py [SCHEME …]

Each kernel's own source (simple assignments, one operation each) is translated to C line by line,
and compiled twice:
- `cc -O3 -march=native -ffp-contract=off`: products and sums are rounded one by one, as in the
  kernel. Its last p and q have to be the same bits.
- `cc -O3 -march=native`: gcc then contracts a·b + c into one rounding, which the kernel must not
  do, since its rounding is what is measured. For information.

Kernel and C run in turn, each after a start that is not timed and in another order every round (who
comes first is slower here), and what counts is the ratio of the medians within this run. Target: at
most 1.2 against the first.
"""

import ast
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from verify import arithmetic, schemes
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.kernels.kernel import Kernel, kernel_for

SECONDS, ROUNDS = 0.15, 9  # of one measurement, and how many of each there are
TARGET = 1.2
START = {"duffing": (1.5, 0.0), "pendulum": (1.5, 0.0)}  # q, p
H = 1e-6  # so that no scheme leaves the orbit within the 10⁷ steps that are timed
OBSERVABLES = frozenset({"delta_j_max", "mse", "lambda"})
FLAGS = {"exact": ["-ffp-contract=off"], "contracted": []}

HEAD = """#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
static double root(double x, int n) {
  double r = pow(x, 1.0 / n);
  return r > 0 ? r - (pow(r, n) - x) / (n * pow(r, n - 1)) : r;
}
"""
TAIL = """  struct timespec begun, ended;
  kernel(steps / 4, in, warm);
  clock_gettime(CLOCK_MONOTONIC, &begun);
  kernel(steps, in, z);
  clock_gettime(CLOCK_MONOTONIC, &ended);
  printf("%.9f %a %a\\n", ended.tv_sec - begun.tv_sec + 1e-9 * (ended.tv_nsec - begun.tv_nsec),
         z[0], z[1]);
}
"""


def in_c(node: ast.expr) -> str:
    """One expression of a kernel's source."""
    match node:
        case ast.Name():
            return node.id
        case ast.Constant():
            return str(node.value)  # whole numbers only, beside doubles
        case ast.UnaryOp(op=ast.USub()):
            return f"(-{in_c(node.operand)})"
        case ast.BinOp():
            sign = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}[type(node.op)]
            return f"({in_c(node.left)} {sign} {in_c(node.right)})"
        case ast.Compare():
            sign = {ast.Lt: "<", ast.Gt: ">", ast.Eq: "=="}[type(node.ops[0])]
            return f"({in_c(node.left)} {sign} {in_c(node.comparators[0])})"
        case ast.Call(func=ast.Name(id=called)):
            name = {"abs": "fabs"}.get(called, called)
            return f"{name}({', '.join(map(in_c, node.args))})"
    raise ValueError(ast.dump(node))


def translated(kernel: Kernel) -> str:
    """The kernel's source as a program in C: `steps h parameters… carried…` are its arguments."""
    (function,) = ast.parse(kernel.source).body
    assert isinstance(function, ast.FunctionDef)
    names = [a.arg for a in function.args.args][1:]
    state = names[-len(kernel.state_names) :]
    fixed = names[: len(names) - len(state)]
    *before, loop, _ = function.body
    assert isinstance(loop, ast.For)
    seen = {*state, *fixed}

    def line(statement: ast.stmt) -> str:
        if isinstance(statement, ast.If):
            return f"if ({in_c(statement.test)}) {line(statement.body[0])}"
        assert isinstance(statement, ast.Assign)
        target = ast.unparse(statement.targets[0])
        kind = "" if target in seen else "double "
        seen.add(target)
        return f"{kind}{target} = {in_c(statement.value)};"

    numbers = kernel.lowering.named_constants(lambda x: float(x).hex())
    body = [f"double {x} = in[{k}];" for k, x in enumerate(fixed)]
    body += [f"double {x} = z[{k}];" for k, x in enumerate(state)]
    body += [line(s) for s in before]
    body += ["for (long k = 0; k < steps; k++) {", *(line(s) for s in loop.body), "}"]
    body += [f"z[{k}] = {x};" for k, x in enumerate(state)]
    main = [
        "int main(int n, char **a) {",
        "  long steps = atol(a[1]);",
        f"  double in[{len(fixed)}], z[{len(state)}], warm[{len(state)}];",
        f"  for (int k = 0; k < {len(fixed)}; k++) in[k] = atof(a[2 + k]);",
        f"  for (int k = 0; k < {len(state)}; k++)",
        f"    warm[k] = z[k] = atof(a[{2 + len(fixed)} + k]);",
    ]
    lines = [
        *(f"static const double {name} = {x};" for name, x in numbers.items()),
        "__attribute__((noinline)) static void kernel(long steps, double *in, double *z) {",
        *body,
        "}",
        *main,
    ]
    return HEAD + "\n".join(lines) + "\n" + TAIL


def seconds_in_c(
    program: Path, steps: int, arguments: Sequence[float]
) -> tuple[float, float, float]:
    """Its seconds, and its last p and q."""
    command = [str(program), str(steps), *map(repr, arguments)]
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(out[0]), float.fromhex(out[1]), float.fromhex(out[2])


def compare(compiler: str, name: str, system: str, folder: Path) -> str:
    """One line of the table. Raises InputError for an H that the scheme does not take."""
    hamiltonian = systems.get(system).hamiltonian()
    preserves = schemes.get(name).step_map(hamiltonian).preserves_area
    asked = frozenset() if preserves else OBSERVABLES
    kernel = kernel_for(hamiltonian, name, arithmetic.get("float64", 17), asked)
    q, p = START[system]
    arguments = [H, *(1.0 for _ in kernel.parameters), p, q, *map(float, kernel.start)]
    source = folder / "kernel.c"
    source.write_text(translated(kernel), encoding="utf-8")
    programs = {}
    for kind, flags in FLAGS.items():
        programs[kind] = folder / kind
        files = [str(source), "-o", str(programs[kind])]
        command = [compiler, "-O3", "-march=native", *flags, *files, "-lm"]
        subprocess.run(command, check=True)
    kernel.function(1_000_000, *arguments)  # compiles
    begun = time.perf_counter()
    kernel.function(1_000_000, *arguments)
    steps = max(1_000_000, int(1e6 * SECONDS / (time.perf_counter() - begun)))
    times: dict[str, list[float]] = {"ours": [], **{kind: [] for kind in FLAGS}}
    ends = {}
    for turn in range(ROUNDS):
        kinds = list(times)
        for kind in [*kinds[turn % 3 :], *kinds[: turn % 3]]:
            if kind == "ours":
                kernel.function(steps // 4, *arguments)
                begun = time.perf_counter()
                _, *end = kernel.function(steps, *arguments)
                spent = time.perf_counter() - begun
            else:
                spent, *end = seconds_in_c(programs[kind], steps, arguments)
            times[kind].append(spent)
            ends[kind] = tuple(end[:2])
    if ends["ours"] != ends["exact"]:
        raise SystemExit(f"{name} on {system}: other bits in C, {ends}")
    ns = {kind: statistics.median(x) / steps * 1e9 for kind, x in times.items()}
    ratio = ns["ours"] / ns["exact"]
    note = "" if ratio <= TARGET else "  above the target"
    return (
        f"{system:9} {name:26} {ns['ours']:8.2f} {ns['exact']:8.2f} {ratio:6.2f} "
        f"{ns['contracted']:10.2f} {ns['ours'] / ns['contracted']:6.2f}{note}"
    )


def main() -> None:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        print("no C compiler here; nothing to compare with")
        return
    print("system    scheme                      ours ns     C ns  ratio  contracted  ratio")
    for system in START:
        for name in sys.argv[1:] or schemes.names():
            if not schemes.get(name).explicit:
                continue
            with tempfile.TemporaryDirectory() as folder:
                try:
                    print(compare(compiler, name, system, Path(folder)), flush=True)
                except InputError as error:
                    print(f"{system:9} {name:26} {error}")


if __name__ == "__main__":
    main()
