"""Step map + observables → a loop over N steps in one arithmetic, with nothing not asked for.

Observables: `delta_j_max` max |ΔJ|, `mse` Σ ΔJ² (Eq. 15 before its 1/N), `lambda` Λ (Eq. 16) by
the closed form of ΔJ as Λ ← Λ + ΔJ + Λ ΔJ, `lambda_plain` Π det J the plain way (four entries,
their determinant, the product), `extremes` the least and greatest ΔJ and Λ of one call's steps.

A compensated kernel adds the increments to the state, and ΔJ to its sums, in twice the working
precision (Knuth's two-sum): what remains is the rounding of the increments, smaller by a factor of
about h. Its difference from the plain kernel estimates the plain kernel's rounding error.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from verify.hamiltonian import Hamiltonian
from verify.number_system import Arithmetic
from verify.program import Evaluator, Program
from verify.schemes import get
from verify.step_map import StepMap

OBSERVABLES = ("delta_j_max", "mse", "lambda", "lambda_plain", "extremes")
_INFIX = {"add": "+", "sub": "-", "mul": "*"}
_CLOSED_FORM = frozenset({"delta_j_max", "mse", "lambda", "extremes"})


@dataclass(frozen=True)
class Kernel:
    """`function(steps, h, *parameters, *carried)` → (steps done, *carried).

    `carried` names the state and accumulators in their order: p, q, then those of the observables;
    `start` has their initial values, p and q apart.
    """

    function: Callable[..., tuple[Any, ...]]
    parameters: tuple[str, ...]
    carried: tuple[str, ...]
    start: tuple[int, ...]
    source: str


@lru_cache(maxsize=64)
def kernel_for(
    hamiltonian: Hamiltonian,
    scheme: str,
    arithmetic: Arithmetic,
    observables: frozenset[str],
    compensated: bool = False,
) -> Kernel:
    """The kernel for a generic Hamiltonian (see `Hamiltonian.generic`), compiled once."""
    step_map = get(scheme).step_map(hamiltonian)
    return Writer(step_map, arithmetic, observables, compensated).kernel()


class Writer:
    """Writes the source of one kernel."""

    def __init__(
        self,
        step_map: StepMap,
        arithmetic: Arithmetic,
        observables: frozenset[str],
        compensated: bool,
    ) -> None:
        self.map, self.arithmetic = step_map, arithmetic
        self.observables, self.compensated = observables, compensated
        self.program = Program()
        self.parameters = step_map.hamiltonian.symbols
        self.carried: list[tuple[str, int]] = [("p", 0), ("q", 0)]
        self.body: list[str] = []

    # -- what is computed ---------------------------------------------------------------------

    def kernel(self) -> Kernel:
        outputs = self.outputs()
        lines = self.statements(outputs)
        source = self.assemble(outputs, lines)
        scope = {**self.arithmetic.functions, **self.constants()}
        return Kernel(
            function=self.arithmetic.compile(source, "kernel", scope),
            parameters=self.parameters,
            carried=tuple(name for name, _ in self.carried),
            start=tuple(value for _, value in self.carried[2:]),
            source=source,
        )

    def outputs(self) -> dict[str, int]:
        """Indices of the increments of p and q, of ΔJ and det J as far as they are asked for."""
        program = self.program
        # A user's parameter may be named like anything; in the source it is x0, x1, ….
        arguments = {"h": "h"} | {n: f"x{k}" for k, n in enumerate(self.parameters)}
        fixed = {n: program.input(a, static=True) for n, a in arguments.items()}
        zero = program.constant(Fraction(0))
        state = {n: program.input(n, static=False) for n in ("p", "q")}
        total = {"p": zero, "q": zero}
        delta_j, jacobian = zero, None
        for step in self.map.substeps:
            at = {n: program.add(state[n], total[n]) for n in ("p", "q")}
            evaluator = Evaluator(program, step.ring, fixed | at, self.arithmetic.pipelined)
            if self.observables & _CLOSED_FORM and not step.preserves_area:
                own = evaluator.evaluate(step.delta_j)
                delta_j = program.add(program.add(delta_j, own), program.mul(delta_j, own))
            if "lambda_plain" in self.observables:
                own_j = [evaluator.evaluate(entry) for entry in step.jacobian]
                jacobian = own_j if jacobian is None else self.product(own_j, jacobian)
            for n, increment in zip(("p", "q"), step.increments, strict=True):
                total[n] = program.add(total[n], evaluator.evaluate(increment))
        result = {"dp": total["p"], "dq": total["q"], "dj": delta_j}
        if jacobian is not None:
            a, b, c, d = jacobian
            minus = program.neg(program.mul(b, c))
            result["det"] = program.add(program.mul(a, d), minus)
        return result

    def product(self, x: Sequence[int], y: Sequence[int]) -> list[int]:
        """The 2 × 2 matrix product x y, row by row."""
        add, mul = self.program.add, self.program.mul
        return [
            add(mul(x[2 * i], y[j]), mul(x[2 * i + 1], y[2 + j])) for i in (0, 1) for j in (0, 1)
        ]

    # -- how it is written --------------------------------------------------------------------

    def statements(self, outputs: dict[str, int]) -> list[str]:
        """The loop's statements after the values: observables first, then the step."""
        value = {name: f"v{index}" for name, index in outputs.items()}
        lines: list[str] = []
        asked = self.observables
        if "lambda_plain" in asked:
            self.carried.append(("plain", 1))
            lines.append(f"plain = plain * {value['det']}")
        if asked & _CLOSED_FORM:
            lines.append(f"dj = {value['dj']}")
        if {"lambda", "extremes"} & asked:
            lines += self.accumulate("lam", "dj + lam * dj")
        if "mse" in asked:
            lines += self.accumulate("mse", "dj * dj")
        if "delta_j_max" in asked:
            self.carried.append(("top", 0))
            lines += ["size = abs(dj)", "if size > top: top = size"]
        if "extremes" in asked:
            self.carried += [("dj_low", 0), ("dj_high", 0), ("lam_low", 0), ("lam_high", 0)]
            for name, of in (("dj", "dj"), ("lam", "lam")):
                lines += [
                    f"if k == 0 or {of} < {name}_low: {name}_low = {of}",
                    f"if k == 0 or {of} > {name}_high: {name}_high = {of}",
                ]
        return lines + self.accumulate("p", value["dp"]) + self.accumulate("q", value["dq"])

    def accumulate(self, name: str, increment: str) -> list[str]:
        if name not in ("p", "q"):
            self.carried.append((name, 0))
        if not self.compensated:
            return [f"{name} = {name} + ({increment})"]
        self.carried.append((f"{name}_rest", 0))
        return [
            f"add = {name}_rest + ({increment})",
            f"total = {name} + add",
            f"part = total - {name}",
            f"{name}_rest = ({name} - (total - part)) + (add - part)",
            f"{name} = total",
        ]

    def assemble(self, outputs: dict[str, int], statements: list[str]) -> str:
        static, dynamic = self.values(list(outputs.values()))
        names = ", ".join(name for name, _ in self.carried)
        parameters = [f"x{k}" for k in range(len(self.parameters))]
        arguments = ", ".join(["steps", "h", *parameters, names])
        if self.arithmetic.guard is not None:
            p, q = (self.arithmetic.guard.format(x=x) for x in ("p", "q"))
            statements = [*statements, f"if not ({p} and {q}): return k, {names}"]
        return "\n".join(
            [
                f"def kernel({arguments}):",
                *(f"    {line}" for line in static),
                "    for k in range(steps):",
                *(f"        {line}" for line in [*dynamic, *statements]),
                f"    return steps, {names}",
                "",
            ]
        )

    def values(self, roots: Sequence[int]) -> tuple[list[str], list[str]]:
        """The lines that compute the roots: those before the loop, and those in it."""
        program = self.program
        live, stack = set(roots), list(roots)
        while stack:
            new = set(program.ops[stack.pop()].args) - live
            live |= new
            stack += new
        static: list[str] = []
        dynamic: list[str] = []
        written: set[int] = set()
        for index in sorted(live):
            if index in written or program.ops[index].kind == "const":
                continue
            line = self.pair(index, live, written) or f"v{index} = {self.operation(index)}"
            (static if program.static[index] else dynamic).append(line)
        return static, dynamic

    def pair(self, index: int, live: set[int], written: set[int]) -> str | None:
        """cos and sin of one argument in one call, where the arithmetic has that."""
        op, functions = self.program.ops[index], self.arithmetic.functions
        both = next((f for f in ("cos_sin", "sin_cos") if f in functions), None)
        if op.kind not in ("cos", "sin") or both is None:
            return None
        found = {
            self.program.ops[i].kind: i
            for i in live
            if self.program.ops[i].kind in ("cos", "sin") and self.program.ops[i].args == op.args
        }
        if len(found) < 2:
            return None
        written |= set(found.values())
        first, second = (found[kind] for kind in both.split("_"))
        return f"v{first}, v{second} = {both}(v{op.args[0]})"

    def operation(self, index: int) -> str:
        op = self.program.ops[index]
        args = [f"v{a}" for a in op.args]
        match op.kind:
            case "input":
                return op.name
            case "add" | "sub" | "mul":
                return f" {_INFIX[op.kind]} ".join(args)
            case "neg":
                return f"-{args[0]}"
            case "inverse":
                return f"1 / {args[0]}"
            case "root" if op.degree == 2:
                return f"sqrt({args[0]})"
            case "root":
                return f"root({args[0]}, {op.degree})"
            case "pi":
                return "pi"
        return f"{op.kind}({args[0]})"

    def constants(self) -> dict[str, Any]:
        return {
            f"v{i}": self.arithmetic.number(op.value)
            for i, op in enumerate(self.program.ops)
            if op.kind == "const"
        }
